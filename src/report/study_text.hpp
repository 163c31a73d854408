#pragma once

/// A study in tables.

#include <optional>
#include <string>
#include <vector>

#include "cli/console.hpp"
#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/campaign_card.hpp"
#include "thermfit/batch/error_reference.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/robustness/study.hpp"
#include "thermfit/robustness/transfer_left_out.hpp"

namespace thermfit::cli {

/// A study together with what its tables name.
struct StudyReport {
  Study<> study;
  std::optional<TransferLeftOut<>> transfer;  ///< every batch predicted by the method transfer from the others
  std::vector<double> transfer_lags_min;      ///< it chose from
  std::string transfer_refusal;               ///< why there is none
  TemperatureReference reference = TemperatureReference::rise;
  ErrorReference error_reference = ErrorReference::recorded;
  std::vector<std::string> temperatures, errors, batches;
  std::vector<Index> rows;           ///< per batch
  std::optional<CampaignCard> card;  ///< what the data's folder says of itself
  std::string card_path;
};

void print_study(const StudyReport& report, Console& console);

/// "PLS on correlation", "MLR on FCGR".
std::string method_title(const StudiedMethod<>& method);

}  // namespace thermfit::cli
