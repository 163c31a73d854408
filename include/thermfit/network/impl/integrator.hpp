#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/network/impl/drive.hpp"
#include "thermfit/network/impl/regime.hpp"

namespace thermfit::detail {

/// The modal state of one batch and its tangents, carried from one time to the next.
///
/// Linear parts are exact. Heat that depends on temperatures enters by ETD2RK (Cox & Matthews 2002), of second order;
/// tangents are the exact derivatives of what is computed. The tangent for a conductance is the network's response to
/// the heat flow through it, for a capacity to the heat stored in it, both integrated exactly by divided differences.
class Integrator {
 public:
  Integrator(const ThermalSystem& system, Regimes& regimes, const Drive& drive)
      : system_(system),
        regimes_(regimes),
        drive_(drive),
        tangents_wanted_(!system.state_columns.empty()),
        nodes_(regimes.capacities().size()),
        state_column_(static_cast<std::size_t>(system.columns), -1) {
    for (std::size_t j = 0; j < system.state_columns.size(); ++j)
      state_column_[static_cast<std::size_t>(system.state_columns[j])] = static_cast<Column>(j);
    start();
  }

  /// Turns to the regime of the inputs held from here on; to be called before anything else at each time.
  Regime& enter(Index sample, double time_s) {
    Regime& regime = regimes_.at(drive_.moment(sample, time_s, nullptr));
    if (&regime != regime_) {
      const Matrix& modes = regime.propagator.modes();
      if (regime_) temperatures_ = regime_->propagator.modes().transpose() * state_;
      state_ = modes * regimes_.capacities().cwiseProduct(temperatures_);
      if (tangents_wanted_) {
        if (regime_) tangents_ = regime_->propagator.modes().transpose() * tangents_;
        tangents_ = modes * (regimes_.capacities().asDiagonal() * tangents_).eval();
      }
      regime_ = &regime;
    }
    temperatures_ = regime.propagator.modes().transpose() * state_;
    set_heat(sample, time_s);
    return regime;
  }

  const Vector& temperatures() const { return temperatures_; }
  /// Nodes x state columns.
  const Matrix& modal_tangents() const { return tangents_; }

  /// dtheta/dt of the present state under the heat of the regime that was entered last.
  Vector rates(Index sample, double time_s) {
    Vector force = held_force_ + drive_.ambient(sample, time_s) * regime_->ambient_drive;
    if (!system_.state_flows.empty())
      force += flows(sample, time_s, regime_->propagator.modes().transpose() * state_, tangents_, nullptr);
    return regime_->propagator.modes().transpose() * (force - regime_->propagator.rates().cwiseProduct(state_));
  }

  /// On to `end_s` under the inputs of `sample`.
  void advance(Index sample, double begin_s, double end_s) {
    const int substeps = system_.state_flows.empty() ? 1 : substeps_for(end_s - begin_s);
    for (int i = 0; i < substeps; ++i) {
      const double a = begin_s + (end_s - begin_s) * i / substeps;
      const double b = i + 1 == substeps ? end_s : begin_s + (end_s - begin_s) * (i + 1) / substeps;
      substep(sample, a, b, regime_->propagator.step((end_s - begin_s) / substeps, tangents_wanted_));
    }
  }

 private:
  void start() {
    const Excitation& excitation = drive_.excitation();
    temperatures_ = Vector::Zero(nodes_);
    temperatures_.head(system_.own_nodes) = excitation.start_degC;
    tangents_ = Matrix::Zero(nodes_, state_columns());
    for (Index node = 0; node < system_.own_nodes; ++node) {
      const auto& sensors = excitation.start_sensors[static_cast<std::size_t>(node)];
      for (const Index s : sensors) {
        const ThermalSystem::Sensor& sensor = system_.sensors[static_cast<std::size_t>(s)];
        const double share = 1 / static_cast<double>(sensors.size());
        temperatures_(node) -= share * sensor.offset_K;
        if (sensor.column >= 0) tangents_(node, state_column(sensor.column)) -= share;
      }
    }
    if (system_.start_by_readings.share != 0 || system_.start_by_readings.column >= 0) start_by_readings();
    const Moment now = drive_.moment(0, drive_.time_s(0), nullptr);
    for (const auto& [node, law] : system_.starts) {
      temperatures_(node) += system_.value(law, now);
      const Index row = node;
      system_.derivatives(law, now,
                          [&](Column column, double slope) { tangents_(row, state_column(column)) += slope; });
    }
    for (Index i = system_.own_nodes; i < nodes_; ++i) {
      const ThermalSystem::Capacity& hidden = system_.capacities[static_cast<std::size_t>(i)];
      temperatures_(i) = temperatures_(hidden.starts_like);
      tangents_.row(i) = tangents_.row(hidden.starts_like);
    }
    rate_bound_ = state_flow_rate();
  }

  /// Moves every node with sensors towards what they read first, offsets and all: were the offsets taken off, they
  /// could move the starts at will.
  void start_by_readings() {
    const Excitation& excitation = drive_.excitation();
    const auto& [share, own_column, node_of_sensor] = system_.start_by_readings;
    const Vector& first_degC = excitation.first_reading_degC;
    const Index sensors = std::min(static_cast<Index>(node_of_sensor.size()), first_degC.size());
    const auto node_read_by = [&](Index s) {
      return std::isfinite(first_degC(s)) ? node_of_sensor[static_cast<std::size_t>(s)] : -1;
    };
    Vector sensors_at = Vector::Zero(nodes_);
    for (Index s = 0; s < sensors; ++s)
      if (node_read_by(s) >= 0) sensors_at(node_read_by(s)) += 1;
    for (Index s = 0; s < sensors; ++s) {
      const Index node = node_read_by(s);
      if (node < 0) continue;
      const double rise = (first_degC(s) - excitation.ambient_degC(0)) / sensors_at(node);
      temperatures_(node) += share * rise;
      if (own_column >= 0) tangents_(node, state_column(own_column)) += rise;
    }
  }

  /// Fastest rate at which the state-dependent heat could move a node, 15 K above the start.
  double state_flow_rate() {
    if (system_.state_flows.empty()) return 0;
    Vector warm = temperatures_.array() + 15;
    Vector slope = Vector::Zero(nodes_);
    for (const ThermalSystem::StateFlow& flow : system_.state_flows)
      for (const Index node : flow.depends_on) {
        const double kept = warm(node);
        warm(node) = kept + difference_step;
        const double above = flow_W(flow, 0, 0, warm);
        warm(node) = kept - difference_step;
        slope(node) += std::abs(above - flow_W(flow, 0, 0, warm)) / (2 * difference_step);
        warm(node) = kept;
      }
    return slope.cwiseQuotient(regimes_.capacities()).maxCoeff();
  }
  int substeps_for(double h) const {
    return 1 + static_cast<int>(std::min(1000.0, h * rate_bound_ / drive_.excitation().state_step));
  }

  /// Heat that is held over the step, as modal force, and its slopes.
  void set_heat(Index sample, double time_s) {
    Vector heat = Vector::Zero(nodes_);
    heat_slopes_.clear();
    for (const ThermalSystem::Source& source : system_.sources) {
      const double activity = drive_.activity(source, sample);
      for (const auto& [node, share] : source.into) heat(node) += source.power_W * activity * share;
      if (source.column >= 0 && activity != 0) heat_slopes_.push_back({source.column, activity, &source.into});
    }
    if (!system_.held_heat.empty()) {
      const Moment now = drive_.moment(sample, time_s, nullptr);
      for (const ThermalSystem::HeldHeat& one : system_.held_heat) {
        const double power_W = system_.value(one.law, now);
        for (const auto& [node, share] : one.into) heat(node) += power_W * share;
        system_.derivatives(one.law, now, [&](Column column, double slope) {
          heat_slopes_.push_back({column, slope, &one.into});
        });
      }
    }
    held_force_ = regime_->propagator.modes() * heat;
  }

  double flow_W(const ThermalSystem::StateFlow& flow, Index sample, double time_s, const Vector& degC) const {
    const Moment now = drive_.moment(sample, time_s, degC.data());
    return base_W_per_K(flow) * system_.value(flow.law, now);
  }
  double base_W_per_K(const ThermalSystem::StateFlow& flow) const {
    return flow.element < 0 ? 1 : system_.conductances[static_cast<std::size_t>(flow.element)].W_per_K;
  }

  /// Modal force of all state-dependent heat at `degC`, and its tangents where `slopes` is given.
  Vector flows(Index sample, double time_s, Vector degC, const Matrix& modal_tangents, Matrix* slopes) {
    const Matrix& modes = regime_->propagator.modes();
    const Index count = static_cast<Index>(system_.state_flows.size());
    Vector into = Vector::Zero(nodes_);  // W, by node
    if (slopes) {
      patterns_.setZero(nodes_, count);
      flow_tangents_.setZero(count, state_columns());
      node_tangents_.noalias() = modes.transpose() * modal_tangents;
    }
    for (Index f = 0; f < count; ++f) {
      const ThermalSystem::StateFlow& flow = system_.state_flows[static_cast<std::size_t>(f)];
      const double watt = flow_W(flow, sample, time_s, degC);
      for (const auto& [node, share] : flow.into) {
        into(node) += share * watt;
        if (slopes) patterns_.col(f) += share * modes.col(node);
      }
      if (slopes) add_flow_tangent(flow, sample, time_s, degC, flow_tangents_.row(f));
    }
    if (slopes) slopes->noalias() = patterns_ * flow_tangents_;
    return modes * into;
  }

  void add_flow_tangent(const ThermalSystem::StateFlow& flow, Index sample, double time_s, Vector& degC,
                        Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> tangent) const {
    for (const Index node : flow.depends_on) {
      const double kept = degC(node);
      degC(node) = kept + difference_step;
      const double above = flow_W(flow, sample, time_s, degC);
      degC(node) = kept - difference_step;
      const double slope = (above - flow_W(flow, sample, time_s, degC)) / (2 * difference_step);
      degC(node) = kept;
      tangent += slope * node_tangents_.row(node);
    }
    const Moment now = drive_.moment(sample, time_s, degC.data());
    const double factor = base_W_per_K(flow);
    if (flow.element >= 0) {
      const Column column = system_.conductances[static_cast<std::size_t>(flow.element)].column;
      if (column >= 0) tangent(state_column(column)) += system_.value(flow.law, now);
    }
    if (drive_.ambient_moves()) {
      Moment above = now, below = now;
      above.ambient_degC += difference_step;
      below.ambient_degC -= difference_step;
      tangent += factor * (system_.value(flow.law, above) - system_.value(flow.law, below)) / (2 * difference_step) *
                 ambient_tangent(sample, time_s);
    }
    system_.derivatives(flow.law, now,
                        [&](Column column, double slope) { tangent(state_column(column)) += factor * slope; });
  }

  void substep(Index sample, double begin_s, double end_s, const StepWeights& weights) {
    const double first = drive_.ambient(sample, begin_s), rise = drive_.ambient(sample, end_s) - first;
    Vector force = held_force_ + first * regime_->ambient_drive;
    Vector ramp = rise * regime_->ambient_drive;
    if (system_.state_flows.empty()) {
      if (tangents_wanted_) step_tangents(sample, begin_s, end_s, weights, force, ramp, nullptr, nullptr);
      step_state(weights, force, ramp);
      return;
    }
    const Vector before = state_;
    const Vector degC = regime_->propagator.modes().transpose() * state_;
    Matrix slopes_before, slopes_after, tangents_before = tangents_;
    const Vector flow_before = flows(sample, begin_s, degC, tangents_, tangents_wanted_ ? &slopes_before : nullptr);
    force += flow_before;
    if (tangents_wanted_) step_tangents(sample, begin_s, end_s, weights, force, ramp, &slopes_before, nullptr);
    step_state(weights, force, ramp);
    const Vector flow_after = flows(sample, end_s, regime_->propagator.modes().transpose() * state_, tangents_,
                                    tangents_wanted_ ? &slopes_after : nullptr);
    ramp += flow_after - flow_before;
    state_ = before;
    if (tangents_wanted_) {
      tangents_.swap(tangents_before);
      slopes_after -= slopes_before;
      step_tangents(sample, begin_s, end_s, weights, force, ramp, &slopes_before, &slopes_after);
    }
    step_state(weights, force, ramp);
  }

  void step_state(const StepWeights& weights, const Vector& force, const Vector& ramp) {
    state_ = weights.decay.cwiseProduct(state_) + weights.held.cwiseProduct(force) + weights.ramp.cwiseProduct(ramp);
  }

  /// Tangents over a step that begins in `state_` under force + ramp s/h; `slopes`, `ramp_slopes` are tangents of them.
  void step_tangents(Index sample, double begin_s, double end_s, const StepWeights& weights, const Vector& force,
                     const Vector& ramp, const Matrix* slopes, const Matrix* ramp_slopes) {
    const Regime& regime = *regime_;
    const Matrix& modes = regime.propagator.modes();
    tangents_ = weights.decay.asDiagonal() * tangents_;
    for (const HeatSlope& one : heat_slopes_)
      for (const auto& [node, share] : *one.into)
        tangents_.col(state_column(one.column)) += one.slope * share * weights.held.cwiseProduct(modes.col(node));
    if (drive_.ambient_moves()) {
      const Eigen::RowVectorXd first = ambient_tangent(sample, begin_s);
      const Eigen::RowVectorXd rise = ambient_tangent(sample, end_s) - first;
      tangents_ += weights.held.cwiseProduct(regime.ambient_drive) * first;
      tangents_ += weights.ramp.cwiseProduct(regime.ambient_drive) * rise;
    }
    const bool any_node = std::any_of(regime.slopes.begin(), regime.slopes.end(), [](auto& s) { return s.link < 0; });
    mix_.noalias() = weights.from_state * state_.asDiagonal();
    mix_ += weights.from_held * force.asDiagonal();
    mix_ += weights.from_ramp * ramp.asDiagonal();
    if (regime.links.cols() > 0) {
      through_links_.noalias() = mix_ * regime.links;
      through_links_ = through_links_.cwiseProduct(regime.links);
    }
    if (any_node) {
      to_ambient_.noalias() = mix_ * modes;
      to_ambient_ = to_ambient_.cwiseProduct(modes);
    }
    const double first = drive_.ambient(sample, begin_s), rise = drive_.ambient(sample, end_s) - first;
    const Vector air = first * weights.held + rise * weights.ramp;
    for (const Regime::Slope& one : regime.slopes) {
      if (one.link >= 0) {
        tangents_.col(state_column(one.column)) -= one.slope * through_links_.col(one.link);
        continue;
      }
      tangents_.col(state_column(one.column)) -= one.slope * to_ambient_.col(one.a);
      if (one.to_ambient) tangents_.col(state_column(one.column)) += one.slope * modes.col(one.a).cwiseProduct(air);
    }
    step_capacity_tangents(weights, end_s - begin_s, force, ramp);
    if (slopes) tangents_ += weights.held.asDiagonal() * *slopes;
    if (ramp_slopes) tangents_ += weights.ramp.asDiagonal() * *ramp_slopes;
  }

  void step_capacity_tangents(const StepWeights& weights, double h, const Vector& force, const Vector& ramp) {
    const Matrix& modes = regime_->propagator.modes();
    bool mixed = false;
    for (Index i = 0; i < nodes_; ++i) {
      const ThermalSystem::Capacity& one = system_.capacities[static_cast<std::size_t>(i)];
      const auto add = [&](Column column, double slope) {
        if (!mixed) {
          const Vector speed = force - regime_->propagator.rates().cwiseProduct(state_);
          mix_.noalias() = weights.from_state * speed.asDiagonal();
          mix_ += weights.from_held * (ramp / h).asDiagonal();
          mixed = true;
        }
        tangents_.col(state_column(column)).noalias() -= slope * modes.col(i).cwiseProduct(mix_ * modes.col(i));
      };
      if (one.column >= 0) add(one.column, 1);
      if (one.from_law) system_.derivatives(one.law, Moment{}, add);
    }
  }

  Index state_columns() const { return static_cast<Index>(system_.state_columns.size()); }
  Column state_column(Column column) const { return state_column_[static_cast<std::size_t>(column)]; }
  /// Of the state columns only.
  Eigen::RowVectorXd ambient_tangent(Index sample, double time_s) const {
    const Eigen::RowVectorXd all = drive_.ambient_tangent(sample, time_s);
    Eigen::RowVectorXd result(state_columns());
    for (Index j = 0; j < result.size(); ++j) result(j) = all(system_.state_columns[static_cast<std::size_t>(j)]);
    return result;
  }

  struct HeatSlope {
    Column column;
    double slope;
    const Shares* into;
  };
  static constexpr double difference_step = 3e-5;  ///< K

  const ThermalSystem& system_;
  Regimes& regimes_;
  const Drive& drive_;
  const bool tangents_wanted_;
  const Index nodes_;
  std::vector<Column> state_column_;  ///< place of each parameter in the tangents, or -1
  Regime* regime_ = nullptr;
  Vector temperatures_, state_, held_force_;
  Matrix tangents_;  ///< modal, nodes x state columns; of temperatures before the first regime
  std::vector<HeatSlope> heat_slopes_;
  double rate_bound_ = 0;
  Matrix mix_, through_links_, to_ambient_;
  Matrix patterns_, flow_tangents_, node_tangents_;  ///< of state flows, while their tangents are made
};

}  // namespace thermfit::detail
