#pragma once

/// Numbers of single batches as JSON.

#include <vector>

#include "thermfit/calibration/fitted_batch.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit::cli {

/// One object a batch: `room` and `start` by node, each number with its standard error.
template <class Json>
Json fitted_batches_json(const std::vector<FittedBatch>& batches, const ThermalNetwork& network) {
  const auto number = [](const FittedNumber& one) {
    return Json{{"value", one.value}, {"standard_error", one.standard_error}};
  };
  Json result = Json::array();
  for (const FittedBatch& one : batches) {
    Json entry{{"batch", one.batch}};
    if (one.room) entry["room"] = {{"mean_C", number(one.room_degC)}, {"drift_K", number(one.room_drift_K)}};
    for (std::size_t i = 0; i < one.start_degC.size(); ++i)
      entry["start_C"][network.nodes[i].name] = number(one.start_degC[i]);
    result.push_back(std::move(entry));
  }
  return result;
}

}  // namespace thermfit::cli
