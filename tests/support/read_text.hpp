#pragma once

#include <string>

#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/reader.hpp"

/// A file a.csv that holds `text`, read as a campaign.
inline thermfit::CsvReading read_text(const std::string& text, const thermfit::CsvOptions& options = {}) {
  const ScratchFolder folder;
  return thermfit::read_campaign({folder.write("a.csv", text)}, options);
}
