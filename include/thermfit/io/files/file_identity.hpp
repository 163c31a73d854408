#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>
#include <utility>

namespace thermfit {

/// The file that a path leads to, the same for all its names and links; none for what is no plain file or is not there.
inline std::optional<std::pair<dev_t, ino_t>> file_identity(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return std::make_pair(status.st_dev, status.st_ino);
}

}  // namespace thermfit
