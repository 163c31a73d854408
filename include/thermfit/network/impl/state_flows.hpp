#pragma once

#include <cmath>

#include "thermfit/lazy.hpp"
#include "thermfit/network/impl/drive.hpp"
#include "thermfit/network/impl/regime.hpp"
#include "thermfit/network/impl/state_columns.hpp"

namespace thermfit::detail {

/// The heat that depends on temperatures (ThermalSystem::StateFlow) at a state, and how it moves with it.
template <typename Scalar>
class StateFlows {
 public:
  /// All must outlive it.
  StateFlows(const Lazy<ThermalSystem, Scalar>& system, const Drive<Scalar>& drive, const StateColumns<Scalar>& place)
      : system_(system), drive_(drive), place_(place) {}

  bool empty() const { return system_.state_flows.empty(); }

  /// Fastest rate (1/s) at which it could move a node, 15 K above the start.
  double fastest_rate(const VectorX<Scalar>& start_degC, const VectorX<Scalar>& capacities) const {
    if (empty()) return 0;
    VectorX<Scalar> warm = start_degC.array() + 15;
    VectorX<Scalar> slope = VectorX<Scalar>::Zero(warm.size());
    for (const ThermalSystem::StateFlow& flow : system_.state_flows)
      for (const Index node : flow.depends_on) {
        const double kept = warm(node);
        warm(node) = kept + difference_step;
        const double above = watt(flow, 0, 0, warm);
        warm(node) = kept - difference_step;
        slope(node) += std::abs(above - watt(flow, 0, 0, warm)) / (2 * difference_step);
        warm(node) = kept;
      }
    return slope.cwiseQuotient(capacities).maxCoeff();
  }

  /// Modal force of all of it at `degC`, and its tangents (nodes x state columns) where `slopes` is given.
  VectorX<Scalar> modal_force(const Regime<Scalar>& regime, Index sample, double time_s, VectorX<Scalar> degC,
                              const MatrixX<Scalar>& modal_tangents, MatrixX<Scalar>* slopes) {
    const MatrixX<Scalar>& modes = regime.propagator.modes();
    const Index count = static_cast<Index>(system_.state_flows.size()), nodes = degC.size();
    VectorX<Scalar> into = VectorX<Scalar>::Zero(nodes);  // W, by node
    if (slopes) {
      patterns_.setZero(nodes, count);
      flow_tangents_.setZero(count, place_.count());
      node_tangents_.noalias() = modes.transpose() * modal_tangents;
    }
    for (Index f = 0; f < count; ++f) {
      const ThermalSystem::StateFlow& flow = system_.state_flows[static_cast<std::size_t>(f)];
      const double W = watt(flow, sample, time_s, degC);
      for (const auto& [node, share] : flow.into) {
        into(node) += share * W;
        if (slopes) patterns_.col(f) += share * modes.col(node);
      }
      if (slopes) add_tangent(flow, sample, time_s, degC, flow_tangents_.row(f));
    }
    if (slopes) slopes->noalias() = patterns_ * flow_tangents_;
    return modes * into;
  }

 private:
  double watt(const ThermalSystem::StateFlow& flow, Index sample, double time_s, const VectorX<Scalar>& degC) const {
    const Moment now = drive_.moment(sample, time_s, degC.data());
    return base_W_per_K(flow) * system_.value(flow.law, now);
  }
  double base_W_per_K(const ThermalSystem::StateFlow& flow) const {
    return flow.element < 0 ? 1 : system_.conductances[static_cast<std::size_t>(flow.element)].W_per_K;
  }

  void add_tangent(const ThermalSystem::StateFlow& flow, Index sample, double time_s, VectorX<Scalar>& degC,
                   Eigen::Ref<RowVectorX<Scalar>, 0, Eigen::InnerStride<>> tangent) const {
    for (const Index node : flow.depends_on) {
      const double kept = degC(node);
      degC(node) = kept + difference_step;
      const double above = watt(flow, sample, time_s, degC);
      degC(node) = kept - difference_step;
      const double slope = (above - watt(flow, sample, time_s, degC)) / (2 * difference_step);
      degC(node) = kept;
      tangent += slope * node_tangents_.row(node);
    }
    const Moment now = drive_.moment(sample, time_s, degC.data());
    const double factor = base_W_per_K(flow);
    if (flow.element >= 0) {
      const Column column = system_.conductances[static_cast<std::size_t>(flow.element)].column;
      if (column >= 0) tangent(place_(column)) += system_.value(flow.law, now);
    }
    if (drive_.ambient_moves()) {
      Moment above = now, below = now;
      above.ambient_degC += difference_step;
      below.ambient_degC -= difference_step;
      tangent += factor * (system_.value(flow.law, above) - system_.value(flow.law, below)) / (2 * difference_step) *
                 place_.ambient_tangent(drive_, sample, time_s);
    }
    system_.derivatives(flow.law, now, [&](Column column, double slope) { tangent(place_(column)) += factor * slope; });
  }

  static constexpr double difference_step = 3e-5;  ///< K

  const Lazy<ThermalSystem, Scalar>& system_;
  const Drive<Scalar>& drive_;
  const StateColumns<Scalar>& place_;
  MatrixX<Scalar> patterns_, flow_tangents_, node_tangents_;  ///< while tangents are made
};

}  // namespace thermfit::detail
