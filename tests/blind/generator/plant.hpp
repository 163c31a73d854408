#pragma once

/// The "real" machine: a finite-volume heat balance and its own integrator.

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace blind {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using Index = Eigen::Index;

struct Link {
  Index a, b;
  double W_per_K;
};

struct Source {
  std::string name, input;
  double scale, exponent, power_W;
  std::vector<std::pair<Index, double>> into;  ///< cell, share
};

/// Cells with capacities, exchange with the air, expansion weights; links; heat sources.
struct Plant {
  Vector capacity_J_per_K, ambient_W_per_K, um_per_K;
  std::vector<Link> links;
  std::vector<Source> sources;

  Index cells() const { return capacity_J_per_K.size(); }

  /// Appends a cell at rest and returns its index.
  Index add_cell(double capacity, double ambient) {
    const Index cell = cells();
    for (Vector* values : {&capacity_J_per_K, &ambient_W_per_K, &um_per_K}) values->conservativeResize(cell + 1);
    capacity_J_per_K[cell] = capacity;
    ambient_W_per_K[cell] = ambient;
    um_per_K[cell] = 0;
    return cell;
  }
};

/// What is done to the machine in one batch. Inputs hold from a sample to the next; the air is known between samples.
struct Experiment {
  std::string name;
  double interval_s = 180;
  int steps = 9;                    ///< integration steps between samples
  std::vector<std::string> inputs;  ///< names of the columns of `input`
  Matrix input;                     ///< samples x inputs
  Vector air_degC;                  ///< at every step, fine_rows()
  Matrix draught_K;                 ///< local air minus room air, fine_rows() x cells; empty for none

  Index samples() const { return input.rows(); }
  Index fine_rows() const { return (samples() - 1) * steps + 1; }
  double step_s() const { return interval_s / steps; }
  Index column(const std::string& name_of_input) const {
    for (std::size_t i = 0; i < inputs.size(); ++i)
      if (inputs[i] == name_of_input) return static_cast<Index>(i);
    return -1;
  }
  double held(Index input_column, Index fine_row) const {
    return input(std::min(fine_row / steps, samples() - 1), input_column);
  }
};

struct Instant {
  const Experiment& experiment;
  std::size_t batch;
  Index row;  ///< fine row at the start of the step
  double time_s, air_degC;
  const Vector& theta;
};

/// Adds heat flows in W into the cells, beyond the linear balance.
using HeatFlow = std::function<void(const Instant&, Vector& flow_W)>;

inline Matrix balance_per_s(const Plant& plant) {
  Matrix rate = Matrix::Zero(plant.cells(), plant.cells());
  for (const Link& link : plant.links) {
    rate(link.a, link.a) -= link.W_per_K;
    rate(link.b, link.b) -= link.W_per_K;
    rate(link.a, link.b) += link.W_per_K;
    rate(link.b, link.a) += link.W_per_K;
  }
  rate.diagonal() -= plant.ambient_W_per_K;
  return plant.capacity_J_per_K.cwiseInverse().asDiagonal() * rate;
}

inline double source_W(const Source& source, double value) {
  const double x = source.input == "constant" ? 1 : std::abs(value) / source.scale;
  return x > 0 ? source.power_W * std::pow(x, source.exponent) : 0;
}

/// Cell temperatures at every step (fine_rows x cells). Implicit in the linear balance and explicit in the rest: the
/// stiffly accurate, L-stable second-order pair ARS(2,2,2) of Ascher, Ruuth and Spiteri 1997.
inline Matrix simulate(const Plant& plant, const Experiment& experiment, std::size_t batch, const Vector& start,
                       const std::vector<HeatFlow>& extra) {
  const double gamma = 1 - std::sqrt(.5), delta = 1 - 1 / (2 * gamma), step = experiment.step_s();
  const Index n = plant.cells();
  const Matrix solve = (Matrix::Identity(n, n) - gamma * step * balance_per_s(plant)).inverse();
  const Vector per_capacity = plant.capacity_J_per_K.cwiseInverse();
  Matrix trace(n, experiment.fine_rows());
  Vector theta = start, stage(n), sources(n), flow(n), first(n), second(n), right(n), implicit(n);
  trace.col(0) = theta;

  std::vector<Index> columns;
  for (const Source& source : plant.sources) columns.push_back(experiment.column(source.input));
  const auto explicit_rate = [&](Index row, double fraction, const Vector& at, Vector& rate) {
    const double air = experiment.air_degC[row] + fraction * (experiment.air_degC[row + 1] - experiment.air_degC[row]);
    flow = sources + plant.ambient_W_per_K * air;
    if (experiment.draught_K.size()) {
      const Index given = experiment.draught_K.cols();
      flow.head(given) += plant.ambient_W_per_K.head(given).cwiseProduct(experiment.draught_K.row(row).transpose());
    }
    const Instant now{experiment, batch, row, (static_cast<double>(row) + fraction) * step, air, at};
    for (const HeatFlow& heat : extra) heat(now, flow);
    rate = per_capacity.cwiseProduct(flow);
  };

  for (Index row = 0; row + 1 < experiment.fine_rows(); ++row) {
    if (row % experiment.steps == 0) {
      sources.setZero();
      for (std::size_t s = 0; s < plant.sources.size(); ++s) {
        const double value = columns[s] < 0 ? 0 : experiment.held(columns[s], row);
        const double watts = source_W(plant.sources[s], value);
        for (const auto& [cell, share] : plant.sources[s].into) sources[cell] += share * watts;
      }
    }
    explicit_rate(row, 0, theta, first);
    right = theta + gamma * step * first;
    stage.noalias() = solve * right;
    implicit = (stage - right) / (gamma * step);
    explicit_rate(row, gamma, stage, second);
    right = theta + step * ((1 - gamma) * implicit + delta * first + (1 - delta) * second);
    theta.noalias() = solve * right;
    trace.col(row + 1) = theta;
  }
  return trace.transpose();
}

}  // namespace blind
