#pragma once

/// Findings of a campaign for a reader with a minute: one entry a kind and channel, worst first.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/findings/campaign_findings.hpp"
#include "thermfit/findings/unfit.hpp"

namespace thermfit {

/// All findings of one rule about channels of one name.
struct FindingGroup {
  /// A finding, and the index in the campaign of the batch it is in.
  struct Place {
    std::size_t batch;       ///< index in the campaign
    const Finding* finding;  ///< in the list that was grouped, which must live as long
  };
  FindingRule rule;           ///< that is broken
  std::string channel;        ///< where
  std::vector<Place> places;  ///< worst first
  std::size_t batches = 0;    ///< it was found in

  /// The worst of them. Does not allocate.
  const Place& worst() const { return places.front(); }
};

namespace detail {

/// How far beyond its limit a finding is; what has no figure is not far.
inline double excess(const Finding& one) {
  const double ratio = std::abs(one.figure / one.limit);
  return std::isfinite(ratio) ? ratio : 0;
}

/// What a rule costs whoever does not know, most first: the batch, the channel, readings, nothing yet. Numbers that no
/// machine can have come before other readings, and where an error stands is as good as its channel.
inline int gravity(FindingRule rule) {
  if (rule == FindingRule::level) return 1;
  switch (unfit(rule)) {
    case Unfit::batch:
      return 0;
    case Unfit::channel:
      return 1;
    case Unfit::rows:
    case Unfit::after:
      return rule == FindingRule::impossible ? 2 : 3;
    case Unfit::nothing:
      break;
  }
  return 4;
}

}  // namespace detail

/// `findings` by rule and channel: what spoils batches first, then channels, then readings, each by how far it is
/// beyond its limit. Allocates.
inline std::vector<FindingGroup> grouped(const CampaignFindings& findings) {
  std::vector<FindingGroup> groups;
  for (std::size_t b = 0; b < findings.size(); ++b)
    for (const Finding& one : findings[b]) {
      auto group = std::find_if(groups.begin(), groups.end(), [&](const FindingGroup& known) {
        return known.rule == one.rule && known.channel == one.channel;
      });
      if (group == groups.end()) group = groups.insert(groups.end(), {one.rule, one.channel, {}, 0});
      group->batches += group->places.empty() || group->places.back().batch != b;
      group->places.push_back({b, &one});
    }
  for (FindingGroup& group : groups)
    std::stable_sort(group.places.begin(), group.places.end(), [](const auto& a, const auto& b) {
      return detail::excess(*a.finding) > detail::excess(*b.finding);
    });
  std::stable_sort(groups.begin(), groups.end(), [](const FindingGroup& a, const FindingGroup& b) {
    const int ga = detail::gravity(a.rule), gb = detail::gravity(b.rule);
    return ga != gb ? ga < gb : detail::excess(*a.worst().finding) > detail::excess(*b.worst().finding);
  });
  return groups;
}

}  // namespace thermfit
