#pragma once

#include <string>
#include <utility>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// The machine as a lumped thermal network, as plain data; the contents of `thermfit-machine/1`.
///
/// C_i dtheta_i/dt = sum_j G_ij (theta_j - theta_i) + H_i (theta_amb - theta_i) + sum_s w_si P_s (u_s/scale_s)^m_s
/// z = sum_i e_i (theta_i - reference), minus its first sample where `zero_at_first_sample`.
///
/// Parts refer to nodes by index. network_check.hpp tells what a network must hold to be simulated.
struct ThermalNetwork {
  /// A part of uniform temperature.
  struct Node {
    std::string name;             ///< unique
    double capacity_J_per_K = 0;  ///< C, above 0
    double ambient_W_per_K = 0;   ///< H, at least 0
  };
  /// Conduction between two nodes.
  struct Link {
    Index a = 0;                     ///< one node
    Index b = 0;                     ///< the other
    double conductance_W_per_K = 0;  ///< G, at least 0
  };
  /// Heat P (u/scale)^exponent.
  struct HeatSource {
    std::string name;                            ///< unique
    std::string input;                           ///< a batch column, or "constant" for (u/scale) = 1
    double scale = 1;                            ///< in the unit of the input, above 0
    double exponent = 1;                         ///< m, above 0
    double power_W = 0;                          ///< P: at u = scale
    std::vector<std::pair<Index, double>> into;  ///< node, share; the shares add to 1
  };
  /// What a displacement probe shows.
  struct Displacement {
    std::string output;                              ///< the batch column it is compared with
    bool zero_at_first_sample = true;                ///< measured from its first sample
    std::vector<std::pair<Index, double>> um_per_K;  ///< node, expansion
    bool absolute = false;    ///< the probe's zero is part of what is measured, not set anew in each batch
    bool free_datum = false;  ///< while machine and data are compared: about its mean over the batch, as the data are
  };
  /// How batches of this machine write a column, where they do not say it themselves.
  struct Channel {
    std::string column;       ///< of a thermometer or a displacement
    std::string unit;         ///< "mm", "K"; empty: um, degC
    bool correction = false;  ///< a displacement written as correction: the error with the other sign
  };
  /// A thermometer.
  struct Sensor {
    std::string column;   ///< the batch column it is compared with
    Index node = 0;       ///< ambient_node for a sensor in the air
    double offset_K = 0;  ///< reading = temperature of the node + offset
    /// A sensor sits somewhere in the part that its node stands for: the reading gains share (theta_j - theta_node) for
    /// each neighbour j. A negative share: on the far side of the node.
    std::vector<std::pair<Index, double>> placement{};
    /// By how long it shows its place in the part late (negative: early, nearer to the heat): the reading loses
    /// response_s dtheta/dt. For a thermometer that is slow itself there is the effect sensor-lag.
    double response_s = 0;
  };
  /// Where the temperature of the room comes from.
  struct Ambient {
    /// How it is found in a batch.
    enum class Rule {
      column,           ///< measured: linear between the samples of `column`
      constant,         ///< `value_degC`
      initial,          ///< the first reading of the sensor mapped to ambient_node, held
      first_sample_of,  ///< the first reading of `column`, held
      unmeasured        ///< nothing measures it: a number of each batch, see OfBatch
    };
    Rule rule = Rule::initial;  ///< how it is found
    std::string column;         ///< for the rules that name one
    double value_degC = 0;      ///< under Rule::constant
  };
  /// Where a batch begins.
  struct Initial {
    /// How the nodes start.
    enum class Rule {
      ambient,   ///< every node starts at the first ambient temperature
      measured,  ///< nodes with a sensor start at its first reading minus offset, others at ambient
      given,     ///< nodes listed in `degC` start there, others at ambient
      fitted     ///< as measured, nodes between sensors between them; every node a number of each batch, see OfBatch
    };
    Rule rule = Rule::ambient;                   ///< how the nodes start
    std::vector<std::pair<Index, double>> degC;  ///< node, temperature, under Rule::given
    /// Under Rule::ambient: nodes with sensors start off it by this share of what these read above it first. 1 is
    /// Rule::measured where sensors have no offset.
    double share = 0;
  };
  /// Prior standard deviations of the calibration: relative, except for the sensor offset.
  struct Uncertainty {
    double capacity = 0.3;           ///< of each capacity
    double ambient = 0.3;            ///< of each conductance to ambient
    double conductance = 0.3;        ///< of each link
    double power = 0.3;              ///< of each heat source
    double um_per_K = 0.3;           ///< of each expansion
    double sensor_offset_K = 0.5;    ///< of each offset, K
    double sensor_placement = 0.25;  ///< of each share
    double sensor_response = 0.05;   ///< of the time constant of the sensor's node
    double start_share = 0;          ///< of Initial::share; 0: not moved
  };
  /// An effect of the catalogue that was added: its law is looked up by name, see network/effect.hpp.
  struct AddedEffect {
    std::string effect;                                      ///< name in the library
    std::string location;                                    ///< where it acts
    std::string driver;                                      ///< empty where the law has none
    std::vector<std::pair<std::string, double>> parameters;  ///< name, value

    /// Value of a parameter by name; `fallback` where it is absent.
    double value(const std::string& parameter, double fallback = 0) const {
      for (const auto& [key, number] : parameters)
        if (key == parameter) return number;
      return fallback;
    }
  };

  /// Numbers of a single batch, which no other batch can tell: where the nodes start, and the room that is no column.
  /// Calibration moves what has a prior standard deviation above 0. They are no part of the machine's document.
  struct OfBatch {
    std::string name;                  ///< of the batch
    std::vector<double> start_K;       ///< by node: above Excitation::start_degC; empty: nowhere
    std::vector<double> start_sd_K;    ///< of its prior
    std::vector<double> ambient_K;     ///< above Excitation::ambient_degC, see room_shape(); empty: nothing
    std::vector<double> ambient_sd_K;  ///< of its prior
  };

  static constexpr Index ambient_node = -1;  ///< stands for the air as the node of a sensor

  std::string name;                         ///< of the machine
  double reference_degC = 20;               ///< at which nothing has expanded
  Ambient ambient;                          ///< the room
  std::vector<Node> nodes;                  ///< the parts
  std::vector<Link> links;                  ///< at most one between two nodes
  std::vector<HeatSource> heat_sources;     ///< what warms it
  std::vector<Displacement> displacements;  ///< what is compared with the thermal errors
  std::vector<Sensor> sensors;              ///< what is compared with the temperatures
  std::vector<Channel> channels;            ///< columns that are written otherwise than in um and degC
  Initial initial;                          ///< where a batch begins
  Uncertainty uncertainty;                  ///< what is known of its numbers
  std::vector<AddedEffect> effects;         ///< in the order in which they act
  std::vector<OfBatch> batches;             ///< by Excitation::number; empty: no batch has numbers of its own

  /// How many nodes there are.
  Index node_count() const { return static_cast<Index>(nodes.size()); }

  /// Index of the node of this name, or -1. Does not allocate.
  Index find_node(const std::string& node) const {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].name == node) return static_cast<Index>(i);
    return -1;
  }

  /// Index of the link between two nodes, in either order, or -1. Does not allocate.
  Index find_link(Index a, Index b) const {
    for (std::size_t i = 0; i < links.size(); ++i)
      if ((links[i].a == a && links[i].b == b) || (links[i].a == b && links[i].b == a)) return static_cast<Index>(i);
    return -1;
  }

  /// Heat capacity of a node over all that it conducts away: how fast it can change. 0 where it is insulated. Does not
  /// allocate.
  double time_constant_s(Index node) const {
    const Node& one = nodes[static_cast<std::size_t>(node)];
    double W_per_K = one.ambient_W_per_K;
    for (const Link& link : links)
      if (link.a == node || link.b == node) W_per_K += link.conductance_W_per_K;
    return W_per_K > 0 ? one.capacity_J_per_K / W_per_K : 0;
  }
};

}  // namespace thermfit
