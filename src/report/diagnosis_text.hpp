#pragma once

/// A diagnosis for people: the answer in one sentence, what it rests on, what to do next, then the tables.

#include <string>

#include "thermfit/diagnosis/diagnosis.hpp"

namespace thermfit::cli {

/// At most 80 columns, in the order: the sentence; what was ruled out and why; what could not be told apart; the next
/// experiment; data problems and weaker claims; tables of the gap by stage, where it lies, calibration, batches.
std::string diagnosis_text(const Diagnosis& diagnosis);

}  // namespace thermfit::cli
