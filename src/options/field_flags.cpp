#include "options/field_flags.hpp"

#include "thermfit/controller/settings_for.hpp"
#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/fit/train_transfer.hpp"
#include "thermfit/io/csv/options.hpp"

namespace thermfit::cli {
namespace {

/// A row of the table; does not compile when the library has no such field.
#define THERMFIT_FLAG(owner, field, flag) \
  { (static_cast<void>(sizeof(owner::field)), #owner "::" #field), flag }

bool continues_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

const std::vector<FieldFlag>& field_flags() {
  static const std::vector<FieldFlag> table{
      THERMFIT_FLAG(TransferPlan, differences, "--features"),
      THERMFIT_FLAG(CsvOptions, separator, "--delimiter"),
      THERMFIT_FLAG(CsvOptions, decimal_mark, "--decimal"),
      THERMFIT_FLAG(CsvOptions, thousands, "--thousands"),
      THERMFIT_FLAG(CsvOptions, columns, "--columns"),
      THERMFIT_FLAG(CsvOptions, encoding, "--encoding"),
      THERMFIT_FLAG(CsvOptions, header_line, "--header-line"),
      THERMFIT_FLAG(CsvOptions, missing_marks, "--missing-marks"),
      THERMFIT_FLAG(CsvOptions, time_column, "--time-column"),
      THERMFIT_FLAG(CsvOptions, time_format, "--time-format"),
      THERMFIT_FLAG(CsvOptions, between, "--between"),
      THERMFIT_FLAG(CsvOptions, time_step_s, "--time-step"),
      THERMFIT_FLAG(CsvOptions, dialect, "--dialect"),
      THERMFIT_FLAG(CsvOptions, skip_columns, "--skip-columns"),
      THERMFIT_FLAG(CsvOptions, long_table, "--long"),
      THERMFIT_FLAG(CsvOptions, time_unit, "--time-unit"),
      THERMFIT_FLAG(CsvOptions, temperatures, "--temperatures"),
      THERMFIT_FLAG(CsvOptions, errors, "--errors"),
      THERMFIT_FLAG(CsvOptions, inputs, "--inputs"),
      THERMFIT_FLAG(CsvOptions, units, "--units"),
      THERMFIT_FLAG(CsvOptions, batch_column, "--batch-column"),
      THERMFIT_FLAG(CsvOptions, join, "--join"),
      THERMFIT_FLAG(CsvOptions, missing, "--missing"),
      THERMFIT_FLAG(CsvOptions, max_errors, "--max-errors"),
      THERMFIT_FLAG(TrainingPlan, row_wise, "thermfit fit --row-wise"),
      THERMFIT_FLAG(TrainingPlan, error_reference, "--error-reference"),
      THERMFIT_FLAG(OutputsOptions, room, "--ambient"),
      THERMFIT_FLAG(CompensationWishes, through_zero, "--through-zero"),
      {"pair_campaigns::sim", "--sim"},  // an argument of that function
  };
  return table;
}

#undef THERMFIT_FLAG

std::string with_flags(std::string_view message) {
  std::string text(message);
  for (const auto& [field, flag] : field_flags())
    for (std::size_t at = 0; (at = text.find(field, at)) != std::string::npos; ++at) {
      const std::size_t end = at + field.size();
      if (end < text.size() && continues_name(text[end])) continue;
      const bool has_value = text.compare(end, 3, " = ") == 0;
      text.replace(at, field.size() + (has_value ? 2 : 0), flag);
    }
  return text;
}

}  // namespace thermfit::cli
