#pragma once

/// What the gap costs a compensation model: trained on simulated batches, scored on real ones.

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/fit/pls.hpp"
#include "thermfit/fit/residuals.hpp"
#include "thermfit/robustness/robustness.hpp"
#include "thermfit/select/correlation.hpp"

namespace thermfit {

/// S_mean and S_std, eq. (10), (12), (13), of one PLS model per stage: made from all simulated batches of the stage
/// (temperature rises), scored on every real batch. The points are those `count` with the largest correlation with the
/// error in the real batches, the same for all stages. `stages` are the simulator as given, calibrated, with the
/// effect; batches, temperatures and the error `output` in the order of `real`. Empty where a side has no such error.
inline Transfer transfer_of(const std::array<Campaign, 3>& stages, const Campaign& real, const std::string& output,
                            Index count = 2) {
  Transfer result;
  if (real.empty() || real[0].errors.find(output) < 0 || real[0].temperatures.count() < count) return result;
  const auto moments_of_batch = [&](const Batch& batch) {
    return Moments(model_temperatures(batch, TemperatureReference::rise),
                   Matrix(batch.errors.values.col(batch.errors.find(output))));
  };
  std::vector<Moments> measured;
  for (const Batch& batch : real) measured.push_back(moments_of_batch(batch));
  const std::vector<RankedPoint> ranking = correlation_ranking(merged(measured));
  std::vector<Index> points;
  for (const RankedPoint& one : ranking)
    if (!one.constant && static_cast<Index>(points.size()) < count) points.push_back(one.point);
  for (std::size_t stage = 0; stage < stages.size(); ++stage) {
    std::vector<Moments> simulated;
    for (const Batch& batch : stages[stage]) simulated.push_back(moments_of_batch(batch).subset(points));
    const LinearFit fit = fit_pls(merged(simulated));
    std::vector<double> S_by_batch;
    for (const Moments& one : measured) S_by_batch.push_back(S(residuals(fit.model, one.subset(points)))(0));
    const MeanAndStd score = MeanAndStd::of(S_by_batch);
    result.S_mean[stage] = score.S_mean;
    result.S_std[stage] = score.S_std;
  }
  for (const Index point : points) result.points.push_back(real[0].temperatures.names[static_cast<std::size_t>(point)]);
  return result;
}

}  // namespace thermfit
