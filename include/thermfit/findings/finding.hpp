#pragma once

#include <string>
#include <string_view>

#include "thermfit/batch/batch.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// What can be wrong with a measured batch before anything is fitted to it.
enum class FindingRule {
  time_gap,    ///< samples are missing: a time step far longer than the usual one
  time_back,   ///< time repeats or goes back
  missing,     ///< cells without a value
  constant,    ///< a temperature or thermal error that never moves
  stuck,       ///< one value for many rows, while other channels say that it should have moved
  saturated,   ///< the same, at the largest or smallest value of a thermal error
  stale,       ///< a thermal error that is read less often than it is written down
  spike,       ///< a reading, or a few, far off those before and after
  jump,        ///< a lasting step between two rows that no input explains
  collinear,   ///< a temperature that others give to less than their resolution: a copy or a computed channel
  unit,        ///< values that make sense in another unit only
  impossible,  ///< a number that no temperature of a machine, or error of it, can have: written without a reading
  copy,        ///< a batch that holds the numbers of another
  level,       ///< a thermal error that starts further apart in its batches than it moves in one
  drift,       ///< a temperature that leaves slowly what the others say
  gain,        ///< one that moves more, or less, than the others say: contact, unit
  dead,        ///< one that does not respond, though the others say that it should
  swapped,     ///< one that reads what another should
  disagrees,   ///< one that does not go with the others, in no way that has a name; or such an error
  sign,        ///< an error of opposite sign to what the other batches say
  step,        ///< another time step than in the other batches
  range        ///< a temperature that starts hot, an error far from zero: right where it is so, or another unit or zero
};

/// The rule's name in tables and JSON. Does not allocate.
inline std::string_view rule_name(FindingRule rule) {
  constexpr std::string_view names[] = {"time-gap",  "time-back", "missing", "constant",  "stuck", "saturated",
                                        "stale",     "spike",     "jump",    "collinear", "unit",  "impossible",
                                        "copy",      "level",     "drift",   "gain",      "dead",  "swapped",
                                        "disagrees", "sign",      "step",    "range"};
  return names[static_cast<int>(rule)];
}

/// One fault of one channel of a batch.
struct Finding {
  FindingRule rule;     ///< which rule is broken
  std::string channel;  ///< name of the channel; `time` for the clock
  Index first_row = 0;  ///< row of the batch where it begins, counted from 0 …
  Index last_row = 0;   ///< … and the last row it holds for
  double figure = 0;    ///< what was measured …
  double limit = 0;     ///< … and what the rule allows, in `unit`
  std::string unit;     ///< of `figure` and `limit`: "K", "um", "s", "rows", …
  std::string note;     ///< what it means, in a few words
};

/// "40" or "40-42": the rows of a finding by their numbers in the file of its batch. Allocates the text.
inline std::string rows_text(const Finding& finding, const Batch& batch) {
  const std::string first = std::to_string(batch.number_of(finding.first_row));
  return finding.first_row == finding.last_row ? first
                                               : first + '-' + std::to_string(batch.number_of(finding.last_row));
}

}  // namespace thermfit
