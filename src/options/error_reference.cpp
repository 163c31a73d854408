#include "options/error_reference.hpp"

#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {

Option error_reference_option() {
  return {
      "--error-reference", "WHAT",
      "what thermal errors count from: 'recorded' (the probe's zero; default), 'start' (each batch's first reading: "
      "the change since a datum), or 'batch' (an own intercept for each batch)",
      0, false};
}

ErrorReference error_reference(const Arguments& arguments, ErrorReference otherwise) {
  const std::string word = arguments.choice("--error-reference", {"recorded", "start", "batch"}, name(otherwise));
  for (const ErrorReference one : {ErrorReference::start, ErrorReference::batch})
    if (word == name(one)) {
      if (arguments.has("--absolute"))
        throw UsageError("--error-reference " + word +
                         " takes the level of each batch off its errors, and --absolute leaves it in its temperatures; "
                         "say one of them");
      return one;
    }
  return ErrorReference::recorded;
}

std::string in_words(ErrorReference reference) {
  switch (reference) {
    case ErrorReference::start:
      return "relative to the start of each batch";
    case ErrorReference::batch:
      return "about each batch's own intercept";
    case ErrorReference::recorded:
      break;
  }
  return "as recorded";
}

void note_starts(const Campaign& campaign, ErrorReference reference, bool learning, const Console& console) {
  for (const Batch& batch : campaign) {
    if (reference == ErrorReference::recorded || batch.rows() == 0) continue;
    const std::vector<std::string> lacking = lacks_first_reading(batch);
    const bool moved = learning && reference == ErrorReference::start && batch.first_degC.size() > 0;
    if (moved || !lacking.empty())
      console.note(batch.source + ": rises and errors count from row " + std::to_string(batch.number_of(0)) +
                   ", the first that is whole" +
                   (lacking.empty() ? "" : ": " + name_list(lacking) + " has no reading in the first row"));
    for (Index e = 0; reference == ErrorReference::start && e < batch.errors.count(); ++e) {
      const ErrorStart start = error_start(batch.errors.values.col(e));
      if (start.off_um > 0)
        console.note(batch.source + ": the first reading of " + batch.errors.names[static_cast<std::size_t>(e)] +
                     " is " + fixed_text(start.off_um, 1) +
                     " um off the rows that follow, and no zero: it counts from " + fixed_text(start.value_um, 1) +
                     " um, where they come from; --error-reference batch needs no zero");
    }
  }
}

}  // namespace thermfit::cli
