#pragma once

/// Measured batches beside what a simulator said for them, sample by sample, and how they are paired.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/error.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

/// One batch, measured and simulated.
struct PairedBatch {
  std::string name;  ///< of the measured batch
  Vector time_s;     ///< since the first common sample
  Matrix measured;   ///< samples x channels
  Matrix simulated;  ///< samples x channels, at the measured samples
  Matrix inputs;     ///< samples x inputs
  Vector room_degC;  ///< ambient reading; empty where there is none
};

/// Channels are the temperatures both sides have, then the displacements.
struct PairedCampaign {
  std::vector<std::string> channels;  ///< names that both sides have
  std::vector<std::string> inputs;    ///< names of the measured side
  Index temperatures = 0;             ///< the first so many channels are degC, the others um
  std::string room;  ///< the ambient column: given, or the temperature that the simulator took over unchanged
  bool room_is_simulated = false;          ///< the simulator used the measured ambient
  bool zeroed = true;                      ///< displacements count from their first sample
  std::vector<PairedBatch> batches;        ///< in the order of the measured ones
  std::vector<std::string> not_simulated;  ///< temperatures that were measured only; left out
  std::vector<std::string> not_paired;     ///< batches without a simulated counterpart; left out
  bool resampled = false;                  ///< simulated values were read off at measured times

  /// Temperatures and displacements.
  Index channel_count() const { return static_cast<Index>(channels.size()); }
  /// Whether the simulator is answerable for a channel; the ambient is an input.
  bool is_output(Index c) const { return c >= temperatures || channels[static_cast<std::size_t>(c)] != room; }
  /// Samples of all batches.
  Index rows() const { return first_row(batches.size()); }

  /// Where batch `b` begins when all are stacked below each other.
  Index first_row(std::size_t b) const {
    Index sum = 0;
    for (std::size_t k = 0; k < b; ++k) sum += batches[k].time_s.size();
    return sum;
  }

  /// The rows of batch `b` in a stack.
  template <class Stack>
  auto part(Stack& stack, std::size_t b) const {
    return stack.middleRows(first_row(b), batches[b].time_s.size());
  }
};

namespace detail {

/// `values` at time `t`, linear between samples; `t` must lie within `time_s`.
inline double linear_at(const Vector& time_s, const Vector& values, double t) {
  const double* begin = time_s.data();
  const Index after =
      std::min<Index>(std::max<Index>(std::lower_bound(begin, begin + time_s.size(), t) - begin, 1), time_s.size() - 1);
  const double share = (t - time_s(after - 1)) / (time_s(after) - time_s(after - 1));
  return values(after - 1) + share * (values(after) - values(after - 1));
}

/// Names of `left` that `right` has too, in the order of `left`.
inline std::vector<std::string> common_names(const std::vector<std::string>& left,
                                             const std::vector<std::string>& right) {
  std::vector<std::string> names;
  for (const std::string& name : left)
    if (std::find(right.begin(), right.end(), name) != right.end()) names.push_back(name);
  return names;
}

template <typename Scalar>
void require_clock(const Batch& batch) {
  if (!batch.has_time() || batch.rows() < 8)
    throw Error(batch.source.empty() ? batch.name : batch.source,
                batch.has_time() ? "only " + std::to_string(batch.rows()) + " samples" : "no time column",
                "a time column and at least 8 samples", "paired diagnosis compares courses in time");
  for (const Channels* channels : {&batch.temperatures, &batch.errors, &batch.inputs})
    if (const MatrixX<Scalar>& values = channels->values; !values.allFinite())
      throw Error(batch.source.empty() ? batch.name : batch.source, "missing values", "numbers only",
                  "read it with CsvOptions::missing = drop or CsvOptions::missing = hold");
}

template <typename Scalar>
PairedBatch pair(const Batch& real, const Batch& sim, const PairedCampaign& campaign, bool& resampled) {
  const double from = std::max(real.time_s(0), sim.time_s(0));
  const double to = std::min(real.time_s(real.rows() - 1), sim.time_s(sim.rows() - 1));
  std::vector<Index> rows;
  for (Index row = 0; row < real.rows(); ++row)
    if (real.time_s(row) >= from && real.time_s(row) <= to) rows.push_back(row);
  if (rows.size() < 8)
    throw Error("batch " + real.name,
                "measured and simulated times have " + std::to_string(rows.size()) + " samples in common", "at least 8",
                "check the time columns and their units");
  const Index count = static_cast<Index>(rows.size());
  PairedBatch pair{real.name,
                   Vector(count),
                   Matrix(count, campaign.channel_count()),
                   Matrix(count, campaign.channel_count()),
                   Matrix(count, real.inputs.count()),
                   {}};
  for (Index k = 0; k < count; ++k) {
    const Index row = rows[static_cast<std::size_t>(k)];
    pair.time_s(k) = real.time_s(row) - real.time_s(rows[0]);
    for (Index i = 0; i < real.inputs.count(); ++i) pair.inputs(k, i) = real.inputs.values(row, i);
  }
  for (Index c = 0; c < campaign.channel_count(); ++c) {
    const std::string& name = campaign.channels[static_cast<std::size_t>(c)];
    const Channels& measured = c < campaign.temperatures ? real.temperatures : real.errors;
    const Channels& simulated = c < campaign.temperatures ? sim.temperatures : sim.errors;
    const MatrixX<Scalar>& values = simulated.values;
    const VectorX<Scalar> course = values.col(simulated.find(name));
    for (Index k = 0; k < count; ++k) {
      const Index row = rows[static_cast<std::size_t>(k)];
      pair.measured(k, c) = measured.values(row, measured.find(name));
      const bool same = row < sim.rows() && sim.time_s(row) == real.time_s(row);
      pair.simulated(k, c) = same ? course(row) : linear_at(sim.time_s, course, real.time_s(row));
      resampled = resampled || !same;
    }
  }
  return pair;
}

}  // namespace detail

/// Pairs batches by name. Channels that only one side has are left out and told; simulated courses are read off
/// linearly at the measured samples, within the time both cover. `room` names the ambient temperature; empty: the
/// column in which measured and simulated agree to .006 K, if there is exactly one. Throws Error when no batch or no
/// channel pairs, when a batch has no clock, or has missing values.
template <typename Scalar = double>
PairedCampaign pair_campaigns(const Campaign& real, const Campaign& sim, std::string room = {}) {
  PairedCampaign result;
  if (real.empty() || sim.empty()) throw Error("paired diagnosis", "no batches", "measured and simulated batches");
  for (const Campaign* campaign : {&real, &sim})
    for (const Batch& batch : *campaign) detail::require_clock<Scalar>(batch);
  const std::vector<std::string> temperatures =
      detail::common_names(real[0].temperatures.names, sim[0].temperatures.names);
  const std::vector<std::string> errors = detail::common_names(real[0].errors.names, sim[0].errors.names);
  result.channels = temperatures;
  result.channels.insert(result.channels.end(), errors.begin(), errors.end());
  result.temperatures = static_cast<Index>(temperatures.size());
  result.inputs = real[0].inputs.names;
  if (result.channels.empty())
    throw Error(sim[0].source.empty() ? "simulated batches" : sim[0].source, "no channel of the measured batches",
                "columns with the same names on both sides",
                "rename them or set CsvOptions::temperatures and CsvOptions::errors");
  for (const std::string& name : real[0].temperatures.names)
    if (sim[0].temperatures.find(name) < 0) result.not_simulated.push_back(name);

  for (const Batch& batch : real) {
    const auto same =
        std::find_if(sim.begin(), sim.end(), [&](const Batch& other) { return other.name == batch.name; });
    if (same == sim.end()) {
      result.not_paired.push_back(batch.name);
      continue;
    }
    result.batches.push_back(detail::pair<Scalar>(batch, *same, result, result.resampled));
  }
  if (result.batches.empty())
    throw Error("pair_campaigns::sim", "no simulated batch has the name of a measured one",
                "files with equal names on both sides",
                "the first measured batch is " + real[0].name + ", the first simulated " + sim[0].name);

  std::vector<std::string> copies, held;
  for (Index c = 0; c < result.temperatures; ++c) {
    bool copy = true, constant = true;
    double change = 0;
    for (const PairedBatch& batch : result.batches) {
      const MatrixX<Scalar>&measured = batch.measured, &simulated = batch.simulated;
      copy = copy && (measured.col(c) - simulated.col(c)).cwiseAbs().maxCoeff() < .006;
      constant = constant && simulated.col(c).maxCoeff() - simulated.col(c).minCoeff() < 1e-9;
      change = std::max(change, measured.col(c).maxCoeff() - measured.col(c).minCoeff());
    }
    if (copy) copies.push_back(result.channels[static_cast<std::size_t>(c)]);
    if (constant && change > 0) held.push_back(result.channels[static_cast<std::size_t>(c)]);
  }
  result.room_is_simulated = room.empty() ? copies.size() == 1 : std::count(copies.begin(), copies.end(), room) > 0;
  if (room.empty() && copies.size() == 1) room = copies[0];
  if (room.empty() && held.size() == 1) room = held[0];
  const Index column = real[0].temperatures.find(room);
  if (!room.empty() && column < 0)
    throw Error("OutputsOptions::room", "no temperature '" + room + "'", "a temperature column of the batches");
  result.room = room;
  for (PairedBatch& batch : result.batches) {
    const auto at = std::find(result.channels.begin(), result.channels.begin() + result.temperatures, room);
    if (column >= 0 && at != result.channels.begin() + result.temperatures) {
      const MatrixX<Scalar>& measured = batch.measured;
      batch.room_degC = measured.col(at - result.channels.begin());
    }
    for (Index c = result.temperatures; c < result.channel_count(); ++c)
      result.zeroed = result.zeroed && std::abs(batch.simulated(0, c)) < 1e-9;
  }
  return result;
}

}  // namespace thermfit
