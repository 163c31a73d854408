#include "options/transfer_options.hpp"

#include <algorithm>
#include <limits>

#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Both sides of `T3-T5` or `T3 - T5`, where both are temperatures; names may hold a '-' themselves.
std::optional<std::pair<std::string, std::string>> difference(const std::string& text,
                                                              const std::vector<std::string>& temperatures) {
  const auto trimmed = [](std::string side) {
    side.erase(0, side.find_first_not_of(' '));
    return side.erase(side.find_last_not_of(' ') + 1);
  };
  for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at + 1)) {
    const std::pair<std::string, std::string> sides{trimmed(text.substr(0, at)), trimmed(text.substr(at + 1))};
    if (sides.first != sides.second && holds(temperatures, sides.first) && holds(temperatures, sides.second))
      return sides;
  }
  return std::nullopt;
}

/// What --features lists, into the plan: of the blocks those that are named, all where none is; and what is named
/// beside.
void take_features(const std::vector<std::string>& listed, const Campaign& campaign, TransferPlan& plan) {
  const Channels &inputs = campaign.front().inputs, &temperatures = campaign.front().temperatures;
  std::vector<std::string> blocks;
  for (const std::string& one : listed) {
    if (one == "rise" || one == "lag" || one == "climate") {
      blocks.push_back(one);
    } else if (one == "input") {
      if (inputs.count() == 0)
        throw UsageError(
            "--features names 'input', but the batches have no known input; --inputs NAMES says which are");
      for (const std::string& name : inputs.names)
        if (!holds(plan.inputs, name)) plan.inputs.push_back(name);
    } else if (inputs.find(one) >= 0) {
      if (!holds(plan.inputs, one)) plan.inputs.push_back(one);
    } else if (const auto sides = difference(one, temperatures.names)) {
      if (std::find(plan.differences.begin(), plan.differences.end(), *sides) == plan.differences.end())
        plan.differences.push_back(*sides);
    } else {
      throw UsageError("--features is '" + one + "'; allowed: rise, lag, climate, input, " +
                       (inputs.count() > 0 ? "known inputs (" + name_list(inputs.names, 12) + "), " : "") +
                       "differences of temperatures (T3-T5)");
    }
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  if (blocks.empty()) return;
  if (!holds(blocks, "rise")) plan.options.rise_penalty = none;
  if (!holds(blocks, "lag")) plan.options.lag_penalty = none;
  if (!holds(blocks, "climate")) plan.options.climate_penalty = none;
}

}  // namespace

std::vector<Option> transfer_option_table() {
  return {
      {"--features", "LIST",
       "what transfer is made of: rise, lag, climate (default: of these, what pays); beside them known inputs by name, "
       "or 'input' for all, and differences such as T3-T5",
       0, true},
      {"--lag", "MIN", "lags that transfer chooses from, in minutes (default: those the batches can tell)", 0, true}};
}

TransferPlan transfer_plan(const Arguments& arguments, const Campaign& campaign, ErrorReference reference) {
  TransferPlan plan;
  plan.error_reference = reference;
  take_features(arguments.list("--features"), campaign, plan);
  if (arguments.has("--lag")) {
    plan.lags_min.emplace();
    for (const std::string& text : arguments.list("--lag")) {
      const std::optional<double> lag = parse_number(text);
      if (!lag || !(*lag > 0) || *lag > 1e6)
        throw UsageError("--lag is '" + text + "'; allowed: minutes above 0, at most 1e6");
      plan.lags_min->push_back(*lag);
    }
    std::sort(plan.lags_min->begin(), plan.lags_min->end());
  }
  if (arguments.has("--scaling")) {
    const std::string scaling = arguments.choice("--scaling", {"both", "temperatures", "centre"}, "both");
    plan.options.scale = scaling == "centre" ? PenaltyScale::block : PenaltyScale::column;
  }
  return plan;
}

void note_lacking_blocks(const Arguments& arguments, const Campaign& campaign, const TransferPlan& plan,
                         const Console& console) {
  const std::vector<std::string> listed = arguments.list("--features");
  const auto clockless = std::find_if(campaign.begin(), campaign.end(), [](const Batch& b) { return !b.has_time(); });
  if (clockless != campaign.end() && holds(listed, "lag"))
    throw UsageError("--features names 'lag', but " + clockless->source +
                     " has no clock: --time-column NAME --time-unit UNIT, or --features without lag");
  if (!plan.options.lag_penalty && clockless != campaign.end()) {
    console.note(clockless->source + ": no clock, so that transfer has no lagged rises" +
                 (plan.inputs.empty() ? "" : " or inputs") + "; name one: --time-column NAME --time-unit UNIT");
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
