#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "commands/kept_zero.hpp"
#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/settings_for.hpp"
#include "thermfit/io/csv/line_reader.hpp"

namespace thermfit::cli {

/// A compensator fed with lines of CSV: what `thermfit run` is apart from reading and writing.
class LiveCompensation {
 public:
  /// `state_file` keeps the zero over a power cycle, of a model with features where its lags are too; empty: nothing is
  /// kept. `off_s`: how long it was off; NaN: by the clock of the input, where that goes on.
  LiveCompensation(const TrainedModel& trained, const CompensationWishes& wishes, bool shadow,
                   std::string state_file = "", double off_s = std::numeric_limits<double>::quiet_NaN());
  LiveCompensation(const LiveCompensation&) = delete;

  /// Finds the model's columns, those of a probe (`probe_` and an error), and in shadow mode measured errors. Throws
  /// Error on a missing or repeated name, a unit that is no temperature, text that is no UTF-8, or a quote that is
  /// never closed. Reads the zero of the state file where there is one; the first line after starts with it.
  void read_header(const std::string& line, std::size_t line_number);

  /// Takes the cells of the next line; cells that are no number are missing. False when the line has not as many cells
  /// as the header.
  bool read_readings(const std::string& line);
  /// Readings that are missing, `silence_s` seconds after the ones before; 0: one period.
  void lose_readings(double silence_s = 0);
  /// The operator probes the work offset now; no time passes.
  void take_datum();

  std::string answer_header() const;
  /// Steps with what was read last and tells the result.
  std::string answer(std::size_t line_number);
  /// What there is to say on the clock and the state file since it was asked last.
  std::vector<std::string> remarks();
  /// At the end: in shadow mode, what was measured and what would have been left.
  std::vector<std::string> summary() const;
  /// At the end: stores where the lags are.
  void finish();

 private:
  void start(double time_s);
  void keep_zero();
  void store();
  void take_probe();
  void count_periods(double time_s);

  using Device = Compensator<double, dynamic_size, dynamic_size, dynamic_size>;
  struct Measured {
    std::optional<std::size_t> column;
    double value_um = 0, sum_squares = 0, remaining_squares = 0;
    std::size_t rows = 0;
  };
  struct Probe {
    std::optional<std::size_t> column;
    double value_um = 0;
    std::size_t taken = 0, refused = 0;
  };

  std::vector<std::string> temperatures_, errors_;
  std::string state_file_;
  Device::Model model_;
  Device::Settings settings_;
  Device device_;
  bool shadow_, started_ = false, zero_was_pending_ = false, told_of_period_ = false;
  double period_s_, off_s_, time_s_;  ///< of a step; of the line before, NaN: not known
  std::uint32_t periods_ = 1, since_stored_ = 0;
  KeptZero kept_;
  std::vector<std::string> remarks_;
  std::optional<std::size_t> time_column_;
  std::optional<CsvLineReader> table_;
  std::vector<std::size_t> columns_;  ///< of the model's temperatures
  std::vector<double> readings_;
  std::vector<Measured> measured_;
  std::vector<Probe> probes_;
};

}  // namespace thermfit::cli
