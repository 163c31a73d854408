#pragma once

/// From cells to the nominal lumped network: least squares over the campaign, then miscalibration; and what of an
/// effect's signature a calibration cannot swallow.

#include "schedule.hpp"

namespace blind {

/// One matrix a batch, samples x (thermometers but the one in the air, then the displacement).
using Signals = std::vector<Matrix>;

inline std::vector<Sensor> part_sensors(const Machine& machine) {
  std::vector<Sensor> on_parts;
  for (const Sensor& sensor : machine.sensors)
    if (sensor.lump >= 0) on_parts.push_back(sensor);
  return on_parts;
}

inline Matrix every(const Matrix& trace, int steps) {
  Matrix samples((trace.rows() + steps - 1) / steps, trace.cols());
  for (Index row = 0; row < samples.rows(); ++row) samples.row(row) = trace.row(row * steps);
  return samples;
}

inline Vector at_rest(const Plant& plant, const Experiment& batch) {
  return Vector::Constant(plant.cells(), batch.air_degC[0]);
}

inline Experiment calm(Experiment batch) {
  batch.draught_K.resize(0, 0);
  return batch;
}

/// What undisturbed batches would show: of the cells, or of the lumped network with a coarser step.
inline Signals undisturbed(const Machine& machine, const Plant& plant, bool lumped,
                           const std::vector<Experiment>& batches) {
  const auto sensors = part_sensors(machine);
  Signals signals;
  for (std::size_t b = 0; b < batches.size(); ++b) {
    const Matrix trace = every(simulate(plant, batches[b], b, at_rest(plant, batches[b]), {}), batches[b].steps);
    Matrix shown(trace.rows(), static_cast<Index>(sensors.size()) + 1);
    for (std::size_t s = 0; s < sensors.size(); ++s)
      shown.col(static_cast<Index>(s)) = trace.col(lumped ? sensors[s].lump : sensors[s].cell);
    const Vector length = trace * plant.um_per_K;
    shown.rightCols(1) = length.array() - length[0];
    signals.push_back(shown);
  }
  return signals;
}

/// The batches with a sixth of the integration steps, for the lumped network, which is less stiff.
inline std::vector<Experiment> coarse(const std::vector<Experiment>& batches) {
  std::vector<Experiment> result;
  for (Experiment batch : batches) {
    batch = calm(batch);
    if (batch.steps % 6 == 0) {
      batch.air_degC = every(batch.air_degC, 6);
      batch.steps /= 6;
    }
    result.push_back(batch);
  }
  return result;
}

constexpr double sensor_weight_K = .05, output_weight_um = .25;

/// Signals in units of their weights, one column.
inline Vector stacked(const Signals& signals) {
  Index rows = 0;
  for (const Matrix& batch : signals) rows += batch.size();
  Vector all(rows);
  Index at = 0;
  for (const Matrix& batch : signals)
    for (Index c = 0; c < batch.cols(); ++c) {
      all.segment(at, batch.rows()) = batch.col(c) / (c + 1 == batch.cols() ? output_weight_um : sensor_weight_K);
      at += batch.rows();
    }
  return all;
}

/// The network's parameters as one vector: logarithms of capacity, exchange, conductance and power, then expansion.
class Lumping {
 public:
  /// Fits the lumped network to what the cells show, undisturbed: the best any calibration could do.
  Lumping(Machine& machine, const std::vector<Experiment>& batches)
      : batches_(coarse(batches)), channels_(static_cast<Index>(part_sensors(machine).size()) + 1) {
    std::vector<Experiment> still;
    for (const Experiment& batch : batches) still.push_back(calm(batch));
    const Vector goal = stacked(undisturbed(machine, machine.plant, false, still));
    const Plant first = machine.lumped;
    const Index lumps = first.cells();
    const Index n = 3 * lumps + static_cast<Index>(first.links.size() + first.sources.size());
    prior_ = Vector::Constant(n, 1 / (.3 * .3));
    for (Index i = 0; i < lumps; ++i)
      prior_[n - lumps + i] = first.um_per_K[i] == 0 ? 1e12 : std::pow(.3 * std::abs(first.um_per_K[i]) + .05, -2);
    const auto misfit = [&](const Vector& change) {
      return Vector(goal - stacked(undisturbed(machine, moved(first, change), true, batches_)));
    };
    const auto cost = [&](const Vector& rest, const Vector& change) {
      return rest.squaredNorm() + change.dot(prior_.cwiseProduct(change));
    };
    Vector change = Vector::Zero(n);
    left_ = misfit(change);
    for (int pass = 0; pass < 4; ++pass) {
      jacobian_ = slopes(machine, first, change);
      Matrix normal = jacobian_.transpose() * jacobian_;
      normal.diagonal() += prior_;
      const Eigen::LLT<Matrix> solver(normal);
      Vector step = solver.solve(jacobian_.transpose() * left_ - prior_.cwiseProduct(change));
      const double before = cost(left_, change);
      for (int halving = 0; halving < 5; ++halving, step *= .4) {
        const Vector rest = misfit(change + step);
        if (cost(rest, change + step) >= before) continue;
        change += step;
        left_ = rest;
        break;
      }
      if (cost(left_, change) > .99 * before) break;
    }
    machine.lumped = moved(first, change);
    add_offsets();
    Matrix normal = jacobian_.transpose() * jacobian_;
    normal.diagonal() += prior_;
    solver_.compute(normal);
  }

  /// rms of the lumping error per channel, in K, the last in um.
  Vector lumping_error() const { return channel_rms(left_); }

  /// What calibration leaves of a signature (same rows as the signals), rms per channel.
  Vector left_after_calibration(const Signals& signature) const {
    const Vector all = stacked(signature);
    return channel_rms(all - jacobian_ * solver_.solve(jacobian_.transpose() * all));
  }

  /// rms per channel of stacked signals, in K, the last in um.
  Vector channel_rms(const Vector& all) const {
    const Index channels = channels_;
    Vector square = Vector::Zero(channels);
    Index at = 0, rows = 0;
    for (const Experiment& batch : batches_) {
      for (Index c = 0; c < channels; ++c, at += batch.samples())
        square[c] += all.segment(at, batch.samples()).squaredNorm();
      rows += batch.samples();
    }
    Vector rms = (square / static_cast<double>(rows)).cwiseSqrt();
    rms.head(channels - 1) *= sensor_weight_K;
    rms[channels - 1] *= output_weight_um;
    return rms;
  }

 private:
  static Plant moved(Plant plant, const Vector& change) {
    Index at = 0;
    const auto factor = [&] { return std::exp(std::clamp(change[at++], -2., 2.)); };
    for (double& value : plant.capacity_J_per_K) value *= factor();
    for (double& value : plant.ambient_W_per_K) value *= factor();
    for (Link& link : plant.links) link.W_per_K *= factor();
    for (Source& source : plant.sources) source.power_W *= factor();
    for (double& value : plant.um_per_K) value += change[at++];
    return plant;
  }

  Matrix slopes(const Machine& machine, const Plant& first, const Vector& at) const {
    const Vector base = stacked(undisturbed(machine, moved(first, at), true, batches_));
    Matrix jacobian(base.size(), at.size());
    for (Index p = 0; p < at.size(); ++p) {
      Vector change = at;
      change[p] += .02;
      jacobian.col(p) = (stacked(undisturbed(machine, moved(first, change), true, batches_)) - base) / .02;
    }
    return jacobian;
  }

  /// A thermometer may also sit up to .5 K off: one more column each, for what calibration can swallow.
  void add_offsets() {
    const Index sensors = channels_ - 1, parameters = jacobian_.cols();
    jacobian_.conservativeResize(Eigen::NoChange, parameters + sensors);
    jacobian_.rightCols(sensors).setZero();
    prior_.conservativeResize(parameters + sensors);
    prior_.tail(sensors).setConstant(1 / (.5 * .5));
    Index at = 0;
    for (const Experiment& batch : batches_)
      for (Index c = 0; c <= sensors; ++c, at += batch.samples())
        if (c < sensors) jacobian_.col(parameters + c).segment(at, batch.samples()).setConstant(1 / sensor_weight_K);
  }

  std::vector<Experiment> batches_;
  Index channels_;
  Matrix jacobian_;
  Eigen::LLT<Matrix> solver_;
  Vector prior_, left_;
};

/// Every parameter off by about `relative`, as a nominal machine is.
inline void miscalibrate(Plant& lumped, Random& random, double relative) {
  const auto factor = [&] { return std::exp(relative * std::clamp(random.normal(), -2., 2.)); };
  for (double& value : lumped.capacity_J_per_K) value *= factor();
  for (double& value : lumped.ambient_W_per_K) value *= factor();
  for (Link& link : lumped.links) link.W_per_K *= factor();
  for (Source& source : lumped.sources) source.power_W *= factor();
  for (double& value : lumped.um_per_K) value *= factor();
}

}  // namespace blind
