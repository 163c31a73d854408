#pragma once

/// What is suspicious about the batches of a campaign: each by itself, and beside the others.

#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/agreement_findings.hpp"
#include "thermfit/findings/copy_findings.hpp"
#include "thermfit/findings/findings.hpp"
#include "thermfit/findings/level_findings.hpp"
#include "thermfit/findings/sign_findings.hpp"

namespace thermfit {

/// One list of findings a batch, in the order of a campaign.
using CampaignFindings = std::vector<std::vector<Finding>>;

/// Everything suspicious about each batch, by find_faults(Batch), and about each beside the others: batches that hold
/// the numbers of an earlier one or have another time step, errors of opposite sign or that start further apart than
/// they move, temperatures that do not agree with the others as elsewhere. Allocates.
template <typename Scalar = double>
CampaignFindings find_faults(const Campaign& campaign, const FindingLimits& limits = {},
                             const AgreementLimits& agreement = {}) {
  CampaignFindings findings;
  for (const Batch& batch : campaign) findings.push_back(find_faults<Scalar>(batch, limits));
  compare_units(campaign, findings, limits.units);
  std::vector<double> steps;
  for (const Batch& batch : campaign)
    if (batch.has_time()) steps.push_back(usual_step_s(batch));
  for (std::size_t b = 0; b < campaign.size(); ++b)
    if (campaign[b].has_time())
      if (auto step = step_finding(usual_step_s(campaign[b]), steps, limits.clock))
        findings[b].push_back(std::move(*step));
  add_sign_findings<Scalar>(campaign, findings);
  add_agreement_findings<Scalar>(campaign, findings, agreement);
  for (std::size_t b = 0; b < campaign.size(); ++b)
    if (auto copy = copy_finding(campaign, b)) findings[b].push_back(std::move(*copy));
  for (const std::string& name : campaign.empty() ? std::vector<std::string>() : campaign.front().errors.names)
    if (auto level = level_finding(campaign, name, limits.judged_rows))
      findings[level->batch].push_back(std::move(level->finding));
  return findings;
}

}  // namespace thermfit
