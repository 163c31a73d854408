#pragma once

/// What is suspicious about the batches of a campaign: each by itself, and beside the others.

#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/copy_findings.hpp"
#include "thermfit/findings/findings.hpp"
#include "thermfit/findings/level_findings.hpp"

namespace thermfit {

/// One list of findings a batch, in the order of a campaign.
using CampaignFindings = std::vector<std::vector<Finding>>;

/// Everything suspicious about each batch, by find_faults(Batch), and about each beside the others: batches that hold
/// the numbers of an earlier one; thermal errors that start further apart than they move. Allocates.
template <typename Scalar = double>
CampaignFindings find_faults(const Campaign& campaign, const FindingLimits& limits = {}) {
  CampaignFindings findings;
  for (const Batch& batch : campaign) findings.push_back(find_faults<Scalar>(batch, limits));
  for (std::size_t b = 0; b < campaign.size(); ++b)
    if (auto copy = copy_finding(campaign, b)) findings[b].push_back(std::move(*copy));
  for (const std::string& name : campaign.empty() ? std::vector<std::string>() : campaign.front().errors.names)
    if (auto level = level_finding(campaign, name, limits.judged_rows))
      findings[level->batch].push_back(std::move(level->finding));
  return findings;
}

}  // namespace thermfit
