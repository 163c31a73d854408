#pragma once

/// The figures of a scored set and the table that shows them.

#include <map>
#include <numeric>

#include "cli/table.hpp"
#include "mark.hpp"
#include "thermfit/number.hpp"

namespace blind {

/// `right` of `of`.
struct Share {
  int right = 0, of = 0;
  void add(bool is_right) { right += is_right, ++of; }
  double value() const { return of ? static_cast<double>(right) / of : NAN; }
  std::string text() const { return of ? std::to_string(right) + "/" + std::to_string(of) : "-"; }
};

inline double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : .5 * (values[half - 1] + values[half]);
}

/// Mean over five equal bins of |mean confidence - share right|, weighted by the claims in each.
inline double calibration_error(const std::vector<Claim>& claims) {
  double error = 0;
  for (int bin = 0; bin < 5; ++bin) {
    double confidence = 0, right = 0;
    for (const Claim& claim : claims) {
      if (std::min(4, static_cast<int>(claim.confidence * 5)) != bin) continue;
      confidence += claim.confidence;
      right += claim.right;
    }
    error += std::abs(confidence - right) / static_cast<double>(claims.size());
  }
  return claims.empty() ? NAN : error;
}

struct Summary {
  Share top, in_set, within, place, pair_top, unknown, none_right, miscalibration_right, hidden_honest;
  Share false_alarm_none, false_alarm_miscalibration, coverage, confident_wrong, harm;
  std::vector<double> against_oracle, shrinks, seconds;
  std::vector<Claim> claims, suspicions;
  int failed = 0;
  std::map<std::string, std::array<Share, 5>> by_family;  ///< detectable, top, set, place, verdict

  void add(const Truth& truth, const Mark& mark) {
    if (mark.failed) ++failed;
    auto& [seen, first, set, at, verdict] = by_family[truth.effects.size() > 1 ? "pairs" : truth.family];
    seen.add(truth.detectable);
    verdict.add(mark.verdict_right);
    if (std::isfinite(mark.seconds)) seconds.push_back(mark.seconds);
    confident_wrong.add(mark.confident_wrong);
    claims.insert(claims.end(), mark.claims.begin(), mark.claims.end());
    suspicions.insert(suspicions.end(), mark.suspicions.begin(), mark.suspicions.end());
    if (truth.verdict == "none") {
      none_right.add(mark.verdict_right);
      false_alarm_none.add(mark.failed || mark.named || mark.verdict == "unknown");
    } else if (truth.verdict == "miscalibration") {
      miscalibration_right.add(mark.verdict_right);
      false_alarm_miscalibration.add(mark.failed || mark.named || mark.verdict == "unknown");
    } else if (!truth.detectable) {
      hidden_honest.add(!mark.failed && !mark.confident_wrong);
    } else if (truth.verdict == "unknown") {
      unknown.add(mark.verdict_right);
    } else if (truth.poor) {
      // One speed: naming the group that holds the truth is all that can be asked.
      hidden_honest.add(!mark.failed && !mark.confident_wrong);
      in_set.add(mark.in_set);
    } else {
      (truth.effects.size() > 1 ? pair_top : top).add(mark.top);
      in_set.add(mark.in_set);
      within.add(mark.within);
      if (mark.in_set) place.add(mark.place);
      first.add(mark.top);
      set.add(mark.in_set);
      at.add(mark.place);
    }
    if (mark.named && truth.verdict == "effect") {
      if (std::isfinite(mark.shrink_percent)) shrinks.push_back(mark.shrink_percent);
      if (std::isfinite(mark.calibrated)) harm.add(mark.with_effect > mark.calibrated);
      if (mark.oracle_shrink_percent > 5)
        against_oracle.push_back(std::max(0., mark.shrink_percent) / mark.oracle_shrink_percent);
      if (mark.interval && mark.fresh)
        coverage.add(agree({mark.shrink_percent, {mark.interval->first, mark.interval->second}}, *mark.fresh));
    } else if (truth.verdict == "effect" && truth.detectable && mark.oracle_shrink_percent > 5) {
      against_oracle.push_back(0);
    }
  }

  /// Figures by name, for thresholds and for a file.
  std::map<std::string, double> figures() const {
    return {{"top1", top.value()},
            {"in_set", in_set.value()},
            {"within", within.value()},
            {"place", place.value()},
            {"pairs_top", pair_top.value()},
            {"unknown", unknown.value()},
            {"none_right", none_right.value()},
            {"miscalibration_right", miscalibration_right.value()},
            {"false_alarm_none", false_alarm_none.value()},
            {"false_alarm_miscalibration", false_alarm_miscalibration.value()},
            {"hidden_honest", hidden_honest.value()},
            {"confident_wrong", confident_wrong.value()},
            {"harm", harm.value()},
            {"shrink_median_percent", median(shrinks)},
            {"shrink_of_oracle", median(against_oracle)},
            {"interval_coverage", coverage.value()},
            {"calibration_error", calibration_error(claims)},
            {"suspicions", static_cast<double>(suspicions.size())},
            {"suspicion_calibration_error", calibration_error(suspicions)},
            {"seconds_median", median(seconds)},
            {"seconds_longest", seconds.empty() ? NAN : *std::max_element(seconds.begin(), seconds.end())},
            {"failed", static_cast<double>(failed)}};
  }
};

/// How the cases of each effect went.
inline std::string families_text(const Summary& summary) {
  thermfit::cli::Table families({"effect", "cases", "detectable", "first", "in set", "place", "verdict"});
  for (const auto& [name, shares] : summary.by_family) {
    const auto& [seen, first, set, at, verdict] = shares;
    families.add({name, std::to_string(seen.of), std::to_string(seen.right), first.text(), set.text(), at.text(),
                  verdict.text()});
  }
  return families.text();
}

/// Over all cases, a column each way of diagnosing them.
inline std::string totals_text(const std::vector<std::pair<std::string, const Summary*>>& ways) {
  std::vector<std::string> heads{"over all"};
  for (const auto& way : ways) heads.push_back(way.first);
  thermfit::cli::Table totals(heads);
  const auto row = [&](const std::string& name, const auto& cell) {
    std::vector<std::string> cells{name};
    for (const auto& way : ways) cells.push_back(cell(*way.second));
    totals.add(cells);
  };
  const auto share = [&](const std::string& name, Share Summary::*member) {
    row(name, [&](const Summary& summary) {
      const Share& one = summary.*member;
      return one.of ? one.text() + "  " + thermfit::fixed_text(100 * one.value(), 1) + " %" : std::string("-");
    });
  };
  const auto number = [&](const std::string& name, const char* figure, int decimals, const char* unit = "",
                          double scale = 1) {
    row(name, [&](const Summary& summary) {
      const double value = summary.figures().at(figure);
      return std::isfinite(value) ? thermfit::fixed_text(scale * value, decimals) + unit : std::string("-");
    });
  };
  share("single effect first (detectable)", &Summary::top);
  share("both of a pair found", &Summary::pair_top);
  share("truth within what is named", &Summary::in_set);
  share("truth within names, parts and suspicions", &Summary::within);
  share("place right, of those named", &Summary::place);
  share("false alarms on none", &Summary::false_alarm_none);
  share("false alarms on miscalibration", &Summary::false_alarm_miscalibration);
  share("verdict none right", &Summary::none_right);
  share("verdict miscalibration right", &Summary::miscalibration_right);
  share("unknown recognised", &Summary::unknown);
  share("hidden or one-speed: no confident wrong name", &Summary::hidden_honest);
  share("a wrong name stated above 50 %", &Summary::confident_wrong);
  share("worse with the effect than without", &Summary::harm);
  number("median shrink", "shrink_median_percent", 1, " %");
  number("median shrink, of the oracle's", "shrink_of_oracle", 1, " %", 100);
  share("interval agrees with the shrink on fresh batches", &Summary::coverage);
  number("calibration error of the confidence", "calibration_error", 3);
  number("parts and suspicions told", "suspicions", 0);
  number("calibration error of their probability", "suspicion_calibration_error", 3);
  number("time, median, s", "seconds_median", 2);
  number("time, longest, s", "seconds_longest", 2);
  number("no answer", "failed", 0);
  return totals.text();
}

}  // namespace blind
