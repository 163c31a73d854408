#include "commands/live_compensation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "thermfit/error.hpp"
#include "thermfit/io/csv/writer.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

const double missing = std::nan("");
constexpr double store_every_s = 60;  // lags of minutes move little in that

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
                                   std::string state_file, double off_s)
    : temperatures_(trained.temperatures),
      errors_(trained.errors),
      state_file_(std::move(state_file)),
      model_(narrow_model<double>(trained, wishes.domain_limit)),
      settings_(settings_for<double>(trained, wishes)),
      device_(model_, settings_),
      shadow_(shadow),
      period_s_(wishes.period_s),
      off_s_(off_s),
      time_s_(missing),
      readings_(temperatures_.size(), missing),
      measured_(errors_.size()),
      probes_(errors_.size()) {}

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
  for (std::size_t j = 0; j < errors_.size(); ++j)
    probes_[j].column = table_->find("probe_" + errors_[j], Quantity::length);
  time_column_ = table_->find_time();
  if (state_file_.empty()) return;
  const auto lags = static_cast<int>(model_.features.lag_sensor.size());
  kept_ = read_zero(state_file_, temperatures_, model_.identity, model_.features.channels.empty() ? -1 : lags);
  if (!kept_.remark.empty()) remarks_.push_back(kept_.remark);
}

/// Starts with the zero that was kept; `time_s` is the clock of the first line.
void LiveCompensation::start(double time_s) {
  if (started_) return;
  started_ = true;
  const bool by_clock = !std::isfinite(off_s_) && time_s >= kept_.time_s;
  const double off_s = by_clock ? time_s - kept_.time_s : off_s_;
  std::uint32_t off_periods = Device::off_unknown;
  if (off_s >= 0)  // this line's own period is counted with it
    off_periods = static_cast<std::uint32_t>(std::min(1e9, std::max(0., std::floor(off_s / period_s_ + 0.5) - 1)));
  device_.resume(kept_.zero, off_periods);
  if (kept_.zero.mark == 0 || model_.features.lag_sensor.empty()) return;
  remarks_.push_back(off_s >= 0 ? state_file_ + ": was off for " + general_text(off_s, 6) + " s" +
                                      (by_clock ? ", by the clock of the input" : "") + "; lags go on from there"
                                : state_file_ +
                                      ": how long it was off is not known, so that lags cannot go on; allowed: "
                                      "a time column that goes on, or --off S; no zero until there is a datum");
}

bool LiveCompensation::read_readings(const std::string& line) {
  if (!table_->take(line)) return false;
  const double time_s = time_column_ ? table_->time_s(*time_column_) : missing;
  start(time_s);
  count_periods(time_s);
  for (std::size_t i = 0; i < columns_.size(); ++i) readings_[i] = table_->value(columns_[i], Quantity::temperature);
  for (Measured& measured : measured_)
    measured.value_um = measured.column ? table_->value(*measured.column, Quantity::length) : missing;
  for (Probe& probe : probes_) probe.value_um = probe.column ? table_->value(*probe.column, Quantity::length) : missing;
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
  start(missing);
  device_.take_datum();
  periods_ = 0;
}

/// Stores a zero as soon as it is there, and where lags are now and then.
void LiveCompensation::keep_zero() {
  const bool pending = device_.status().zero_pending();
  since_stored_ = counted(since_stored_, periods_);
  const bool lags_moved = !model_.features.lag_sensor.empty() && since_stored_ * period_s_ >= store_every_s;
  if ((zero_was_pending_ && !pending) || lags_moved) store();
  zero_was_pending_ = pending;
}

void LiveCompensation::store() {
  if (state_file_.empty() || device_.status().zero_source() == ZeroSource::none) return;
  write_zero(state_file_, temperatures_, device_.retained(), !model_.features.channels.empty(), time_s_);
  since_stored_ = 0;
}

void LiveCompensation::finish() {
  if (!model_.features.lag_sensor.empty()) store();
}

/// Hands the readings of the line to the device, which has stepped with its temperatures.
void LiveCompensation::take_probe() {
  for (std::size_t j = 0; j < probes_.size(); ++j) {
    Probe& probe = probes_[j];
    if (!std::isfinite(probe.value_um)) continue;
    const ProbeReading judged = device_.probe(j, probe.value_um);
    ++(judged == ProbeReading::taken ? probe.taken : probe.refused);
    const char* const why[] = {"", "no number", "a larger correction than --probe-limit",
                               "far off the last one: taken when the next agrees",
                               "nothing is compensated to compare with"};
    if (judged != ProbeReading::taken)
      remarks_.push_back("probe of " + errors_[j] + ": " + exact_text(probe.value_um) +
                         " um not taken: " + why[static_cast<int>(judged)]);
    probe.value_um = missing;
  }
}

std::vector<std::string> LiveCompensation::remarks() { return std::exchange(remarks_, {}); }

void LiveCompensation::lose_readings(double silence_s) {
  start(missing);
  periods_ = silence_s > 0 ? static_cast<std::uint32_t>(std::max(1., std::min(1e9, silence_s / period_s_ + 0.5))) : 1;
  std::fill(readings_.begin(), readings_.end(), missing);
  for (Measured& measured : measured_) measured.value_um = missing;
  for (Probe& probe : probes_) probe.value_um = missing;
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
  take_probe();
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
  for (std::size_t j = 0; j < errors_.size(); ++j)
    if (probes_[j].taken + probes_[j].refused > 0)
      remarks.push_back(errors_[j] + ": " + std::to_string(probes_[j].taken) + " readings of the probe taken, " +
                        std::to_string(probes_[j].refused) + " not");
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
