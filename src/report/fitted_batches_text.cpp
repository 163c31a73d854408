#include "report/fitted_batches_text.hpp"

#include <algorithm>

#include "cli/table.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

std::string with_error(const FittedNumber& one, int decimals = 2) {
  return fixed_text(one.value, decimals) + " +- " + fixed_text(one.standard_error, decimals);
}

}  // namespace

std::string fitted_batches_text(const std::vector<FittedBatch>& batches) {
  if (batches.empty()) return {};
  const bool room = batches[0].room, starts = !batches[0].start_degC.empty();
  std::vector<std::string> header{"batch"};
  if (room) header.insert(header.end(), {"room, degC", "drift, K"});
  if (starts) header.insert(header.end(), {"starts from", "to, degC", "known to, K"});
  Table table(header);
  for (const FittedBatch& one : batches) {
    std::vector<std::string> row{one.batch};
    if (room) {
      row.push_back(with_error(one.room_degC));
      row.push_back(one.room_drift_K.standard_error > 0 ? with_error(one.room_drift_K) : "-");
    }
    if (starts) {
      const auto [low, high] = std::minmax_element(one.start_degC.begin(), one.start_degC.end(),
                                                   [](const auto& a, const auto& b) { return a.value < b.value; });
      double worst = 0;
      for (const FittedNumber& node : one.start_degC) worst = std::max(worst, node.standard_error);
      row.push_back(fixed_text(low->value, 1));
      row.push_back(fixed_text(high->value, 1));
      row.push_back(fixed_text(worst, 2));
    }
    table.add(row);
  }
  return "Fitted batch by batch, since nothing else tells it (--json has every number)\n" + table.text(2);
}

}  // namespace thermfit::cli
