#pragma once

/// Where a model is deficient, without assuming what the effect is: an unknown heat flow per node, a wandering bias per
/// sensor, a disturbance of the displacement, and spread families, all competing (Kristensen, Madsen, Joergensen 2004).

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "thermfit/calibration/map_fit.hpp"
#include "thermfit/network/effect.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

/// A place with a disturbance of unknown course.
struct DisturbedPlace {
  std::string name;
  Stage stage = Stage::heat;
  double gain = 0;         ///< log likelihood the disturbance adds alone, nats
  double gain_beside = 0;  ///< what it still adds beside the places picked before it
};

namespace detail {

/// Heat of either sign into one node, driven by one column.
class UnknownHeat : public Effect {
 public:
  std::string name() const override { return "unknown-heat"; }
  Stage stage() const override { return Stage::heat; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting&) const override { return {}; }
  std::vector<EffectParameter> parameters(const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    return {linear_parameter("power_W", "W", 1)};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const Index input = system.input(added.driver);
    system.heat({{network.find_node(added.location), 1.0}},
                [input](const Moment& now, const double* p) { return p[0] * now.inputs[input]; });
  }
};

/// What a place can do to the whitened outputs: per batch, one row per channel and sample, one column per piece of
/// time.
struct PlaceTraces {
  DisturbedPlace place;
  std::vector<Matrix> by_batch;
};

class PlaceSearch {
 public:
  static constexpr Index pieces = 6;

  PlaceSearch(const MachineRecord& seen, const MapFit& fit, const EffectLibrary& library)
      : seen_(seen),
        fit_(fit),
        whiteners_(whiteners_of(seen, expected_noise(seen, fit))),
        machine_(fit.network()),
        library_(library) {}

  /// Places in the order in which they are picked, then the others by what they add alone.
  std::vector<DisturbedPlace> run() {
    whiten_model();
    add_heat();
    add_readings();
    add_clock();
    std::vector<DisturbedPlace> picked;
    for (PlaceTraces& one : traces_) one.place.gain = one.place.gain_beside = gain_of(one).gain;
    for (int round = 0; round < 3; ++round) {
      PlaceTraces* best = nullptr;
      for (PlaceTraces& one : traces_)
        if (!one.by_batch.empty() && (!best || one.place.gain_beside > best->place.gain_beside)) best = &one;
      if (!best || best->place.gain_beside < 5) break;
      const double variance = gain_of(*best).variance;
      picked.push_back(best->place);
      add_nuisance(*best, variance);
      best->by_batch.clear();
      if (round < 2)
        for (PlaceTraces& one : traces_)
          if (!one.by_batch.empty()) one.place.gain_beside = gain_of(one).gain;
    }
    std::vector<DisturbedPlace> others;
    for (const PlaceTraces& one : traces_)
      if (!one.by_batch.empty()) others.push_back(one.place);
    std::stable_sort(others.begin(), others.end(),
                     [](const DisturbedPlace& a, const DisturbedPlace& b) { return a.gain > b.gain; });
    for (DisturbedPlace& other : others) other.gain_beside = 0;
    picked.insert(picked.end(), others.begin(), others.end());
    return picked;
  }

 private:
  struct Best {
    double gain = 0, variance = 0;
  };

  /// The noise a right machine would leave. The fitted one may not serve: where calibration fails, its slow part has
  /// swallowed the very disturbance that is looked for.
  static std::vector<ResidualNoise> expected_noise(const MachineRecord& seen, const MapFit& fit) {
    std::vector<ResidualNoise> noise = fit.noise;
    for (std::size_t c = 0; c < noise.size(); ++c)
      noise[c].slow = std::min(noise[c].slow, 2 * seen.channels[c].bounds.least_slow);
    return noise;
  }

  Index rows(std::size_t batch) const { return seen_.time_s[batch].size() * static_cast<Index>(seen_.channels.size()); }

  /// Stacks the whitened channels of a batch; `column(c)` gives the unwhitened samples x columns of channel c.
  template <class Columns>
  Matrix stacked(std::size_t batch, Index columns, Columns column) const {
    const Index samples = seen_.time_s[batch].size();
    Matrix result(rows(batch), columns);
    for (std::size_t c = 0; c < seen_.channels.size(); ++c) {
      Matrix part = column(c);
      whiteners_[c][batch].apply(part);
      result.middleRows(static_cast<Index>(c) * samples, samples) = part;
    }
    return result;
  }

  void whiten_model() {
    const std::vector<Simulation> simulated = simulate(machine_, seen_.excitations, library_, fit_.parameters);
    const Vector slopes = fit_.slopes();
    const Index n = slopes.size();
    information_ = Matrix::Identity(n, n);
    for (std::size_t b = 0; b < seen_.batches(); ++b) {
      const Index samples = seen_.time_s[b].size();
      nuisance_.push_back(stacked(b, n, [&](std::size_t c) -> Matrix {
        return simulated[b].jacobian.middleRows(seen_.channels[c].column * samples, samples) * slopes.asDiagonal();
      }));
      residual_.push_back(stacked(b, 1, [&](std::size_t c) -> Matrix {
        return seen_.channels[c].measured[b] - simulated[b].channels.col(seen_.channels[c].column);
      }));
      information_ += nuisance_[b].transpose() * nuisance_[b];
    }
    factor_ = information_.llt();
  }

  /// Adds a disturbance of known variance to what is free.
  void add_nuisance(const PlaceTraces& one, double variance) {
    const Index old = information_.rows(), batches = static_cast<Index>(one.by_batch.size());
    const Index more = one.by_batch[0].cols();
    Matrix larger = Matrix::Zero(old + more * batches, old + more * batches);
    larger.topLeftCorner(old, old) = information_;
    for (Index b = 0; b < batches; ++b) {
      const std::size_t k = static_cast<std::size_t>(b);
      const Index at = old + b * more;
      larger.block(at, at, more, more) =
          one.by_batch[k].transpose() * one.by_batch[k] + Matrix::Identity(more, more) / variance;
      larger.block(0, at, old, more) = nuisance_[k].transpose() * one.by_batch[k];
      larger.block(at, 0, more, old) = larger.block(0, at, old, more).transpose();
      Matrix wider = Matrix::Zero(nuisance_[k].rows(), old + more * batches);
      wider.leftCols(old) = nuisance_[k];
      wider.middleCols(at, more) = one.by_batch[k];
      nuisance_[k] = std::move(wider);
    }
    information_ = std::move(larger);
    factor_ = information_.llt();
  }

  /// The likelihood as a function of the disturbance's variance v, with everything in the nuisance integrated out:
  /// sum over eigenvalues l of G = V'M^-1 V of u^2 / (1/v + l) - log(1 + v l), halved; u = V'M^-1 r in that basis.
  Best gain_of(const PlaceTraces& one) const {
    const Index q = one.by_batch[0].cols(), batches = static_cast<Index>(one.by_batch.size());
    Matrix across(information_.rows(), q * batches), own = Matrix::Zero(q * batches, q * batches);
    Vector score = Vector::Zero(information_.rows()), along(q * batches);
    for (Index b = 0; b < batches; ++b) {
      const std::size_t k = static_cast<std::size_t>(b);
      across.middleCols(b * q, q).noalias() = nuisance_[k].transpose() * one.by_batch[k];
      own.block(b * q, b * q, q, q).noalias() = one.by_batch[k].transpose() * one.by_batch[k];
      along.segment(b * q, q).noalias() = one.by_batch[k].transpose() * residual_[k];
      score.noalias() += nuisance_[k].transpose() * residual_[k];
    }
    score.head(fit_.coordinates.size()) -= fit_.coordinates;
    const Matrix solved = factor_.solve(across);
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(own - across.transpose() * solved);
    const Vector u = eigen.eigenvectors().transpose() * (along - solved.transpose() * score);
    const Vector values = eigen.eigenvalues().cwiseMax(0);
    Best best;
    const double largest = values.maxCoeff();
    if (largest <= 0) return best;
    for (double scaled = 1e-2; scaled < 1e7; scaled *= 2) {
      const double variance = scaled / largest;
      double gain = 0;
      for (Index k = 0; k < u.size(); ++k)
        gain += .5 * (u(k) * u(k) / (1 / variance + values(k)) - std::log1p(variance * values(k)));
      if (gain > best.gain) best = {gain, variance};
    }
    return best;
  }

  /// Heat into every node, and into all at once as the ambient would bring it, piece by piece of the batch.
  void add_heat() {
    ThermalNetwork network = machine_;
    std::vector<Excitation> excitations = seen_.excitations;
    for (Excitation& one : excitations) {
      const Index known = one.inputs.cols();
      one.inputs.conservativeResize(Eigen::NoChange, known + pieces);
      one.inputs.rightCols(pieces).setZero();
      for (Index k = 0; k < one.samples(); ++k) one.inputs(k, known + k * pieces / one.samples()) = 1;
      for (Index piece = 0; piece < pieces; ++piece) one.input_names.push_back("piece " + std::to_string(piece));
    }
    std::vector<Parameter> powers;
    for (const ThermalNetwork::Node& node : machine_.nodes)
      for (Index piece = 0; piece < pieces; ++piece) {
        Parameter power;
        power.kind = Parameter::Kind::effect;
        power.item = network.effects.size();
        powers.push_back(power);
        network.effects.push_back({"unknown-heat", node.name, "piece " + std::to_string(piece), {{"power_W", 0}}});
      }
    EffectLibrary library = library_;
    library.add(std::make_shared<UnknownHeat>());
    const std::vector<Simulation> simulated = simulate(network, excitations, library, powers);
    PlaceTraces ambient{{"ambient", Stage::boundary, 0, 0}, {}};
    for (Index node = 0; node < machine_.node_count(); ++node) {
      PlaceTraces one{{machine_.nodes[static_cast<std::size_t>(node)].name, Stage::heat, 0, 0}, {}};
      for (std::size_t b = 0; b < seen_.batches(); ++b) {
        const Index samples = seen_.time_s[b].size();
        one.by_batch.push_back(stacked(b, pieces, [&](std::size_t c) -> Matrix {
          return simulated[b].jacobian.block(seen_.channels[c].column * samples, node * pieces, samples, pieces);
        }));
        const Matrix share = machine_.nodes[static_cast<std::size_t>(node)].ambient_W_per_K * one.by_batch[b];
        if (node == 0)
          ambient.by_batch.push_back(share);
        else
          ambient.by_batch[b] += share;
      }
      traces_.push_back(std::move(one));
    }
    traces_.push_back(std::move(ambient));
  }

  /// Readings that are off by a broken line with a corner between any two of the pieces.
  void add_readings() {
    for (std::size_t own = 0; own < seen_.channels.size(); ++own) {
      const bool displacement = seen_.channels[own].displacement;
      PlaceTraces one{{seen_.channels[own].name, displacement ? Stage::expansion : Stage::measurement, 0, 0}, {}};
      if (displacement) one.place.name = "displacement";
      for (std::size_t b = 0; b < seen_.batches(); ++b) {
        const Index samples = seen_.time_s[b].size();
        one.by_batch.push_back(stacked(b, pieces, [&](std::size_t c) -> Matrix {
          Matrix piece = Matrix::Zero(samples, pieces);
          if (c == own)
            for (Index k = 0; k < samples; ++k) {  // a broken line: readings wander, they do not jump
              const double at = static_cast<double>(k * (pieces - 1)) / static_cast<double>(samples - 1);
              const Index corner = std::min(static_cast<Index>(at), pieces - 2);
              piece(k, corner + 1) = at - static_cast<double>(corner);
              piece(k, corner) = 1 - piece(k, corner + 1);
            }
          return piece;
        }));
      }
      traces_.push_back(std::move(one));
    }
  }

  /// A uniform start off ambient, and a displacement log that runs late.
  void add_clock() {
    std::vector<Excitation> warmer = seen_.excitations;
    for (Excitation& one : warmer) one.start_degC.array() += 1;
    const std::vector<Simulation> plain = simulate(machine_, seen_.excitations, library_);
    const std::vector<Simulation> moved = simulate(machine_, warmer, library_);
    PlaceTraces start{{"start", Stage::initial, 0, 0}, {}}, clock{{"clock", Stage::measurement, 0, 0}, {}};
    for (std::size_t b = 0; b < seen_.batches(); ++b) {
      const Index samples = seen_.time_s[b].size();
      start.by_batch.push_back(stacked(b, 1, [&](std::size_t c) -> Matrix {
        return moved[b].channels.col(seen_.channels[c].column) - plain[b].channels.col(seen_.channels[c].column);
      }));
      clock.by_batch.push_back(stacked(b, 1, [&](std::size_t c) -> Matrix {
        Matrix slope = Matrix::Zero(samples, 1);
        if (seen_.channels[c].displacement)
          for (Index k = 1; k < samples; ++k)
            slope(k, 0) =
                plain[b].channels(k - 1, seen_.channels[c].column) - plain[b].channels(k, seen_.channels[c].column);
        return slope;
      }));
    }
    traces_.push_back(std::move(start));
    traces_.push_back(std::move(clock));
  }

  const MachineRecord& seen_;
  const MapFit& fit_;
  std::vector<std::vector<Whitener>> whiteners_;
  ThermalNetwork machine_;
  const EffectLibrary& library_;
  std::vector<Matrix> nuisance_;  ///< by batch: what calibration (and places picked) does to the whitened outputs
  std::vector<Vector> residual_;
  Matrix information_;
  Eigen::LLT<Matrix> factor_;
  std::vector<PlaceTraces> traces_;
};

}  // namespace detail

/// Effect-free places of a calibrated machine, picked ones first.
///
/// Each place gets a course of unknown disturbance (heat: six pieces a batch; readings: a broken line of six corners;
/// independent, of one variance), integrated out together with all calibration parameters: the batch form of an
/// unknown-input smoother with diffusion by maximum likelihood. The best is kept and the others judged anew beside it,
/// up to three. Under no deficiency a place gains rarely more than 3 nats (half chi-square mixture on the boundary); 5
/// are asked for.
inline std::vector<DisturbedPlace> disturbed_places(const MachineRecord& seen, const MapFit& calibrated,
                                                    const EffectLibrary& library) {
  return detail::PlaceSearch(seen, calibrated, library).run();
}

}  // namespace thermfit
