#pragma once

#include "report/study_text.hpp"

namespace thermfit::cli {

/// The document `thermfit-study/1`; `study --help` explains it.
std::string study_json(const StudyReport& report);

}  // namespace thermfit::cli
