#pragma once

#include "support/numeric_csv.hpp"
#include "thermfit/batch/batch.hpp"

/// The campaign of data/vcenter55, read without the library's reader. One row every five minutes.
inline thermfit::Campaign vcenter55() {
  thermfit::Campaign campaign;
  for (int b = 1; b <= 12; ++b) {
    thermfit::Batch batch;
    batch.name = (b < 10 ? "K0" : "K") + std::to_string(b);
    const NumericCsv csv(std::string(THERMFIT_SOURCE_DIR) + "/data/vcenter55/" + batch.name + ".csv");
    batch.temperatures = {{"T1", "T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9", "T10"}, csv.columns("T1", "T10")};
    batch.errors = {{"Z"}, csv.columns("Z", "Z")};
    batch.time_s = thermfit::Vector::LinSpaced(batch.rows(), 0, 300. * static_cast<double>(batch.rows() - 1));
    campaign.push_back(batch);
  }
  return campaign;
}
