#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/error.hpp"
#include "thermfit/statistics/course_start.hpp"
#include "thermfit/statistics/reading_step.hpp"
#include "thermfit/statistics/white_noise.hpp"

namespace thermfit {

/// What thermal errors are measured from. A displacement probe has a zero of its own, which says nothing of the
/// machine: where it is set anew in each batch, or reads a machine coordinate, it must not be fitted.
enum class ErrorReference {
  recorded,  ///< as recorded: the probe's zero is part of what is measured
  start,     ///< from the batch's start, as rises do: what a datum makes of them in the machine
  batch      ///< the batch's own mean is a free number: each batch has an intercept of its own, a model has none
};

/// "recorded", "start" or "batch", as in the model file.
inline const char* name(ErrorReference reference) {
  constexpr const char* names[] = {"recorded", "start", "batch"};
  return names[static_cast<int>(reference)];
}

/// Where an error of a batch starts.
struct ErrorStart {
  Index row = -1;       ///< the first with a reading, from 0; -1: none has
  double value_um = 0;  ///< the reading there, or where those that follow come from when it is off
  double off_um = 0;    ///< how far that reading is off those that follow; 0: it is not
};

/// Start of one error, rows long, um, NaN where there is no reading: course_start() with 12 standard deviations of the
/// noise, or 6 steps of the reading, as the least that is off. Allocates.
inline ErrorStart error_start(const Vector& error) {
  ErrorStart start;
  std::vector<double> readings;
  for (Index row = 0; row < error.size(); ++row) {
    if (!std::isfinite(error(row))) continue;
    if (start.row < 0) start.row = row;
    readings.push_back(error(row));
  }
  if (start.row < 0) return start;
  const double noise = white_noise(std::vector<std::vector<double>>{readings});
  const CourseStart course = course_start(readings, std::max(12 * noise, 6 * step_of(error)));
  start.value_um = course.value;
  start.off_um = course.off;
  return start;
}

/// Throws Error where rises and errors would count from different things: absolute temperatures with errors from the
/// start, or with own intercepts, which take off what absolute temperatures could tell.
inline void require_alike(TemperatureReference temperatures, ErrorReference errors) {
  if (temperatures == TemperatureReference::absolute && errors != ErrorReference::recorded)
    throw Error("ErrorReference", std::string(name(errors)) + " with absolute temperatures",
                "recorded with absolute temperatures, or temperature rise");
}

/// The batch with its errors as `reference` counts them: `start` takes off where each starts (error_start), `batch` its
/// mean over the rows that have one. Where the first row was left out, `start` counts rises and errors both from the
/// first row that is there, and so does `batch` where a temperature has no reading in the row left out.
template <typename Scalar = double>
Batch referenced(Batch batch, ErrorReference reference) {
  if (reference == ErrorReference::recorded) return batch;
  const MatrixX<Scalar>& errors = batch.errors.values;
  VectorX<Scalar> zero(errors.cols());
  for (Index e = 0; e < errors.cols(); ++e) {
    if (reference == ErrorReference::start) {
      zero(e) = error_start(batch.errors.values.col(e)).value_um;
      continue;
    }
    Scalar sum = 0, count = 0;
    for (Index row = 0; row < errors.rows(); ++row)
      if (std::isfinite(errors(row, e))) sum += errors(row, e), ++count;
    zero(e) = count > 0 ? sum / count : Scalar(0);
  }
  const MatrixX<Scalar> since = errors.rowwise() - zero.transpose();
  batch.errors.values = since;
  if (reference == ErrorReference::start || !lacks_first_reading(batch).empty())
    return from_first_row_there(std::move(batch));
  return batch;
}

/// The same for every batch.
template <typename Scalar = double>
Campaign referenced(Campaign campaign, ErrorReference reference) {
  for (Batch& batch : campaign) batch = referenced<Scalar>(std::move(batch), reference);
  return campaign;
}

}  // namespace thermfit
