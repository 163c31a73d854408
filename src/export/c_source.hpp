#pragma once

#include "export/export.hpp"

namespace thermfit::cli {

/// The compensator in C99 without includes and guards, for the targets that speak C.
std::string c_source(const ExportRequest& request, bool with_self_test);

}  // namespace thermfit::cli
