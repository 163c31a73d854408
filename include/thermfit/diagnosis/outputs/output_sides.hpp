#pragma once

/// A campaign laid beside the outputs of somebody's simulator.

#include <algorithm>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/outputs/calibration_basis.hpp"
#include "thermfit/diagnosis/sides/side_channel.hpp"
#include "thermfit/statistics/reading_step.hpp"
#include "thermfit/statistics/white_noise.hpp"

namespace thermfit {

/// Both sides of a paired campaign, what calibration of an unknown simulator may move as the belief. `campaign` and
/// `drives` must outlive the result. Allocates.
template <typename Scalar = double>
Sides sides_of(const PairedCampaign& campaign, const detail::Drives<Scalar>& drives) {
  Lazy<Sides, Scalar> result;
  for (const PairedBatch& batch : campaign.batches) {
    result.batches.push_back(batch.name);
    result.time_s.push_back(batch.time_s);
  }
  for (Index c = 0; c < campaign.channel_count(); ++c) {
    SideChannel one;
    one.name = campaign.channels[static_cast<std::size_t>(c)];
    one.displacement = c >= campaign.temperatures;
    for (const PairedBatch& batch : campaign.batches) {
      const MatrixX<Scalar>&measured = batch.measured, &simulated = batch.simulated;
      one.measured.push_back(measured.col(c));
      one.simulated.push_back(simulated.col(c));
    }
    one.noise = std::max(white_noise(one.measured), resolution_sd(one.measured));
    result.channels.push_back(std::move(one));
  }
  result.belief = [&campaign, &drives](std::size_t c) {
    const CalibrationBasis basis = calibration_basis<Scalar>(campaign, drives, static_cast<Index>(c));
    const MatrixX<Scalar>& regressors = basis.regressors;
    const VectorX<Scalar>& prior_sd = basis.prior_sd;
    return MatrixX<Scalar>(regressors * prior_sd.asDiagonal());
  };
  return result;
}

THERMFIT_COMPILED_TEMPLATE(Sides sides_of<double>(const PairedCampaign&, const detail::Drives<double>&));

}  // namespace thermfit
