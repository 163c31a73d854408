#include "run/live_compensation.hpp"

#include <algorithm>
#include <cmath>

#include "thermfit/error.hpp"
#include "thermfit/io/csv/field.hpp"
#include "thermfit/io/csv/header.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

const double missing = std::nan("");

const char* state_name(CompensatorState state) {
  const char* const names[] = {"off", "starting", "tracking", "substituting", "holding", "fallback", "stopping"};
  return names[static_cast<int>(state)];
}

const char* fault_name(SensorFault fault) {
  const char* const names[] = {"", "not finite", "range", "rate", "stuck", "recovering", "no reference"};
  return names[static_cast<int>(fault)];
}

/// The separator that splits the header into most cells.
char separator_of(const std::string& line) {
  char best = ',';
  std::size_t most = 0;
  std::vector<detail::CsvField> fields;
  for (const char candidate : {',', ';', '\t'})
    if (!detail::split_line(line, candidate, fields) && fields.size() > most) {
      most = fields.size();
      best = candidate;
    }
  return best;
}

std::string csv_text(const std::string& name) {
  return name.find_first_of(",\"") == std::string::npos ? name : '"' + name + '"';
}

}  // namespace

LiveCompensation::LiveCompensation(const TrainedModel& trained, const CompensationWishes& wishes, bool shadow)
    : temperatures_(trained.temperatures),
      errors_(trained.errors),
      model_(narrow_model<double>(trained, wishes.domain_limit)),
      settings_(settings_for<double>(trained, wishes)),
      device_(model_, settings_),
      shadow_(shadow),
      readings_(temperatures_.size(), missing),
      measured_(errors_.size()) {}

bool LiveCompensation::is_comment(std::string_view line) {
  return line.empty() || line[0] == '#' || line.find_first_not_of(" \t") == std::string_view::npos;
}

void LiveCompensation::read_header(const std::string& line, std::size_t line_number) {
  const std::string place = "standard input:" + std::to_string(line_number);
  const std::string text = line.rfind("\xEF\xBB\xBF", 0) == 0 ? line.substr(3) : line;
  separator_ = separator_of(text);
  std::vector<detail::CsvField> fields;
  if (const auto error = detail::split_line(text, separator_, fields))
    throw Error(place + ':' + std::to_string(error->column), error->found, "", error->remedy);
  cells_ = fields.size();
  const auto find = [&](const std::string& name, Quantity quantity) -> std::optional<Column> {
    std::optional<Column> found;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const CsvColumn column = detail::column_of(fields[i]);
      if (column.name != name && column.title != name) continue;
      if (found) throw Error(place, "column '" + name + "' twice");
      const auto unit = column.unit.empty() ? Unit{quantity, 0, 1, 1}
                                            : find_unit(column.unit).value_or(Unit{Quantity::time, 0, 1, 1});
      if (unit.quantity != quantity)
        throw Error(place + ':' + std::to_string(column.position), "unit '" + column.unit + "' of '" + name + "'",
                    std::string(unit_names(quantity)));
      found = Column{i, unit};
    }
    return found;
  };
  for (const std::string& name : temperatures_) {
    const auto column = find(name, Quantity::temperature);
    if (!column)
      throw Error(place, "no column '" + name + "'", "the model's temperatures by name",
                  "name the columns as in training");
    columns_.push_back(*column);
  }
  if (shadow_)
    for (std::size_t j = 0; j < errors_.size(); ++j) measured_[j].column = find(errors_[j], Quantity::length);
  device_.start();
}

bool LiveCompensation::read_readings(const std::string& line) {
  std::vector<detail::CsvField> fields;
  if (detail::split_line(line, separator_, fields) || fields.size() != cells_) return false;
  const auto read = [&](const Column& column) {
    const std::string_view cell = fields[column.position].text;
    auto value = detail::parse_field(cell, '.');
    if (!value && separator_ != ',') value = detail::parse_field(cell, ',');
    return value ? column.unit.to_canonical(*value) : missing;
  };
  for (std::size_t i = 0; i < columns_.size(); ++i) readings_[i] = read(columns_[i]);
  for (Measured& measured : measured_) measured.value_um = measured.column ? read(*measured.column) : missing;
  return true;
}

void LiveCompensation::lose_readings() {
  std::fill(readings_.begin(), readings_.end(), missing);
  for (Measured& measured : measured_) measured.value_um = missing;
}

std::string LiveCompensation::answer_header() const {
  std::string text = "line";
  for (const std::string& name : errors_) text += ",offset_" + csv_text(name) + "_um";
  text += ",state,status,sensor,fault";
  if (!shadow_) return text;
  for (const std::string& name : errors_) text += ",shadow_" + csv_text(name) + "_um";
  for (std::size_t j = 0; j < errors_.size(); ++j)
    if (measured_[j].column) text += ",remaining_" + csv_text(errors_[j]) + "_um";
  return text;
}

std::string LiveCompensation::answer(std::size_t line_number) {
  const CompensatorStatus status = device_.step(readings_);
  std::string text = std::to_string(line_number);
  for (std::size_t j = 0; j < errors_.size(); ++j)
    text += ',' + (shadow_ ? "0" : exact_text(device_.offset_um()[j] + 0.0));
  text += std::string(",") + state_name(status.state()) + ',' + std::to_string(status.word) + ',';
  if (status.sensor() > 0) text += csv_text(temperatures_[static_cast<std::size_t>(status.sensor() - 1)]);
  text += std::string(",") + fault_name(status.fault());
  if (!shadow_) return text;
  for (const double offset_um : device_.offset_um()) text += ',' + exact_text(offset_um + 0.0);
  for (std::size_t j = 0; j < errors_.size(); ++j) {
    Measured& measured = measured_[j];
    if (!measured.column) continue;
    text += ',';
    if (!std::isfinite(measured.value_um)) continue;
    const double remaining_um = settings_.sign == OutputSign::correction ? measured.value_um + device_.offset_um()[j]
                                                                         : measured.value_um - device_.offset_um()[j];
    text += exact_text(remaining_um);
    measured.sum_squares += measured.value_um * measured.value_um;
    measured.remaining_squares += remaining_um * remaining_um;
    ++measured.rows;
  }
  return text;
}

std::vector<std::string> LiveCompensation::summary() const {
  std::vector<std::string> remarks;
  for (std::size_t j = 0; j < errors_.size(); ++j) {
    const Measured& measured = measured_[j];
    if (measured.rows == 0) continue;
    const auto rms = [&](double squares) {
      return fixed_text(std::sqrt(squares / static_cast<double>(measured.rows)), 2);
    };
    remarks.push_back(errors_[j] + ": rms " + rms(measured.sum_squares) + " um measured, " +
                      rms(measured.remaining_squares) + " um with the compensation, " + std::to_string(measured.rows) +
                      " rows");
  }
  return remarks;
}

}  // namespace thermfit::cli
