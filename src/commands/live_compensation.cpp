#include "commands/live_compensation.hpp"

#include <algorithm>
#include <cmath>

#include "thermfit/error.hpp"
#include "thermfit/io/csv/writer.hpp"
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

void LiveCompensation::read_header(const std::string& line, std::size_t line_number) {
  table_.emplace(line, line_number, "standard input");
  for (const std::string& name : temperatures_) {
    const auto column = table_->find(name, Quantity::temperature);
    if (!column)
      throw Error(detail::place("standard input", line_number), "no column '" + name + "'",
                  "the model's temperatures by name", "name the columns as in training");
    columns_.push_back(*column);
  }
  if (shadow_)
    for (std::size_t j = 0; j < errors_.size(); ++j) measured_[j].column = table_->find(errors_[j], Quantity::length);
  device_.start();
}

bool LiveCompensation::read_readings(const std::string& line) {
  if (!table_->take(line)) return false;
  for (std::size_t i = 0; i < columns_.size(); ++i) readings_[i] = table_->value(columns_[i], Quantity::temperature);
  for (Measured& measured : measured_)
    measured.value_um = measured.column ? table_->value(*measured.column, Quantity::length) : missing;
  return true;
}

void LiveCompensation::lose_readings() {
  std::fill(readings_.begin(), readings_.end(), missing);
  for (Measured& measured : measured_) measured.value_um = missing;
}

std::string LiveCompensation::answer_header() const {
  std::string text = "line";
  for (const std::string& name : errors_) text += ',' + csv_field("offset_" + name + "_um");
  text += ",state,status,sensor,fault";
  if (!shadow_) return text;
  for (const std::string& name : errors_) text += ',' + csv_field("shadow_" + name + "_um");
  for (std::size_t j = 0; j < errors_.size(); ++j)
    if (measured_[j].column) text += ',' + csv_field("remaining_" + errors_[j] + "_um");
  return text;
}

std::string LiveCompensation::answer(std::size_t line_number) {
  const CompensatorStatus status = device_.step(readings_);
  std::string text = std::to_string(line_number);
  for (std::size_t j = 0; j < errors_.size(); ++j)
    text += ',' + (shadow_ ? "0" : exact_text(device_.offset_um()[j] + 0.0));
  text += std::string(",") + state_name(status.state()) + ',' + std::to_string(status.word) + ',';
  if (status.sensor() > 0) text += csv_field(temperatures_[static_cast<std::size_t>(status.sensor() - 1)]);
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
