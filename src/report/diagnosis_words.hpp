#pragma once

/// A diagnosis is codes and numbers; this is the one table that puts them into words, for the text and the document.

#include <string>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"

namespace thermfit::cli {

/// "a, b, c".
std::string joined(const std::vector<std::string>& parts, const std::string& between = ", ");

/// The output of a gap as the document names it.
std::string output_name(const Gap& gap);

/// An effect at its place: "missing-link at head-column".
std::string name_of(const Rival& rival);

/// Why it was dropped; `held_out`: judged on batches not used for fitting.
std::string reason_of(const RuledOut& one, bool held_out);
/// How the two views of the place differ; empty where they agree.
std::string difference_of(const Where& where);
std::string looks_of(const Remaining& remaining, const std::string& unit);
/// Name of a planned piece of machine time, and its settings.
std::string schedule_of(const PlannedBlock& block);
std::string settings_of(const PlannedBlock& block);
std::string remark_of(const NextExperiment& next);
/// Where a data problem lies, what it is, and what to write or do where that is known.
std::string place_of(const DataProblem& problem);
std::string what_of(const DataProblem& problem);
std::string remedy_of(const DataProblem& problem, SimulatorKind simulator);
std::string claim_of(const WeakerClaim& claim);

}  // namespace thermfit::cli
