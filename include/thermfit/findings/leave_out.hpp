#pragma once

/// What findings leave of a campaign: the rows, points and batches that a model should not be made from, and why.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/kept_rows.hpp"
#include "thermfit/findings/campaign_findings.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/findings/unfit.hpp"
#include "thermfit/statistics/course_start.hpp"

namespace thermfit {

/// How much of a batch may be faulty before more than the faulty rows is left out.
struct LeaveOutLimits {
  double rows_share = 0.25;   ///< a channel that is faulty in more of a batch's rows is faulty as a whole there
  double points_share = 0.5;  ///< a batch with more of its temperatures faulty is left out as a whole
};

/// What to leave out of a campaign, and for which findings.
struct LeaveOut {
  /// What became of a finding that makes data unfit.
  enum class What { rows, temperature, error, batch };
  /// A finding that counts: a batch of the campaign, what is left out for it, and the finding.
  struct Reason {
    std::size_t batch;  ///< index in the campaign
    What what;          ///< `rows` of that batch; the temperature or error in all batches; that batch
    Finding finding;    ///< why
  };
  std::vector<std::vector<Index>> rows;   ///< of each batch, increasing, counted from 0; empty for a batch in `batches`
  std::vector<std::string> temperatures;  ///< left out of all batches: models need the same points everywhere
  std::vector<std::string> errors;        ///< left out of all batches
  std::vector<std::size_t> batches;       ///< left out, increasing
  std::vector<Reason> reasons;            ///< by batch, in the order of the findings

  /// Whether all of the campaign is kept. Does not allocate.
  bool nothing() const { return reasons.empty(); }
};

namespace detail {

/// Marks as `out` the batches that are better left out than their faulty temperatures: a point is one in so many of
/// every batch, a batch is one in so many of every point, and what costs fewer readings goes. A point that was bad on
/// one day of many stays a point of the model.
inline void fewest_readings(std::vector<std::vector<std::string>> faulty, std::size_t points, std::vector<bool>& out) {
  for (bool moved = true; moved;) {
    moved = false;
    std::size_t batches = 0;
    std::map<std::string, std::vector<std::size_t>> where;  // by point: the batches that it is faulty in
    for (std::size_t b = 0; b < out.size(); ++b) {
      if (out[b]) continue;
      ++batches;
      for (const std::string& name : faulty[b]) where[name].push_back(b);
    }
    std::map<std::size_t, std::size_t> own;  // by batch: how many are faulty nowhere else
    for (const auto& [name, in] : where)
      if (in.size() == 1) ++own[in.front()];
    for (const auto& [b, saved] : own)
      if (!moved && points < saved * batches) moved = out[b] = true;
    for (const auto& [name, in] : where)
      if (!moved && in.size() * points < batches)
        for (const std::size_t b : in) moved = out[b] = true;
  }
}

}  // namespace detail

/// What of `campaign` is better left out for the `findings` that find_faults(Campaign) made of it.
///
/// Bad rows (spikes, impossible numbers, short freezes) are left out as rows. A temperature that is faulty in more than
/// `rows_share` of a batch is left out of all batches, or those batches are left out: what costs fewer readings
/// (detail::fewest_readings). A batch is also left out when more than `points_share` of its temperatures are faulty, or
/// its copy or error is at fault. An error at fault in every batch is left out
/// itself. A jump leaves out the shorter side of its batch. What is worth knowing only (a late probe, a gap in time,
/// collinear points, missing values) leaves out nothing. Allocates.
inline LeaveOut leave_out(const Campaign& campaign, const CampaignFindings& findings,
                          const LeaveOutLimits& limits = {}) {
  using What = LeaveOut::What;
  using detail::Unfit;
  struct Fault {
    std::size_t batch;
    const Finding* finding;
    Unfit unfit;
    Index first, last;
  };
  std::vector<Fault> faults;
  std::vector<std::vector<std::string>> faulty_temperatures(campaign.size()), faulty_errors(campaign.size());
  std::vector<bool> out(campaign.size(), false);
  const auto note = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (std::size_t b = 0; b < campaign.size() && b < findings.size(); ++b) {
    const Batch& batch = campaign[b];
    const auto share = [&](Index rows) { return static_cast<double>(rows) > limits.rows_share * double(batch.rows()); };
    std::vector<std::pair<std::string, Index>> bad_rows;  // of each channel, together
    for (const Finding& one : findings[b]) {
      Fault fault{b, &one, detail::unfit(one.rule), one.first_row, one.last_row};
      if (fault.unfit == Unfit::nothing) continue;
      if (fault.unfit == Unfit::after) {  // the shorter side
        const bool later = batch.rows() - one.last_row <= one.first_row + 1;
        fault = {b, &one, Unfit::rows, later ? one.last_row : 0, later ? batch.rows() - 1 : one.first_row};
      }
      if (fault.unfit == Unfit::rows) {
        auto at =
            std::find_if(bad_rows.begin(), bad_rows.end(), [&](const auto& of) { return of.first == one.channel; });
        if (at == bad_rows.end()) at = bad_rows.insert(at, {one.channel, 0});
        at->second += fault.last - fault.first + 1;
      }
      faults.push_back(fault);
    }
    for (Fault& fault : faults) {
      if (fault.batch != b || fault.unfit == Unfit::batch) continue;
      for (const auto& [name, rows] : bad_rows)
        if (name == fault.finding->channel && share(rows)) fault.unfit = Unfit::channel;
      if (fault.unfit != Unfit::channel) continue;
      const std::string& name = fault.finding->channel;
      note(batch.errors.find(name) >= 0 ? faulty_errors[b] : faulty_temperatures[b], name);
    }
    out[b] = static_cast<double>(faulty_temperatures[b].size()) >
             limits.points_share * static_cast<double>(batch.temperatures.count());
    for (const Fault& fault : faults) out[b] = out[b] || (fault.batch == b && fault.unfit == Unfit::batch);
  }
  if (!campaign.empty())
    detail::fewest_readings(faulty_temperatures, static_cast<std::size_t>(campaign.front().temperatures.count()), out);

  LeaveOut result;
  result.rows.resize(campaign.size());
  for (std::size_t b = 0; b < campaign.size(); ++b)  // an error at fault wherever it is measured is left out itself
    for (const std::string& name : faulty_errors[b]) {
      bool everywhere = true;
      for (std::size_t o = 0; o < campaign.size(); ++o)
        everywhere = everywhere && (out[o] || std::find(faulty_errors[o].begin(), faulty_errors[o].end(), name) !=
                                                  faulty_errors[o].end());
      if (everywhere && campaign[b].errors.count() > 1) note(result.errors, name);
    }
  for (std::size_t b = 0; b < campaign.size(); ++b)
    for (const std::string& name : faulty_errors[b])
      out[b] = out[b] || std::find(result.errors.begin(), result.errors.end(), name) == result.errors.end();
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    if (out[b])
      result.batches.push_back(b);
    else
      for (const std::string& name : faulty_temperatures[b]) note(result.temperatures, name);
  }
  for (const Fault& fault : faults) {
    const std::string& name = fault.finding->channel;
    const auto left = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    const What what = out[fault.batch]            ? What::batch
                      : left(result.temperatures) ? What::temperature
                      : left(result.errors)       ? What::error
                                                  : What::rows;
    result.reasons.push_back({fault.batch, what, *fault.finding});
    if (what == What::rows)
      for (Index row = fault.first; row <= fault.last; ++row) result.rows[fault.batch].push_back(row);
  }
  for (std::vector<Index>& rows : result.rows) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  }
  return result;
}

namespace detail {

inline void keep_others(Channels& channels, const std::vector<std::string>& names) {
  Index kept = 0;
  for (Index c = 0; c < channels.count(); ++c) {
    const std::string name = channels.names[static_cast<std::size_t>(c)];
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    channels.names[static_cast<std::size_t>(kept)] = name;
    channels.values.col(kept++) = channels.values.col(c);
  }
  channels.names.resize(static_cast<std::size_t>(kept));
  channels.values.conservativeResize(channels.values.rows(), kept);
}

inline void keep_firsts(Batch& batch, const std::vector<std::string>& names) {
  if (batch.first_degC.size() == 0) return;
  Index kept = 0;
  for (Index c = 0; c < batch.temperatures.count(); ++c)
    if (std::find(names.begin(), names.end(), batch.temperatures.names[static_cast<std::size_t>(c)]) == names.end())
      batch.first_degC(kept++) = batch.first_degC(c);
  batch.first_degC.conservativeResize(kept);
}

/// What a rise of `kept` counts from where the first reading of `whole` is a fault, or stands on another zero than what
/// is kept.
inline void take_back_first(Batch& kept, const Batch& whole, const Finding& fault,
                            const std::vector<Index>& left_rows) {
  const Index point = whole.temperatures.find(fault.channel);
  if (point < 0 || kept.first_degC.size() == 0) return;
  const auto is_left = [&](Index row) { return std::binary_search(left_rows.begin(), left_rows.end(), row); };
  if (fault.rule == FindingRule::jump) {
    if (is_left(fault.first_row) && !is_left(fault.last_row)) kept.first_degC(point) = std::nan("");
    return;
  }
  if (fault.first_row > 0) return;
  const Series series(whole.temperatures.values.col(point));
  const bool taken_back = fault.last_row == 0 && series.size() > 4 && series.rows[4] == 4;
  kept.first_degC(point) = taken_back ? course_taken_back(series.values) : std::nan("");
}

}  // namespace detail

/// The campaign without what `left` names; Batch::dropped_rows counts the rows that went (kept_rows). A rise whose
/// first reading is left out counts from where the readings that follow come from (course_taken_back), or from nothing
/// where more than that one is. Allocates.
inline Campaign without(Campaign campaign, const LeaveOut& left) {
  Campaign kept;
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    if (std::find(left.batches.begin(), left.batches.end(), b) != left.batches.end()) continue;
    Batch batch = std::move(campaign[b]);
    if (!left.rows[b].empty()) {
      std::vector<Index> rows;
      for (Index row = 0; row < batch.rows(); ++row)
        if (!std::binary_search(left.rows[b].begin(), left.rows[b].end(), row)) rows.push_back(row);
      const Batch whole = batch;
      batch = kept_rows(std::move(batch), rows);
      for (const LeaveOut::Reason& reason : left.reasons)
        if (reason.batch == b && reason.what == LeaveOut::What::rows)
          detail::take_back_first(batch, whole, reason.finding, left.rows[b]);
    }
    detail::keep_firsts(batch, left.temperatures);
    detail::keep_others(batch.temperatures, left.temperatures);
    detail::keep_others(batch.errors, left.errors);
    kept.push_back(std::move(batch));
  }
  return kept;
}

}  // namespace thermfit
