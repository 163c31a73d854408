#pragma once

#include <string>

#include "thermfit/diagnosis/diagnosis.hpp"

namespace thermfit::cli {

/// The document `thermfit-diagnosis/1`: keys in the order of the format, added keys after them; figures with six
/// significant digits, `null` where a figure does not exist.
std::string diagnosis_json(const Diagnosis& diagnosis);

}  // namespace thermfit::cli
