#pragma once

#include <map>
#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/network/impl/propagator.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit::detail {

/// A stretch during which every conductance keeps its value: the eigenbasis, and how parameters move the elements.
template <typename Scalar>
struct Regime {
  Propagator<Scalar> propagator;
  VectorX<Scalar> ambient_drive;  ///< modal force per degC of ambient
  MatrixX<Scalar> links;  ///< modal difference vector of each conductance between two nodes that has a wanted parameter
  struct Slope {
    Index link;  ///< column of `links`; -1: an element of node `a` alone
    Index a;
    bool to_ambient;
    Column column;
    double slope;  ///< dW_per_K / dparameter
  };
  std::vector<Slope> slopes;
  MatrixX<Scalar> outputs;  ///< nodes x channels: modal weights of every reading and displacement
};

/// The regimes of one system, made when they are first met.
template <typename Scalar>
class Regimes {
 public:
  explicit Regimes(const Lazy<ThermalSystem, Scalar>& system) : system_(system) {
    Moment nowhere;
    capacities_.resize(static_cast<Index>(system.capacities.size()));
    for (std::size_t i = 0; i < system.capacities.size(); ++i) {
      const ThermalSystem::Capacity& one = system.capacities[i];
      capacities_(static_cast<Index>(i)) = one.from_law ? system.value(one.law, nowhere) : one.J_per_K;
    }
    for (std::size_t e = 0; e < system.conductances.size(); ++e)
      if (system.conductances[e].held()) held_.push_back(e);
  }

  const VectorX<Scalar>& capacities() const { return capacities_; }

  /// The regime at a moment of held inputs.
  Regime<Scalar>& at(const Moment& now) {
    std::vector<double> key;
    for (const std::size_t e : held_) {
      const ThermalSystem::Conductance& one = system_.conductances[e];
      double scale = 0, added = 0;
      for (const BoundLaw& law : one.scale) scale += system_.value(law, now);
      for (const BoundLaw& law : one.added) added += system_.value(law, now);
      key.push_back(scale);
      key.push_back(added);
    }
    const auto it = regimes_.find(key);
    return it != regimes_.end() ? it->second : regimes_.emplace(key, make(key, now)).first->second;
  }

 private:
  Regime<Scalar> make(const std::vector<double>& key, const Moment& now) const {
    const Index n = capacities_.size();
    MatrixX<Scalar> conductances = MatrixX<Scalar>::Zero(n, n);
    VectorX<Scalar> to_ambient = VectorX<Scalar>::Zero(n);
    std::vector<std::pair<Index, Index>> pairs;
    std::vector<typename Regime<Scalar>::Slope> slopes;
    std::size_t next_held = 0;
    for (std::size_t e = 0; e < system_.conductances.size(); ++e) {
      const ThermalSystem::Conductance& one = system_.conductances[e];
      double factor = 1, added = 0;
      if (one.held()) {
        factor += key[next_held++];
        added = key[next_held++];
      }
      const double W_per_K = one.W_per_K * factor + added;
      conductances(one.a, one.a) += W_per_K;
      if (one.b >= 0) {
        conductances(one.b, one.b) += W_per_K;
        conductances(one.a, one.b) -= W_per_K;
        conductances(one.b, one.a) -= W_per_K;
      } else if (one.b == ThermalSystem::ambient) {
        to_ambient(one.a) += W_per_K;
      }
      const std::size_t before = slopes.size();
      const auto add = [&](Column column, double slope) {
        slopes.push_back({one.b >= 0 ? static_cast<Index>(pairs.size()) : -1, one.a, one.b == ThermalSystem::ambient,
                          column, slope});
      };
      if (one.column >= 0) add(one.column, factor);
      for (const BoundLaw& law : one.scale)
        system_.derivatives(law, now, [&](Column column, double slope) { add(column, one.W_per_K * slope); });
      for (const BoundLaw& law : one.added) system_.derivatives(law, now, add);
      if (one.b >= 0 && slopes.size() > before) pairs.emplace_back(one.a, one.b);
    }
    Propagator<Scalar> propagator(capacities_, conductances);
    const MatrixX<Scalar>& modes = propagator.modes();
    MatrixX<Scalar> links(n, static_cast<Index>(pairs.size()));
    for (std::size_t i = 0; i < pairs.size(); ++i)
      links.col(static_cast<Index>(i)) = modes.col(pairs[i].first) - modes.col(pairs[i].second);
    VectorX<Scalar> ambient_drive = modes * to_ambient;
    MatrixX<Scalar> outputs = modal_outputs(modes);
    return {std::move(propagator), std::move(ambient_drive), std::move(links), std::move(slopes), std::move(outputs)};
  }

  MatrixX<Scalar> modal_outputs(const MatrixX<Scalar>& modes) const {
    const Index sensors = static_cast<Index>(system_.sensors.size());
    MatrixX<Scalar> outputs =
        MatrixX<Scalar>::Zero(modes.rows(), sensors + static_cast<Index>(system_.displacements.size()));
    for (Index s = 0; s < sensors; ++s) {
      const ThermalSystem::Sensor& sensor = system_.sensors[static_cast<std::size_t>(s)];
      if (sensor.node < 0) continue;
      outputs.col(s) = modes.col(sensor.node);
      for (const auto& [neighbour, share] : sensor.placement)
        outputs.col(s) += share * (modes.col(neighbour) - modes.col(sensor.node));
    }
    for (std::size_t d = 0; d < system_.displacements.size(); ++d)
      for (const auto& [node, um_per_K] : system_.displacements[d].um_per_K)
        outputs.col(sensors + static_cast<Index>(d)) += um_per_K * modes.col(node);
    return outputs;
  }

  const Lazy<ThermalSystem, Scalar>& system_;
  VectorX<Scalar> capacities_;
  std::vector<std::size_t> held_;
  std::map<std::vector<double>, Regime<Scalar>> regimes_;
};

}  // namespace thermfit::detail
