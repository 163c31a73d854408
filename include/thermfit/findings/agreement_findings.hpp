#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/disagreement.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/findings/sound_rows.hpp"

namespace thermfit {

namespace detail {

/// What of a residual is left where it is explained in one way.
struct Explained {
  FindingRule rule;
  double left;              ///< sum of squares
  double figure;            ///< K, or a factor
  std::size_t first, last;  ///< readings it holds for
  std::string note;
};

/// The ways in which a sensor leaves what the others say it should read: `read` and `expected` about their means.
inline std::vector<Explained> explanations_of(const std::vector<double>& read, const std::vector<double>& expected,
                                              double dead_factor) {
  const std::size_t n = read.size();
  std::vector<double> residual(n);
  double rr = 0, ee = 0, re = 0, sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    residual[i] = read[i] - expected[i];
    rr += read[i] * read[i];
    ee += expected[i] * expected[i];
    re += read[i] * expected[i];
    sum += residual[i];
  }
  double all = 0;
  for (const double r : residual) all += r * r;
  std::vector<Explained> ways;
  if (ee > 0) {
    const double factor = re / ee;
    const bool dead = rr * dead_factor * dead_factor < ee;
    ways.push_back({dead ? FindingRule::dead : FindingRule::gain,
                    dead ? std::min(rr, rr - factor * re) : rr - factor * re, factor, 0, n - 1, ""});
  }
  // A step after each reading, and a ramp from each reading on (of those that a tenth of the batch sets apart).
  double before = 0;
  Explained jump{FindingRule::jump, all, 0, 0, n - 1, ""};
  for (std::size_t i = 0; i + 1 < n; ++i) {
    before += residual[i];
    const double a = static_cast<double>(i + 1), b = static_cast<double>(n - i - 1);
    const double size = (sum - before) / b - before / a,
                 left = all - sum * sum / double(n) - size * size * a * b / double(n);
    if (left < jump.left) jump = {FindingRule::jump, left, size, i, i + 1, ""};
  }
  ways.push_back(jump);
  Explained drift{FindingRule::drift, all, 0, 0, n - 1, ""};
  const std::size_t stride = std::max<std::size_t>(1, n / 10);
  for (std::size_t from = 0; from + n / 4 < n; from += stride) {
    double s = 0, ss = 0, sr = 0;
    for (std::size_t i = from + 1; i < n; ++i) {
      const double ramp = static_cast<double>(i - from);
      s += ramp;
      ss += ramp * ramp;
      sr += ramp * residual[i];
    }
    const double spread = ss - s * s / double(n), slope = (sr - s * sum / double(n)) / spread;
    const double left = all - sum * sum / double(n) - slope * slope * spread;
    if (left < drift.left) drift = {FindingRule::drift, left, slope * double(n - 1 - from), from, n - 1, ""};
  }
  ways.push_back(drift);
  return ways;
}

}  // namespace detail

/// Temperatures that do not agree with the others of their batch as the other batches say, by disagreements(), with the
/// way in which: a jump, a drift, another gain, no response, another sensor's reading; `disagrees` where none of them
/// explains three quarters of it. One list a batch is added to. Only what moves within a batch counts, so that another
/// season is no fault. `findings` are those that are known: rows and channels with them do not count. Allocates.
template <typename Scalar = double>
void add_agreement_findings(const Campaign& campaign, std::vector<std::vector<Finding>>& findings,
                            const AgreementLimits& limits = {}) {
  if (campaign.size() < limits.fewest_batches) return;
  const Index channels = campaign[0].temperatures.count();
  for (const Batch& batch : campaign)
    if (batch.temperatures.names != campaign[0].temperatures.names) return;
  std::vector<CentredProducts<Scalar>> products;
  std::vector<std::vector<Index>> known(campaign.size()), rows_that_count(campaign.size());
  std::vector<std::vector<double>> shakes(static_cast<std::size_t>(channels));
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    const Batch& batch = campaign[b];
    const std::vector<bool> counts = detail::sound_rows(batch, findings[b], false);
    for (const Finding& one : findings[b]) {
      const Index c = batch.temperatures.find(one.channel);
      if (c < 0) continue;
      const bool whole =
          one.rule == FindingRule::constant || one.rule == FindingRule::stuck || one.rule == FindingRule::unit;
      if (whole && std::find(known[b].begin(), known[b].end(), c) == known[b].end()) known[b].push_back(c);
    }
    const MatrixX<Scalar>& values = batch.temperatures.values;
    for (Index row = 0; row < batch.rows(); ++row)
      if (counts[static_cast<std::size_t>(row)] && values.row(row).allFinite()) rows_that_count[b].push_back(row);
    const auto count = static_cast<Index>(rows_that_count[b].size());
    MatrixX<Scalar> used(count, channels);
    for (Index i = 0; i < count; ++i) used.row(i) = values.row(rows_that_count[b][static_cast<std::size_t>(i)]);
    if (count > 0) used.rowwise() -= used.colwise().mean().eval();
    products.push_back({used.transpose() * used, static_cast<Scalar>(count)});
    for (Index c = 0; c < channels; ++c)
      shakes[static_cast<std::size_t>(c)].push_back(series_scale(Series(batch.temperatures.values.col(c))).shake());
  }
  VectorX<Scalar> floor(channels);
  for (Index c = 0; c < channels; ++c) floor(c) = std::max(1e-9, median(shakes[static_cast<std::size_t>(c)]));
  // A sensor that does not respond needs no regression: it stands still where it usually moves as the others do.
  const MatrixX<Scalar> movement = missing_movement<Scalar>(products, floor);
  std::vector<double> sizes;
  for (Index b = 0; b < movement.rows(); ++b)
    for (Index c = 0; c < channels; ++c) sizes.push_back(std::abs(static_cast<double>(movement(b, c))));
  const double still = std::max(detail::scatter_limit(std::move(sizes), limits), std::log(limits.dead_factor));
  for (std::size_t b = 0; b < campaign.size(); ++b)
    for (Index c = 0; c < channels; ++c) {
      const double missing = movement(static_cast<Index>(b), c);
      if (missing <= still || rows_that_count[b].size() <= static_cast<std::size_t>(channels) ||
          std::find(known[b].begin(), known[b].end(), c) != known[b].end())
        continue;
      known[b].push_back(c);
      findings[b].push_back({FindingRule::dead, campaign[b].temperatures.names[static_cast<std::size_t>(c)],
                             rows_that_count[b].front(), rows_that_count[b].back(), std::exp(missing), std::exp(still),
                             "times",
                             "stands still where it usually moves as the others do: not connected, fallen off?"});
    }
  const std::vector<Disagreement<Scalar>> found = disagreements<Scalar>(products, known, floor, limits);
  for (const Disagreement<Scalar>& one : found) {
    const bool told = std::any_of(findings[one.batch].begin(), findings[one.batch].end(), [&](const Finding& before) {
      return before.rule == FindingRule::jump &&
             before.channel == campaign[0].temperatures.names[static_cast<std::size_t>(one.channel)];
    });
    if (told) continue;  // as a jump, with its rows
    const std::vector<Index>& rows = rows_that_count[one.batch];
    const MatrixX<Scalar>& values = campaign[one.batch].temperatures.values;
    const auto centred = [&](Index c) {
      std::vector<double> column;
      double mean = 0;
      for (const Index row : rows) column.push_back(values(row, c));
      for (const double value : column) mean += value / static_cast<double>(column.size());
      for (double& value : column) value -= mean;
      return column;
    };
    const std::vector<double> read = centred(one.channel);
    std::vector<double> expected = read;
    for (std::size_t k = 0; k < one.kept.size(); ++k) {
      const std::vector<double> column = centred(one.kept[k]);
      const double weight = one.weights(static_cast<Index>(k));
      for (std::size_t i = 0; i < expected.size(); ++i) expected[i] -= weight * column[i];
    }
    double all = 0;
    for (std::size_t i = 0; i < read.size(); ++i) all += std::pow(read[i] - expected[i], 2);
    std::vector<detail::Explained> ways = detail::explanations_of(read, expected, limits.dead_factor);
    for (Index other = 0; other < channels; ++other) {
      if (other == one.channel) continue;
      const std::vector<double> column = centred(other);
      double own = 0;
      for (std::size_t i = 0; i < read.size(); ++i) own += std::pow(column[i] - expected[i], 2);
      const bool faulty_too = std::any_of(found.begin(), found.end(), [&](const auto& also) {
        return also.batch == one.batch && also.channel == other;
      });
      if (!faulty_too) continue;  // a neighbour reads about the same at any time
      ways.push_back(
          {FindingRule::swapped, own, 0, 0, read.size() - 1,
           "what it should read is in " + campaign[0].temperatures.names[std::size_t(other)] + ": sensors swapped?"});
    }
    // That another faulty sensor reads what this one should is no accident: it comes before what explains more.
    const double enough = all / 4;
    const auto best = std::min_element(ways.begin(), ways.end(), [&](const auto& x, const auto& y) {
      const auto rank = [&](const detail::Explained& way) {
        return std::make_pair(way.rule != FindingRule::swapped || way.left >= enough, way.left);
      };
      return rank(x) < rank(y);
    });
    const std::string& name = campaign[0].temperatures.names[static_cast<std::size_t>(one.channel)];
    Finding finding{FindingRule::disagrees,
                    name,
                    rows.front(),
                    rows.back(),
                    one.rms,
                    one.limit,
                    "K",
                    "does not go with the other sensors as in the other batches"};
    if (best->left < enough) {
      finding.rule = best->rule;
      finding.first_row = rows[best->first];
      finding.last_row = rows[best->last];
      const auto percent = std::to_string(std::lround(100 * best->figure));
      switch (best->rule) {
        case FindingRule::jump:
          finding.figure = std::abs(best->figure);
          finding.note = "a step that stays and that the other sensors do not show: contact, sensor moved?";
          break;
        case FindingRule::drift:
          finding.figure = std::abs(best->figure);
          finding.note = "drifts away from what the other sensors say";
          break;
        case FindingRule::gain:
          finding.note = "moves by " + percent + " % of what the other sensors say: " +
                         (std::abs(best->figure - 1.8) < 0.1 ? "degrees Fahrenheit?" : "contact, another place?");
          break;
        case FindingRule::dead:
          finding.note = "does not respond, though by the other sensors it should: not connected, fallen off?";
          break;
        default:
          finding.note = best->note;
      }
    }
    findings[one.batch].push_back(std::move(finding));
  }
}

}  // namespace thermfit
