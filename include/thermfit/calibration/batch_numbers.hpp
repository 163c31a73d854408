#pragma once

/// Numbers of single batches that calibration estimates beside the machine: where its parts start, and a room that
/// nothing measures.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "thermfit/calibration/map_fit.hpp"
#include "thermfit/calibration/start_tolerance.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"

namespace thermfit {

/// What is known of the numbers of a batch before its data: standard deviations of their priors.
struct BatchNumberPriors {
  double least_start_K = 0.02;  ///< of a node that a thermometer reads: noise and steps of its first reading
  double between = 0.5;         ///< of a node without: this share of the spread of all starts
  double least_room_K = 1;      ///< of the level of the room
  double room_course_K = 3;     ///< of its drift, half of what it moves; the k-th shape has a k-th of it
  std::size_t most_shapes = 8;  ///< of the room's course
  int most_iterations = 15;     ///< of the fits that choose how many
};

namespace detail {

template <typename Scalar>
void give_starts(ThermalNetwork::OfBatch& own, const ThermalNetwork& network, const Lazy<Excitation, Scalar>& one,
                 const BatchNumberPriors& priors) {
  const VectorX<Scalar>& start = one.start_degC;
  const double room = one.ambient_degC(0);
  const double spread = std::max(start.maxCoeff(), room) - std::min(start.minCoeff(), room);
  const std::size_t n = network.nodes.size();
  std::vector<double> squares(n, 0), count(n, 0);
  for (const ThermalNetwork::Link& link : network.links)
    for (const Index end : {link.a, link.b}) {
      squares[static_cast<std::size_t>(end)] += std::pow(start(link.a) - start(link.b), 2);
      ++count[static_cast<std::size_t>(end)];
    }
  own.start_K.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const bool read = !one.start_sensors[i].empty();
    const double gradient = count[i] > 0 ? std::sqrt(squares[i] / count[i]) : 0;
    own.start_sd_K.push_back(read ? std::hypot(priors.least_start_K, network.uncertainty.sensor_placement * gradient)
                                  : std::max(start_tolerance_K, priors.between * spread));
  }
}

template <typename Scalar>
void give_room(ThermalNetwork::OfBatch& own, const Lazy<Excitation, Scalar>& one, std::size_t shapes,
               const BatchNumberPriors& priors) {
  double low = one.ambient_degC(0), high = low;
  for (Index s = 0; s < one.first_reading_degC.size(); ++s)
    if (const double degC = one.first_reading_degC(s); std::isfinite(degC))
      low = std::min(low, degC), high = std::max(high, degC);
  own.ambient_K.assign(shapes, 0);
  for (std::size_t k = 0; k < shapes; ++k)
    own.ambient_sd_K.push_back(k == 0 ? std::max(priors.least_room_K, (high - low) / 2)
                                      : priors.room_course_K / static_cast<double>(k));
}

}  // namespace detail

/// The machine with the numbers of each batch that its rules leave open, at the means of their priors: the start of
/// every node under Initial::Rule::fitted (what thermometers read first, a share of the step to its neighbours
/// uncertain as their placement is; between them freely), and under Ambient::Rule::unmeasured the first `room_shapes`
/// of room_shape(). Unchanged under other rules. Allocates.
template <typename Scalar = double>
ThermalNetwork with_batch_numbers(Lazy<ThermalNetwork, Scalar> network, const MachineRecord& seen,
                                  std::size_t room_shapes = 1, const BatchNumberPriors& priors = {}) {
  const bool starts = network.initial.rule == ThermalNetwork::Initial::Rule::fitted;
  const bool room = network.ambient.rule == ThermalNetwork::Ambient::Rule::unmeasured;
  network.batches.clear();
  if (!starts && !room) return network;
  for (const Excitation& one : seen.excitations) {
    ThermalNetwork::OfBatch& own = network.batches.emplace_back();
    own.name = one.batch;
    if (starts) detail::give_starts<Scalar>(own, network, one, priors);
    if (room) detail::give_room<Scalar>(own, one, room_shapes, priors);
  }
  return network;
}

/// with_batch_numbers(), of a room that nothing measures as many shapes as pay by the evidence: its level, with a
/// drift, or with four or eight shapes of its course, whichever makes the data most probable. Too few would leave the
/// level off by more than its uncertainty says. Throws Error as simulate() does.
template <typename Scalar = double>
ThermalNetwork with_batch_numbers_that_pay(const ThermalNetwork& network, const MachineRecord& seen,
                                           const EffectLibrary& library, const BatchNumberPriors& priors = {}) {
  ThermalNetwork best = with_batch_numbers<Scalar>(network, seen, 1, priors);
  if (network.ambient.rule != ThermalNetwork::Ambient::Rule::unmeasured) return best;
  MapFitOptions how;
  how.most_iterations = priors.most_iterations;
  how.tolerance = 1.5;
  double evidence = map_fit<Scalar>(seen, best, library, how).log_evidence;
  for (std::size_t shapes = 2; shapes <= priors.most_shapes; shapes *= 2) {
    ThermalNetwork richer = with_batch_numbers<Scalar>(network, seen, shapes, priors);
    const double reached = map_fit<Scalar>(seen, richer, library, how).log_evidence;
    if (reached <= evidence) continue;
    evidence = reached;
    best = std::move(richer);
  }
  return best;
}

THERMFIT_COMPILED_TEMPLATE(ThermalNetwork with_batch_numbers<double>(ThermalNetwork, const MachineRecord&, std::size_t,
                                                                     const BatchNumberPriors&));
THERMFIT_COMPILED_TEMPLATE(ThermalNetwork with_batch_numbers_that_pay<double>(
    const ThermalNetwork&, const MachineRecord&, const EffectLibrary&, const BatchNumberPriors&));

}  // namespace thermfit
