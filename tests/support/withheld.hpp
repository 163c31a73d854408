#pragma once

#include <string>

#include "thermfit/io/csv/reader.hpp"

/// The measured ("real") or simulated ("sim") batches of a case of data/withheld, which is part of the project.
inline thermfit::Campaign withheld_campaign(const std::string& name, const std::string& side) {
  std::vector<std::string> paths;
  for (int k = 1; k <= 9; ++k)
    paths.push_back(std::string(THERMFIT_SOURCE_DIR) + "/data/withheld/" + name + '/' + side + "/K0" +
                    std::to_string(k) + ".csv");
  return thermfit::read_campaign(paths).batches;
}
