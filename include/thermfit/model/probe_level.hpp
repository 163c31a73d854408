#pragma once

#include <cmath>

#include "thermfit/model/trained_model.hpp"

namespace thermfit {

/// What an error stands at where nothing has moved, um, when that is no thermal error but the probe's zero or a machine
/// coordinate; else 0.
///
/// It is the intercept of a model on rises, the mean of the errors of one on absolute temperatures, where errors are as
/// recorded. No thermal error is what exceeds all that the model's temperatures moved in training, sum |um/K| times
/// range, and 4 standard deviations of the errors besides. Does not allocate.
inline double probe_level_um(const TrainedModel& trained, Index error) {
  if (trained.error_reference != ErrorReference::recorded) return 0;
  const bool rise = trained.reference == TemperatureReference::rise;
  const double level = rise ? trained.model.intercept(error) : trained.error_mean(error);
  double moved = 4 * trained.error_scale(error);
  for (Index i = 0; i < trained.model.sensors() && i < trained.domain.lowest.size(); ++i)
    moved += std::abs(trained.model.coefficients(i, error)) * (trained.domain.highest(i) - trained.domain.lowest(i));
  return std::abs(level) > moved ? level : 0;
}

}  // namespace thermfit
