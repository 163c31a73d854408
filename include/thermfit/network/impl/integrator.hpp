#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/network/impl/drive.hpp"
#include "thermfit/network/impl/regime.hpp"
#include "thermfit/network/impl/start_state.hpp"
#include "thermfit/network/impl/state_columns.hpp"
#include "thermfit/network/impl/state_flows.hpp"

namespace thermfit::detail {

/// The modal state of one batch and its tangents, carried from one time to the next.
///
/// Linear parts are exact. Heat that depends on temperatures enters by ETD2RK (Cox & Matthews 2002), of second order;
/// tangents are the exact derivatives of what is computed. The tangent for a conductance is the network's response to
/// the heat flow through it, for a capacity to the heat stored in it, both integrated exactly by divided differences.
template <typename Scalar>
class Integrator {
 public:
  Integrator(const Lazy<ThermalSystem, Scalar>& system, Regimes<Scalar>& regimes, const Drive<Scalar>& drive)
      : system_(system),
        regimes_(regimes),
        drive_(drive),
        nodes_(regimes.capacities().size()),
        place_(system, drive),
        tangents_wanted_(place_.count() > 0),
        flows_(system, drive, place_) {
    StartState<Scalar> start = start_state<Scalar>(system, drive, place_, nodes_);
    temperatures_ = std::move(start.degC);
    tangents_ = std::move(start.tangents);
    rate_bound_ = flows_.fastest_rate(temperatures_, regimes.capacities());
  }
  Integrator(const Integrator&) = delete;  // flows_ points into it
  Integrator& operator=(const Integrator&) = delete;

  /// Turns to the regime of the inputs held from here on; to be called before anything else at each time.
  Regime<Scalar>& enter(Index sample, double time_s) {
    Regime<Scalar>& regime = regimes_.at(drive_.moment(sample, time_s, nullptr));
    if (&regime != regime_) {
      const MatrixX<Scalar>& modes = regime.propagator.modes();
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

  const VectorX<Scalar>& temperatures() const { return temperatures_; }
  /// Nodes x state columns.
  const MatrixX<Scalar>& modal_tangents() const { return tangents_; }

  /// dtheta/dt of the present state under the heat of the regime that was entered last.
  VectorX<Scalar> rates(Index sample, double time_s) {
    VectorX<Scalar> force = held_force_ + drive_.ambient(sample, time_s) * regime_->ambient_drive;
    if (!flows_.empty())
      force += flows_.modal_force(*regime_, sample, time_s, regime_->propagator.modes().transpose() * state_, tangents_,
                                  nullptr);
    return regime_->propagator.modes().transpose() * (force - regime_->propagator.rates().cwiseProduct(state_));
  }

  /// On to `end_s` under the inputs of `sample`.
  void advance(Index sample, double begin_s, double end_s) {
    const int substeps = flows_.empty() ? 1 : substeps_for(end_s - begin_s);
    for (int i = 0; i < substeps; ++i) {
      const double a = begin_s + (end_s - begin_s) * i / substeps;
      const double b = i + 1 == substeps ? end_s : begin_s + (end_s - begin_s) * (i + 1) / substeps;
      substep(sample, a, b, regime_->propagator.step((end_s - begin_s) / substeps, tangents_wanted_));
    }
  }

 private:
  int substeps_for(double h) const {
    return 1 + static_cast<int>(std::min(1000.0, h * rate_bound_ / drive_.excitation().state_step));
  }

  /// Heat that is held over the step, as modal force, and its slopes.
  void set_heat(Index sample, double time_s) {
    VectorX<Scalar> heat = VectorX<Scalar>::Zero(nodes_);
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

  void substep(Index sample, double begin_s, double end_s, const StepWeights<Scalar>& weights) {
    const double first = drive_.ambient(sample, begin_s), rise = drive_.ambient(sample, end_s) - first;
    VectorX<Scalar> force = held_force_ + first * regime_->ambient_drive;
    VectorX<Scalar> ramp = rise * regime_->ambient_drive;
    if (flows_.empty()) {
      if (tangents_wanted_) step_tangents(sample, begin_s, end_s, weights, force, ramp, nullptr, nullptr);
      step_state(weights, force, ramp);
      return;
    }
    const VectorX<Scalar> before = state_;
    const VectorX<Scalar> degC = regime_->propagator.modes().transpose() * state_;
    MatrixX<Scalar> slopes_before, slopes_after, tangents_before = tangents_;
    const VectorX<Scalar> flow_before =
        flows_.modal_force(*regime_, sample, begin_s, degC, tangents_, tangents_wanted_ ? &slopes_before : nullptr);
    force += flow_before;
    if (tangents_wanted_) step_tangents(sample, begin_s, end_s, weights, force, ramp, &slopes_before, nullptr);
    step_state(weights, force, ramp);
    const VectorX<Scalar> flow_after =
        flows_.modal_force(*regime_, sample, end_s, regime_->propagator.modes().transpose() * state_, tangents_,
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

  void step_state(const StepWeights<Scalar>& weights, const VectorX<Scalar>& force, const VectorX<Scalar>& ramp) {
    state_ = weights.decay.cwiseProduct(state_) + weights.held.cwiseProduct(force) + weights.ramp.cwiseProduct(ramp);
  }

  /// Tangents over a step that begins in `state_` under force + ramp s/h; `slopes`, `ramp_slopes` are tangents of them.
  void step_tangents(Index sample, double begin_s, double end_s, const StepWeights<Scalar>& weights,
                     const VectorX<Scalar>& force, const VectorX<Scalar>& ramp, const MatrixX<Scalar>* slopes,
                     const MatrixX<Scalar>* ramp_slopes) {
    const Regime<Scalar>& regime = *regime_;
    const MatrixX<Scalar>& modes = regime.propagator.modes();
    tangents_ = weights.decay.asDiagonal() * tangents_;
    for (const HeatSlope& one : heat_slopes_)
      for (const auto& [node, share] : *one.into)
        tangents_.col(place_(one.column)) += one.slope * share * weights.held.cwiseProduct(modes.col(node));
    if (drive_.ambient_moves()) {
      const RowVectorX<Scalar> first = place_.ambient_tangent(drive_, sample, begin_s);
      const RowVectorX<Scalar> rise = place_.ambient_tangent(drive_, sample, end_s) - first;
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
    const VectorX<Scalar> air = first * weights.held + rise * weights.ramp;
    for (const auto& one : regime.slopes) {
      if (one.link >= 0) {
        tangents_.col(place_(one.column)) -= one.slope * through_links_.col(one.link);
        continue;
      }
      tangents_.col(place_(one.column)) -= one.slope * to_ambient_.col(one.a);
      if (one.to_ambient) tangents_.col(place_(one.column)) += one.slope * modes.col(one.a).cwiseProduct(air);
    }
    step_capacity_tangents(weights, end_s - begin_s, force, ramp);
    if (slopes) tangents_ += weights.held.asDiagonal() * *slopes;
    if (ramp_slopes) tangents_ += weights.ramp.asDiagonal() * *ramp_slopes;
  }

  void step_capacity_tangents(const StepWeights<Scalar>& weights, double h, const VectorX<Scalar>& force,
                              const VectorX<Scalar>& ramp) {
    const MatrixX<Scalar>& modes = regime_->propagator.modes();
    bool mixed = false;
    for (Index i = 0; i < nodes_; ++i) {
      const ThermalSystem::Capacity& one = system_.capacities[static_cast<std::size_t>(i)];
      const auto add = [&](Column column, double slope) {
        if (!mixed) {
          const VectorX<Scalar> speed = force - regime_->propagator.rates().cwiseProduct(state_);
          mix_.noalias() = weights.from_state * speed.asDiagonal();
          mix_ += weights.from_held * (ramp / h).asDiagonal();
          mixed = true;
        }
        tangents_.col(place_(column)).noalias() -= slope * modes.col(i).cwiseProduct(mix_ * modes.col(i));
      };
      if (one.column >= 0) add(one.column, 1);
      if (one.from_law) system_.derivatives(one.law, Moment{}, add);
    }
  }

  struct HeatSlope {
    Column column;
    double slope;
    const Shares* into;
  };

  const Lazy<ThermalSystem, Scalar>& system_;
  Regimes<Scalar>& regimes_;
  const Drive<Scalar>& drive_;
  const Index nodes_;
  const StateColumns<Scalar> place_;
  const bool tangents_wanted_;
  StateFlows<Scalar> flows_;
  Regime<Scalar>* regime_ = nullptr;
  VectorX<Scalar> temperatures_, state_, held_force_;
  MatrixX<Scalar> tangents_;  ///< modal, nodes x state columns; of temperatures before the first regime
  std::vector<HeatSlope> heat_slopes_;
  double rate_bound_ = 0;
  MatrixX<Scalar> mix_, through_links_, to_ambient_;
};

}  // namespace thermfit::detail
