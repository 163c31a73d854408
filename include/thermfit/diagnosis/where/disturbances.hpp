#pragma once

/// What disturbances of unknown course would do to the outputs: heat into a node, a wandering reading, a late clock.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/map_fit.hpp"
#include "thermfit/network/effect.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

/// A place with a disturbance of unknown course.
struct DisturbedPlace {
  std::string name;           ///< a node, a sensor, `displacement`, `ambient`, `start` or `clock`
  Stage stage = Stage::heat;  ///< at which it disturbs
  double gain = 0;            ///< log likelihood the disturbance adds alone, nats
  double gain_beside = 0;     ///< what it still adds beside the places picked before it
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
template <typename Scalar>
struct PlaceTraces {
  DisturbedPlace place;
  std::vector<MatrixX<Scalar>> by_batch;
};

/// Makes the traces of all places, whitened by the noise that a right machine would leave.
template <typename Scalar = double>
class Disturbances {
 public:
  static constexpr Index pieces = 6;  ///< of time a batch is cut into

  Disturbances(const MachineRecord& seen, const MapFit& fit, const EffectLibrary& library)
      : seen_(seen),
        whiteners_(whiteners_of(seen, expected_noise(seen, fit))),
        machine_(fit.network()),
        library_(library) {}

  const ThermalNetwork& machine() const { return machine_; }

  std::vector<PlaceTraces<Scalar>> all() {
    add_heat();
    add_readings();
    add_clock();
    return std::move(traces_);
  }

  /// Stacks the whitened channels of a batch; `column(c)` gives the unwhitened samples x columns of channel c.
  template <class Columns>
  MatrixX<Scalar> stacked(std::size_t batch, Index columns, Columns column) const {
    const Index samples = seen_.time_s[batch].size();
    MatrixX<Scalar> result(rows(batch), columns);
    for (std::size_t c = 0; c < seen_.channels.size(); ++c) {
      MatrixX<Scalar> part = column(c);
      whiteners_[c][batch].apply(part);
      result.middleRows(static_cast<Index>(c) * samples, samples) = part;
    }
    return result;
  }

 private:
  /// The noise a right machine would leave. The fitted one may not serve: where calibration fails, its slow part has
  /// swallowed the very disturbance that is looked for.
  static std::vector<ResidualNoise> expected_noise(const MachineRecord& seen, const MapFit& fit) {
    std::vector<ResidualNoise> noise = fit.noise;
    for (std::size_t c = 0; c < noise.size(); ++c)
      noise[c].slow = std::min(noise[c].slow, 2 * seen.channels[c].bounds.least_slow);
    return noise;
  }

  Index rows(std::size_t batch) const { return seen_.time_s[batch].size() * static_cast<Index>(seen_.channels.size()); }

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
    PlaceTraces<Scalar> ambient{{"ambient", Stage::boundary, 0, 0}, {}};
    for (Index node = 0; node < machine_.node_count(); ++node) {
      PlaceTraces<Scalar> one{{machine_.nodes[static_cast<std::size_t>(node)].name, Stage::heat, 0, 0}, {}};
      for (std::size_t b = 0; b < seen_.batches(); ++b) {
        const Index samples = seen_.time_s[b].size();
        one.by_batch.push_back(stacked(b, pieces, [&](std::size_t c) -> MatrixX<Scalar> {
          return simulated[b].jacobian.block(seen_.channels[c].column * samples, node * pieces, samples, pieces);
        }));
        const MatrixX<Scalar> share = machine_.nodes[static_cast<std::size_t>(node)].ambient_W_per_K * one.by_batch[b];
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
      PlaceTraces<Scalar> one{{seen_.channels[own].name, displacement ? Stage::expansion : Stage::measurement, 0, 0},
                              {}};
      if (displacement) one.place.name = "displacement";
      for (std::size_t b = 0; b < seen_.batches(); ++b) {
        const Index samples = seen_.time_s[b].size();
        one.by_batch.push_back(stacked(b, pieces, [&](std::size_t c) -> MatrixX<Scalar> {
          MatrixX<Scalar> piece = MatrixX<Scalar>::Zero(samples, pieces);
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
    PlaceTraces<Scalar> start{{"start", Stage::initial, 0, 0}, {}}, clock{{"clock", Stage::measurement, 0, 0}, {}};
    for (std::size_t b = 0; b < seen_.batches(); ++b) {
      const Index samples = seen_.time_s[b].size();
      start.by_batch.push_back(stacked(b, 1, [&](std::size_t c) -> MatrixX<Scalar> {
        return moved[b].channels.col(seen_.channels[c].column) - plain[b].channels.col(seen_.channels[c].column);
      }));
      clock.by_batch.push_back(stacked(b, 1, [&](std::size_t c) -> MatrixX<Scalar> {
        MatrixX<Scalar> slope = MatrixX<Scalar>::Zero(samples, 1);
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
  std::vector<std::vector<Whitener>> whiteners_;
  ThermalNetwork machine_;
  const EffectLibrary& library_;
  std::vector<PlaceTraces<Scalar>> traces_;
};

}  // namespace detail

}  // namespace thermfit
