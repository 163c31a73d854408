#include "options/transfer_options.hpp"

#include <algorithm>
#include <limits>

#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

/// Whether --features names `block`; without the option all of them.
bool wanted(const std::vector<std::string>& blocks, const std::string& block) {
  return blocks.empty() || std::find(blocks.begin(), blocks.end(), block) != blocks.end();
}

}  // namespace

std::vector<Option> transfer_option_table() {
  return {
      {"--features", "LIST", "what transfer is made of: rise, lag, climate (default: of these, what pays)", 0, true},
      {"--lag", "MIN", "lags that transfer chooses from, in minutes (default: those the batches can tell)", 0, true}};
}

TransferPlan transfer_plan(const Arguments& arguments, ErrorReference reference) {
  TransferPlan plan;
  plan.error_reference = reference;
  const std::vector<std::string> blocks = arguments.list("--features");
  for (const std::string& block : blocks)
    if (block != "rise" && block != "lag" && block != "climate")
      throw UsageError("--features is '" + block + "'; allowed: rise, lag, climate");
  constexpr double none = std::numeric_limits<double>::infinity();
  if (!wanted(blocks, "rise")) plan.options.rise_penalty = none;
  if (!wanted(blocks, "lag")) plan.options.lag_penalty = none;
  if (!wanted(blocks, "climate")) plan.options.climate_penalty = none;
  if (arguments.has("--lag")) {
    plan.lags_min.emplace();
    for (const std::string& text : arguments.list("--lag")) {
      const std::optional<double> lag = parse_number(text);
      if (!lag || !(*lag > 0) || *lag > 1e6)
        throw UsageError("--lag is '" + text + "'; allowed: minutes above 0, at most 1e6");
      plan.lags_min->push_back(*lag);
    }
  }
  if (arguments.has("--scaling")) {
    const std::string scaling = arguments.choice("--scaling", {"both", "temperatures", "centre"}, "both");
    plan.options.scale = scaling == "centre" ? PenaltyScale::block : PenaltyScale::column;
  }
  return plan;
}

void note_lacking_blocks(const Campaign& campaign, const TransferPlan& plan, const Console& console) {
  const auto clockless = std::find_if(campaign.begin(), campaign.end(), [](const Batch& b) { return !b.has_time(); });
  if (!plan.options.lag_penalty && clockless != campaign.end()) {
    console.note(clockless->source +
                 ": no clock, so that transfer has no lagged rises; name one: --time-column NAME "
                 "--time-unit UNIT");
  } else if (!plan.options.lag_penalty && !plan.lags_min && visible_lags_min(campaign).empty()) {
    console.note(
        "batches are too short for transfer to have lagged rises: a lag is at least four sampling intervals "
        "and at most a third of a batch (--lag gives others)");
  }
  if (plan.options.climate_penalty) return;
  std::vector<Index> points = plan.points;
  for (Index p = 0; plan.points.empty() && p < campaign.front().temperatures.count(); ++p) points.push_back(p);
  double lowest = climate_degC(campaign.front(), points), highest = lowest;
  for (const Batch& batch : campaign) {
    lowest = std::min(lowest, climate_degC(batch, points));
    highest = std::max(highest, climate_degC(batch, points));
  }
  if (highest - lowest < plan.options.least_climate_range_K)
    console.note("all batches start within " + fixed_text(highest - lowest, 2) +
                 " K of each other: transfer knows nothing of other climates");
}

}  // namespace thermfit::cli
