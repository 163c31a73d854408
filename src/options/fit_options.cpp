#include "options/fit_options.hpp"

#include <algorithm>

#include "options/campaign_options.hpp"

namespace thermfit::cli {

std::vector<Option> fit_option_table() {
  return {
      {"--components", "N",
       "latent variables of PLS and PCR: a number, 'paper' (until 90 % is explained or the gain is below 5 %; the "
       "default), or 'held-out' (least error on batches left out)",
       0, false},
      {"--ridge-lambda", "L",
       "ridge penalty on correlations (default: chosen by leaving batches out; within one batch Hoerl, Kennard and "
       "Baldwin's)",
       0, false},
      {"--scaling", "S", "'both' (default), 'temperatures' or 'centre': what is scaled to unit deviation", 0, false}};
}

FitOptions fit_options(const Arguments& arguments) {
  FitOptions options;
  const std::string components = arguments.value_or("--components", "paper");
  if (components == "held-out")
    options.components = ComponentRule::leave_one_batch_out();
  else if (components != "paper")
    options.components = ComponentRule::fixed(*arguments.integer("--components", 1, 10000));
  options.ridge_lambda = arguments.number("--ridge-lambda", 0, 1e12);
  const std::string scaling = arguments.choice("--scaling", {"both", "temperatures", "centre"}, "both");
  options.scaling = scaling == "both"           ? Scaling::both
                    : scaling == "temperatures" ? Scaling::temperatures
                                                : Scaling::centre;
  return options;
}

Option output_option(const std::string& what) {
  return {"--output", "FILE", what + " goes to FILE, whole or not at all", 'o', false};
}

void append(std::vector<Option>& options, const std::vector<Option>& more) {
  options.insert(options.end(), more.begin(), more.end());
}

Index require_points(const Arguments& arguments, const Campaign& campaign, Index fallback) {
  require_errors(campaign);
  const Index all = campaign.front().temperatures.count();
  if (arguments.value_or("--points", "") == "all") return all;
  return arguments.integer("--points", 1, all).value_or(std::min(fallback, all));
}

}  // namespace thermfit::cli
