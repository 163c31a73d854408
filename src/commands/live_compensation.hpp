#pragma once

#include <optional>
#include <string>
#include <vector>

#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/settings_for.hpp"
#include "thermfit/io/csv/line_reader.hpp"

namespace thermfit::cli {

/// A compensator fed with lines of CSV: what `thermfit run` is apart from reading and writing.
class LiveCompensation {
 public:
  LiveCompensation(const TrainedModel& trained, const CompensationWishes& wishes, bool shadow);
  LiveCompensation(const LiveCompensation&) = delete;

  /// Finds the model's columns, and in shadow mode measured errors. Throws Error on a missing or repeated name, a unit
  /// that is no temperature, text that is no UTF-8, or a quote that is never closed. Then starts.
  void read_header(const std::string& line, std::size_t line_number);

  /// Takes the cells of the next line; cells that are no number are missing. False when the line has not as many cells
  /// as the header.
  bool read_readings(const std::string& line);
  void lose_readings();

  std::string answer_header() const;
  /// Steps with what was read last and tells the result.
  std::string answer(std::size_t line_number);
  /// At the end: in shadow mode, what was measured and what would have been left.
  std::vector<std::string> summary() const;

 private:
  using Device = Compensator<double, dynamic_size, dynamic_size, dynamic_size>;
  struct Measured {
    std::optional<std::size_t> column;
    double value_um = 0, sum_squares = 0, remaining_squares = 0;
    std::size_t rows = 0;
  };

  std::vector<std::string> temperatures_, errors_;
  Device::Model model_;
  Device::Settings settings_;
  Device device_;
  bool shadow_;
  std::optional<CsvLineReader> table_;
  std::vector<std::size_t> columns_;  ///< of the model's temperatures
  std::vector<double> readings_;
  std::vector<Measured> measured_;
};

}  // namespace thermfit::cli
