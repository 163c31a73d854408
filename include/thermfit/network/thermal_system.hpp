#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/network/bound_law.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// A network ready to be integrated: its elements, those of its effects, and which parameter each belongs to.
///
/// Effects add their laws here in Effect::act(). Whatever a law of held inputs can express (heat, conductance) is
/// integrated exactly; what depends on temperatures (`heat_flow`, `scale_conductance_by_state`) by an exponential
/// integrator of second order. Sensitivities follow by themselves.
class ThermalSystem {
 public:
  /// Acts on the temperatures of a whole series: transforms `series`, and each column of `tangents` along with it.
  /// `parameter_tangent(j)` is the column of the effect's j-th parameter in `tangents`, or -1.
  using SeriesLaw =
      std::function<void(Eigen::Ref<Vector> series, Matrix& tangents, const double* parameters, const Column* columns)>;

  static constexpr Index ambient = ThermalNetwork::ambient_node;  ///< the room, as the far side of a conductance
  static constexpr Index ground = -2;  ///< a fixed 0 degC, for conductances whose far side is a heat of its own

  /// Heat flows through it in proportion to a temperature difference.
  struct Conductance {
    Index a = 0;                  ///< a node
    Index b = ambient;            ///< a node, `ambient` or `ground`
    double W_per_K = 0;           ///< base value; 0 for elements that are all law
    Column column = -1;           ///< of the base value
    std::vector<BoundLaw> scale;  ///< value = base (1 + sum scale) + sum added
    std::vector<BoundLaw> added;  ///< W/K, of held inputs
    /// Whether it changes with held inputs.
    bool held() const { return !scale.empty() || !added.empty(); }
  };
  /// A ThermalNetwork::HeatSource.
  struct Source {
    Shares into;          ///< nodes it warms
    double power_W = 0;   ///< at an input of `scale`
    double scale = 1;     ///< in the unit of the input
    double exponent = 1;  ///< of input / scale
    Index input = -1;     ///< -1: constant
    Column column = -1;   ///< of the power
  };
  /// Heat of held inputs.
  struct HeldHeat {
    Shares into;   ///< nodes it warms
    BoundLaw law;  ///< W
  };
  /// Heat that depends on temperatures: W into the shares. With `element` >= 0 the law is a temperature difference in K
  /// that drives heat through that conductance's base value.
  struct StateFlow {
    Shares into;                    ///< nodes it warms
    std::vector<Index> depends_on;  ///< nodes whose temperatures the law looks at
    BoundLaw law;                   ///< W, or K where `element` >= 0
    Index element = -1;             ///< a conductance, or -1
  };
  /// What a node stores.
  struct Capacity {
    double J_per_K = 0;      ///< of a node of the network
    Column column = -1;      ///< of J_per_K
    BoundLaw law;            ///< J/K, for hidden nodes
    bool from_law = false;   ///< whether it is a hidden node
    Index starts_like = -1;  ///< the node whose start a hidden node has
  };
  /// A ThermalNetwork::Sensor.
  struct Sensor {
    Index node = 0;                                   ///< or ambient
    double offset_K = 0;                              ///< added to what it shows
    Column column = -1;                               ///< of the offset
    std::vector<std::pair<Index, double>> placement;  ///< neighbour and share
    std::vector<Column> placement_columns;            ///< of the shares
    double response_s = 0;                            ///< how late it shows its place
    Column response_column = -1;                      ///< of response_s
    std::vector<BoundLaw> laws;                       ///< degC, of its reading, one after the other
  };
  /// See ThermalNetwork::Initial::share.
  struct Start {
    double share = 0;                   ///< of the first readings
    Column column = -1;                 ///< of the share
    std::vector<Index> node_of_sensor;  ///< whatever an effect makes the sensor show later
  };
  /// A ThermalNetwork::OfBatch.
  struct OfBatch {
    std::vector<double> start_K;          ///< by node of the network
    std::vector<Column> start_columns;    ///< of them
    std::vector<double> ambient_K;        ///< by shape
    std::vector<Column> ambient_columns;  ///< of them
  };
  /// A ThermalNetwork::Displacement.
  struct Displacement {
    bool zero_at_first_sample = true;                ///< measured from its first sample
    bool free_datum = false;                         ///< instead: from its mean over the samples
    std::vector<std::pair<Index, double>> um_per_K;  ///< node, expansion
    std::vector<Column> columns;                     ///< of the expansions
    /// What an effect adds at each sample.
    struct Term {
      std::vector<Index> depends_on;  ///< nodes whose temperatures the law looks at
      BoundLaw law;                   ///< um
    };
    /// What an effect makes of the whole series.
    struct Operator {
      SeriesLaw law;      ///< of the series
      std::size_t owner;  ///< place in `owners`
    };
    std::vector<Term> terms;          ///< added, all of them
    std::vector<Operator> operators;  ///< applied in this order
  };

  // --- what effects call -----------------------------------------------------------------------------------------

  /// Place of an input column in Moment::inputs. The simulation demands it of every batch.
  Index input(const std::string& name) {
    const auto it = std::find(inputs.begin(), inputs.end(), name);
    if (it != inputs.end()) return static_cast<Index>(it - inputs.begin());
    inputs.push_back(name);
    return static_cast<Index>(inputs.size()) - 1;
  }

  /// Heat in W that depends on held inputs only.
  void heat(Shares into, Law law_W) { held_heat.push_back({std::move(into), bind(std::move(law_W))}); }

  /// Heat in W that depends on temperatures of the nodes in `depends_on` and on ambient.
  void heat_flow(Shares into, std::vector<Index> depends_on, Law law_W) {
    state_flows.push_back({std::move(into), std::move(depends_on), bind(std::move(law_W)), -1});
  }

  /// The conductance element of a node to ambient.
  Index ambient_element(Index node) const { return node; }
  /// The conductance element of a link.
  Index link_element(Index link) const { return own_nodes + link; }

  /// G becomes G (1 + law), law of held inputs.
  void scale_conductance(Index element, Law law) { at(conductances, element).scale.push_back(bind(std::move(law))); }

  /// G becomes G (1 + law), law of temperatures.
  void scale_conductance_by_state(Index element, Law law) {
    const Index a = at(conductances, element).a, b = at(conductances, element).b;
    std::vector<Index> depends_on{a};
    if (b >= 0) depends_on.push_back(b);
    drive_conductance(element, std::move(depends_on), [a, b, law = std::move(law)](const Moment& now, const double* p) {
      return law(now, p) * ((b >= 0 ? now.temperature_degC[b] : now.ambient_degC) - now.temperature_degC[a]);
    });
  }

  /// A further difference of law (K) drives heat through G towards the first side of the element, from its second.
  void drive_conductance(Index element, std::vector<Index> depends_on, Law law_K) {
    const Conductance& one = at(conductances, element);
    StateFlow flow{{{one.a, 1.0}}, std::move(depends_on), bind(std::move(law_K)), element};
    if (one.b >= 0) flow.into.emplace_back(one.b, -1.0);
    state_flows.push_back(std::move(flow));
  }

  /// A conductance in W/K between a node and a node or `ambient`, law of held inputs.
  void add_conductance(Index a, Index b, Law law_W_per_K) {
    Conductance one;
    one.a = a;
    one.b = b;
    one.added.push_back(bind(std::move(law_W_per_K)));
    conductances.push_back(std::move(one));
  }

  /// A conductance between a node and something held at a temperature, both laws of held inputs.
  void add_conductance_to(Index node, Law law_W_per_K, Law law_degC) {
    heat({{node, 1.0}}, [law_W_per_K, law_degC](const Moment& now, const double* p) {
      return law_W_per_K(now, p) * law_degC(now, p);
    });
    add_conductance(node, ground, std::move(law_W_per_K));
  }

  /// A hidden mass that starts at the temperature of `starts_like`; its index. Capacity in J/K, a law of parameters
  /// only.
  Index add_node(Index starts_like, Law law_J_per_K) {
    Capacity one;
    one.law = bind(std::move(law_J_per_K));
    one.from_law = true;
    one.starts_like = starts_like;
    capacities.push_back(std::move(one));
    return static_cast<Index>(capacities.size()) - 1;
  }

  /// The sensor now reads this node.
  void read_from(Index sensor, Index node) { at(sensors, sensor).node = node; }

  /// A reading becomes the law of it (Moment::reading_degC).
  void reading(Index sensor, Law law_degC) { at(sensors, sensor).laws.push_back(bind(std::move(law_degC))); }

  /// A node starts by law (K) above where it would have.
  void start(Index node, Law law_K) { starts.emplace_back(node, bind(std::move(law_K))); }

  /// Ambient becomes the law at each sample (Moment::ambient_degC is what it was), linear between them.
  void ambient_becomes(Law law_degC) { ambient_laws.push_back(bind(std::move(law_degC))); }

  /// A displacement output gains the law in um.
  void displacement(Index output, std::vector<Index> depends_on, Law law_um) {
    at(displacements, output).terms.push_back({std::move(depends_on), bind(std::move(law_um))});
  }
  /// A displacement output becomes the law of its whole series.
  void displacement_series(Index output, SeriesLaw law) {
    at(displacements, output).operators.push_back({std::move(law), current_owner()});
  }

  /// All displacements are logged late by law (s), a law of parameters only.
  void delay_displacements(Law law_s) { delays.push_back(bind(std::move(law_s))); }

  // --- contents ---------------------------------------------------------------------------------------------------

  Index own_nodes = 0;                             ///< nodes of the network itself; hidden nodes follow
  double reference_degC = 20;                      ///< at which nothing has expanded
  std::vector<std::string> inputs;                 ///< names of Moment::inputs
  std::vector<Capacity> capacities;                ///< by node
  std::vector<Conductance> conductances;           ///< of nodes to ambient, of links, then of effects
  std::vector<Source> sources;                     ///< the network's own
  std::vector<HeldHeat> held_heat;                 ///< from effects
  std::vector<StateFlow> state_flows;              ///< from effects
  std::vector<std::pair<Index, BoundLaw>> starts;  ///< node, K above its start
  std::vector<BoundLaw> ambient_laws;              ///< degC, one after the other
  std::vector<BoundLaw> delays;                    ///< s, added up
  std::vector<Sensor> sensors;                     ///< in the network's order
  Start start_by_readings;                         ///< of nodes with sensors
  std::vector<Displacement> displacements;         ///< in the network's order
  std::vector<BoundLaw::Owner> owners;             ///< one for each effect
  Index columns = 0;                               ///< parameters whose sensitivities are wanted
  std::vector<Column> state_columns;               ///< those of them that can move a temperature in every batch
  std::vector<OfBatch> batches;                    ///< numbers of single batches, by Excitation::number

  /// The law at a moment, with the values of its effect. Does not allocate.
  double value(const BoundLaw& bound, const Moment& now) const {
    return bound.law(now, owners[bound.owner].values.data());
  }

  /// Calls `take(column, dlaw/dparameter)` for each wanted parameter, by central differences.
  template <class Take>
  void derivatives(const BoundLaw& bound, const Moment& now, Take take) const {
    const BoundLaw::Owner& owner = owners[bound.owner];
    for (std::size_t j = 0; j < owner.values.size(); ++j) {
      if (owner.columns[j] < 0) continue;
      double shifted[16];
      std::copy(owner.values.begin(), owner.values.end(), shifted);
      shifted[j] = owner.values[j] + owner.steps[j];
      const double above = bound.law(now, shifted);
      shifted[j] = owner.values[j] - owner.steps[j];
      const double slope = (above - bound.law(now, shifted)) / (2 * owner.steps[j]);
      if (slope != 0) take(owner.columns[j], slope);
    }
  }

  static constexpr std::size_t most_parameters = 16;  ///< of one effect

 private:
  std::size_t current_owner() const { return owners.size() - 1; }
  BoundLaw bind(Law law) const { return {std::move(law), current_owner()}; }
  template <class Item>
  static Item& at(std::vector<Item>& items, Index i) {
    return items[static_cast<std::size_t>(i)];
  }
};

}  // namespace thermfit
