#pragma once

/// What a simulator's parameters could change in its own output, learnt from that output alone.

#include <algorithm>
#include <string>
#include <vector>

#include "thermfit/effects/output_traces.hpp"
#include "thermfit/statistics/filters.hpp"
#include "thermfit/statistics/prior_fit.hpp"

namespace thermfit {

/// Regressors of one channel that stand for calibration, all batches below each other, with the standard deviation of
/// each coefficient.
struct CalibrationBasis {
  Matrix regressors;            ///< samples x coefficients
  Vector prior_sd;              ///< of each coefficient around 0
  std::vector<Index> borrowed;  ///< columns that hold measured temperatures, which the simulator alone would not have
  double explained = 0;         ///< share of the simulated course that its recorded drives explain, 0…1
};

namespace detail {

/// What drives the simulated courses, and each drive's traces through first-order lags: every input to the first and
/// second power, the ambient, and the fading of the start.
template <typename Scalar = double>
struct Drives {
  std::vector<std::vector<MatrixX<Scalar>>> traces;  ///< by drive, by batch

  explicit Drives(const PairedCampaign& campaign) {
    const std::vector<double> lags_s = lag_ladder_s(campaign);
    for (Index i = 0; i < static_cast<Index>(campaign.inputs.size()); ++i) {
      double largest = 0;
      for (const PairedBatch& batch : campaign.batches)
        for (Index k = 0; k < batch.inputs.rows(); ++k) largest = std::max(largest, std::abs(batch.inputs(k, i)));
      if (largest == 0) continue;
      add(campaign, [&](const PairedBatch& batch) {
        const MatrixX<Scalar>& inputs = batch.inputs;
        const VectorX<Scalar> share = inputs.col(i) / largest;
        std::vector<VectorX<Scalar>> columns;
        for (const double lag_s : lags_s)
          for (const VectorX<Scalar>& course : {share, VectorX<Scalar>(share.array().square())})
            columns.push_back(low_pass_held(batch.time_s, course, lag_s));
        return columns;
      });
    }
    if (campaign.room_is_simulated)
      add(campaign, [&](const PairedBatch& batch) {
        std::vector<VectorX<Scalar>> columns;
        for (const double lag_s : lags_s) {
          const VectorX<Scalar> felt = low_pass(batch.time_s, batch.room_degC, lag_s, batch.room_degC(0));
          columns.push_back(felt.array() - batch.room_degC(0));
        }
        return columns;
      });
    add(campaign, [&](const PairedBatch& batch) {
      const VectorX<Scalar>& time_s = batch.time_s;
      std::vector<VectorX<Scalar>> columns;
      for (const double lag_s : lags_s) columns.push_back(1 - (-time_s / lag_s).array().exp());
      return columns;
    });
  }

 private:
  template <class Columns>
  void add(const PairedCampaign& campaign, Columns columns_of) {
    traces.emplace_back();
    for (const PairedBatch& batch : campaign.batches) {
      const std::vector<VectorX<Scalar>> columns = columns_of(batch);
      MatrixX<Scalar> trace(batch.time_s.size(), static_cast<Index>(columns.size()));
      for (std::size_t k = 0; k < columns.size(); ++k) trace.col(static_cast<Index>(k)) = columns[k];
      traces.back().push_back(trace);
    }
  }
};

inline Vector since_first(Vector course) {
  for (Index k = course.size() - 1; k >= 0; --k) course(k) -= course(0);
  return course;
}

/// The part of each batch's simulated rise that each drive causes (by drive, by batch): a regression on the traces.
template <typename Scalar>
struct Contributions {
  std::vector<std::vector<VectorX<Scalar>>> courses;
  double explained = 0;
};

template <typename Scalar>
Contributions<Scalar> contributions(const PairedCampaign& campaign, const Drives<Scalar>& drives, Index channel) {
  Index columns = 0;
  for (const auto& drive : drives.traces) columns += drive[0].cols();
  MatrixX<Scalar> regressors(campaign.rows(), columns);
  VectorX<Scalar> rise(campaign.rows());
  for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
    Index at = 0;
    for (const auto& drive : drives.traces) {
      campaign.part(regressors, b).middleCols(at, drive[b].cols()) = drive[b];
      at += drive[b].cols();
    }
    const MatrixX<Scalar>& simulated = campaign.batches[b].simulated;
    campaign.part(rise, b) = since_first(simulated.col(channel));
  }
  const double scale = std::sqrt(rise.squaredNorm() / static_cast<double>(campaign.rows())) + 1e-9;
  const VectorX<Scalar> fitted =
      fit_with_prior(cross_products(regressors, rise), VectorX<Scalar>::Constant(columns, 30 * scale), .01 * scale)
          .coefficients;
  Contributions<Scalar> result;
  Index at = 0;
  for (const auto& drive : drives.traces) {
    result.courses.emplace_back();
    for (const MatrixX<Scalar>& trace : drive)
      result.courses.back().push_back(trace * fitted.segment(at, trace.cols()));
    at += drive[0].cols();
  }
  const double total = rise.squaredNorm();
  result.explained = total > 0 ? 1 - (rise - regressors * fitted).squaredNorm() / total : 1;
  return result;
}

}  // namespace detail

/// Regressors for `channel`: a placement offset (temperatures, .5 K), for every drive its contribution (30 %) and that
/// contribution lagged (50 %), for a temperature its distance to every other (a sensor sits between places, 15 %), for
/// a displacement the temperature gaps and rises that carry expansion.
template <typename Scalar = double>
CalibrationBasis calibration_basis(const PairedCampaign& campaign, const detail::Drives<Scalar>& drives,
                                   Index channel) {
  const bool displacement = channel >= campaign.temperatures;
  const std::vector<double> lags_s = lag_ladder_s(campaign);
  const detail::Contributions<Scalar> parts = detail::contributions<Scalar>(campaign, drives, channel);
  CalibrationBasis basis;
  basis.explained = parts.explained;

  VectorX<Scalar> um_per_K = VectorX<Scalar>::Zero(campaign.temperatures);
  if (displacement && campaign.temperatures > 0) {
    MatrixX<Scalar> rises(campaign.rows(), campaign.temperatures);
    VectorX<Scalar> displaced(campaign.rows());
    for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
      const MatrixX<Scalar>& simulated = campaign.batches[b].simulated;
      campaign.part(rises, b) =
          simulated.leftCols(campaign.temperatures).rowwise() - simulated.row(0).head(campaign.temperatures);
      campaign.part(displaced, b) = simulated.col(channel);
    }
    um_per_K = fit_with_prior(cross_products(rises, displaced), VectorX<Scalar>::Constant(campaign.temperatures, 3), .2)
                   .coefficients;
  }

  std::vector<double> prior_sd;
  for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
    const PairedBatch& batch = campaign.batches[b];
    const MatrixX<Scalar>&simulated = batch.simulated, &measured = batch.measured;
    std::vector<VectorX<Scalar>> columns;
    prior_sd.clear();
    basis.borrowed.clear();
    const auto add = [&](const VectorX<Scalar>& column, double sd) {
      columns.push_back(column);
      prior_sd.push_back(sd);
    };
    if (!displacement) add(VectorX<Scalar>::Ones(batch.time_s.size()), .5);
    for (const auto& drive : parts.courses) {
      add(drive[b], .3);
      for (std::size_t k = 0; k < 3; ++k)
        add(VectorX<Scalar>(low_pass(batch.time_s, drive[b], lags_s[k], 0)) - drive[b], .5);
    }
    for (Index j = 0; j < campaign.temperatures; ++j) {
      const VectorX<Scalar> rise = detail::since_first(simulated.col(j));
      if (!displacement && j != channel) add(rise - detail::since_first(simulated.col(channel)), .15);
      if (!displacement) continue;
      basis.borrowed.push_back(static_cast<Index>(columns.size()));
      add(detail::since_first(measured.col(j)) - rise, 1.5 * std::abs(um_per_K(j)) + .02);
      add(rise, .3 * std::abs(um_per_K(j)) + .02);
    }
    MatrixX<Scalar>& regressors = basis.regressors;
    if (b == 0) regressors.resize(campaign.rows(), static_cast<Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k)
      campaign.part(regressors, b).col(static_cast<Index>(k)) = columns[k];
  }
  basis.prior_sd = Eigen::Map<const VectorX<Scalar>>(prior_sd.data(), static_cast<Index>(prior_sd.size()));
  return basis;
}

}  // namespace thermfit
