#include "commands/live_compensation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "commands/kept_zero.hpp"
#include "thermfit/error.hpp"
#include "thermfit/io/csv/writer.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

const double missing = std::nan("");

const char* state_name(CompensatorState state) {
  const char* const names[] = {"off",     "starting", "tracking", "substituting",
                               "holding", "fallback", "stopping", "no datum"};
  return names[static_cast<int>(state)];
}

const char* fault_name(SensorFault fault) {
  const char* const names[] = {"",           "not finite",   "range", "rate",     "stuck",
                               "recovering", "no reference", "stale", "disagrees"};
  return names[static_cast<int>(fault)];
}

const char* zero_name(ZeroSource source) {
  const char* const names[] = {"none", "first", "datum", "retained"};
  return names[static_cast<int>(source)];
}

}  // namespace

LiveCompensation::LiveCompensation(const TrainedModel& trained, const CompensationWishes& wishes, bool shadow,
                                   std::string state_file)
    : temperatures_(trained.temperatures),
      errors_(trained.errors),
      state_file_(std::move(state_file)),
      model_(narrow_model<double>(trained, wishes.domain_limit)),
      settings_(settings_for<double>(trained, wishes)),
      device_(model_, settings_),
      shadow_(shadow),
      period_s_(wishes.period_s),
      time_s_(missing),
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
  time_column_ = table_->find_time();
  const KeptZero kept = state_file_.empty() ? KeptZero{} : read_zero(state_file_, temperatures_, model_.identity);
  if (!kept.remark.empty()) remarks_.push_back(kept.remark);
  device_.resume(kept.zero);
}

bool LiveCompensation::read_readings(const std::string& line) {
  if (!table_->take(line)) return false;
  count_periods(time_column_ ? table_->time_s(*time_column_) : missing);
  for (std::size_t i = 0; i < columns_.size(); ++i) readings_[i] = table_->value(columns_[i], Quantity::temperature);
  for (Measured& measured : measured_)
    measured.value_um = measured.column ? table_->value(*measured.column, Quantity::length) : missing;
  return true;
}

/// How many periods the line comes after the one before, by its clock; one where it has none, or its clock went back.
void LiveCompensation::count_periods(double time_s) {
  const double elapsed_s = time_s - time_s_;
  periods_ = 1;
  if (elapsed_s < 0) {
    remarks_.push_back("the clock went back by " + general_text(-elapsed_s, 4) + " s; counts as one period");
  } else if (std::isfinite(elapsed_s)) {
    periods_ = static_cast<std::uint32_t>(std::min(1e9, std::floor(elapsed_s / period_s_ + 0.5)));
    if (periods_ != 1 && !told_of_period_) {
      told_of_period_ = true;
      remarks_.push_back("lines are " + general_text(elapsed_s, 4) + " s apart by their clock and --period is " +
                         exact_text(period_s_) + " s: the clock counts; where lines always come so, say --period " +
                         general_text(elapsed_s, 4));
    }
  }
  if (periods_ > 0) time_s_ = time_s;
}

void LiveCompensation::take_datum() {
  device_.take_datum();
  periods_ = 0;
}

/// Stores a zero as soon as it is there.
void LiveCompensation::keep_zero() {
  const bool pending = device_.status().zero_pending();
  if (zero_was_pending_ && !pending && device_.status().zero_source() != ZeroSource::none && !state_file_.empty())
    write_zero(state_file_, temperatures_, device_.retained());
  zero_was_pending_ = pending;
}

std::vector<std::string> LiveCompensation::remarks() { return std::exchange(remarks_, {}); }

void LiveCompensation::lose_readings(double silence_s) {
  periods_ = silence_s > 0 ? static_cast<std::uint32_t>(std::max(1., std::min(1e9, silence_s / period_s_ + 0.5))) : 1;
  std::fill(readings_.begin(), readings_.end(), missing);
  for (Measured& measured : measured_) measured.value_um = missing;
}

std::string LiveCompensation::answer_header() const {
  std::string text = "line";
  for (const std::string& name : errors_) text += ',' + csv_field("offset_" + name + "_um");
  text += ",state,status,sensor,fault,zero";
  if (!shadow_) return text;
  for (const std::string& name : errors_) text += ',' + csv_field("shadow_" + name + "_um");
  for (std::size_t j = 0; j < errors_.size(); ++j)
    if (measured_[j].column) text += ',' + csv_field("remaining_" + errors_[j] + "_um");
  return text;
}

std::string LiveCompensation::answer(std::size_t line_number) {
  const CompensatorStatus status = device_.step(readings_, {periods_, 0});
  keep_zero();
  std::string text = std::to_string(line_number);
  for (std::size_t j = 0; j < errors_.size(); ++j)
    text += ',' + (shadow_ ? "0" : exact_text(device_.offset_um()[j] + 0.0));
  text += std::string(",") + state_name(status.state()) + ',' + std::to_string(status.word) + ',';
  if (status.sensor() > 0) text += csv_field(temperatures_[static_cast<std::size_t>(status.sensor() - 1)]);
  text += std::string(",") + fault_name(status.fault()) + ',' + zero_name(status.zero_source());
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
