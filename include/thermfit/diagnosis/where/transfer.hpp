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
#include "thermfit/network/simulate.hpp"
#include "thermfit/robustness/robustness.hpp"
#include "thermfit/select/correlation.hpp"

namespace thermfit {

/// The campaign `real` with every column that `network` predicts replaced by what it simulates: batches as a machine
/// would have measured them. Allocates.
template <typename Scalar = double>
Campaign simulated_campaign(const ThermalNetwork& network, const Campaign& real, const EffectLibrary& library) {
  Campaign result = real;
  const std::vector<Simulation> all = simulate(network, excitations_of(network, real), library);
  for (std::size_t b = 0; b < result.size(); ++b) {
    const MatrixX<Scalar>& channels = all[b].channels;
    const auto take = [&](Channels& into, const std::string& name, std::size_t channel) {
      const Index at = into.find(name);
      MatrixX<Scalar>& values = into.values;
      if (at >= 0) values.col(at) = channels.col(static_cast<Index>(channel));
    };
    for (std::size_t s = 0; s < network.sensors.size(); ++s) take(result[b].temperatures, network.sensors[s].column, s);
    for (std::size_t d = 0; d < network.displacements.size(); ++d)
      take(result[b].errors, network.displacements[d].output, network.sensors.size() + d);
  }
  return result;
}

/// S_mean and S_std, eq. (10), (12), (13), of one PLS model per level: made from all simulated batches of the level
/// (temperature rises), scored on every real batch. The points are those `count` with the largest correlation with the
/// error in the real batches, the same for all levels. `levels` are the simulator as given, calibrated, with the
/// effect; batches, temperatures and the error `output` in the order of `real`. Empty where a side has no such error.
template <typename Scalar = double>
Transfer transfer_of(const std::array<Campaign, 3>& levels, const Campaign& real, const std::string& output,
                     Index count = 2) {
  Transfer result;
  if (real.empty() || real[0].errors.find(output) < 0 || real[0].temperatures.count() < count) return result;
  const auto moments_of_batch = [&](const Batch& batch) {
    const MatrixX<Scalar> error =
        detail::lazy<Scalar>(batch.errors.values).col(batch.errors.find(output)).template cast<Scalar>();
    return Moments<Scalar>(model_temperatures<Scalar>(batch, TemperatureReference::rise), error);
  };
  std::vector<Moments<Scalar>> measured;
  for (const Batch& batch : real) measured.push_back(moments_of_batch(batch));
  std::vector<Index> points;
  for (const RankedPoint<Scalar>& one : correlation_ranking(merged(measured)))
    if (!one.constant && static_cast<Index>(points.size()) < count) points.push_back(one.point);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    std::vector<Moments<Scalar>> simulated;
    for (const Batch& batch : levels[level]) simulated.push_back(moments_of_batch(batch).subset(points));
    const LinearFit<Scalar> fit = fit_pls(merged(simulated));
    std::vector<Scalar> S_by_batch;
    for (const Moments<Scalar>& one : measured) S_by_batch.push_back(S(residuals(fit.model, one.subset(points)))(0));
    const auto score = MeanAndStd<Scalar>::of(S_by_batch);
    result.S_mean[level] = static_cast<double>(score.S_mean);
    result.S_std[level] = static_cast<double>(score.S_std);
  }
  for (const Index point : points) result.points.push_back(real[0].temperatures.names[static_cast<std::size_t>(point)]);
  return result;
}

}  // namespace thermfit
