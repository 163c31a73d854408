#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/catch.hpp"

/// The folder of reference and measured data that are checked against but not part of the project: THERMFIT_SHARED, or
/// `../shared` beside the source tree. Empty where it is absent.
inline std::string shared_folder() {
  const char* given = std::getenv("THERMFIT_SHARED");
  const std::filesystem::path folder = given ? given : std::filesystem::path(THERMFIT_SOURCE_DIR) / "../shared";
  return std::filesystem::is_directory(folder / "data") ? (folder / "data").string() : "";
}

/// Leaves the test case when the reference data are not on this machine, with the words by which tests/CMakeLists.txt
/// makes ctest count it as skipped.
#define REQUIRE_SHARED_DATA(variable)                                                 \
  const std::string variable = shared_folder();                                       \
  if (variable.empty()) {                                                             \
    WARN("skipped: set THERMFIT_SHARED to the folder that holds the reference data"); \
    return;                                                                           \
  }
