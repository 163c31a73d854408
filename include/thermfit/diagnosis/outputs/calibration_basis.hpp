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
  Matrix regressors;
  Vector prior_sd;
  std::vector<Index> borrowed;  ///< columns that hold measured temperatures, which the simulator alone would not have
  double explained = 0;         ///< share of the simulated course that its recorded drives explain, 0…1
};

namespace detail {

/// What drives the simulated courses, and each drive's traces through first-order lags: every input to the first and
/// second power, the ambient, and the fading of the start.
struct Drives {
  std::vector<std::vector<Matrix>> traces;  ///< by drive, by batch

  explicit Drives(const PairedCampaign& campaign) {
    const std::vector<double> lags_s = lag_ladder_s(campaign);
    for (Index i = 0; i < static_cast<Index>(campaign.inputs.size()); ++i) {
      double largest = 0;
      for (const PairedBatch& batch : campaign.batches)
        largest = std::max(largest, batch.inputs.col(i).cwiseAbs().maxCoeff());
      if (largest == 0) continue;
      add(campaign, [&](const PairedBatch& batch) {
        const Vector share = batch.inputs.col(i) / largest;
        std::vector<Vector> columns;
        for (const double lag_s : lags_s)
          for (const Vector& course : {share, Vector(share.array().square())})
            columns.push_back(low_pass_held(batch.time_s, course, lag_s));
        return columns;
      });
    }
    if (campaign.room_is_simulated)
      add(campaign, [&](const PairedBatch& batch) {
        std::vector<Vector> columns;
        for (const double lag_s : lags_s)
          columns.push_back(low_pass(batch.time_s, batch.room_degC, lag_s, batch.room_degC(0)).array() -
                            batch.room_degC(0));
        return columns;
      });
    add(campaign, [&](const PairedBatch& batch) {
      std::vector<Vector> columns;
      for (const double lag_s : lags_s) columns.push_back(1 - (-batch.time_s / lag_s).array().exp());
      return columns;
    });
  }

 private:
  template <class Columns>
  void add(const PairedCampaign& campaign, Columns columns_of) {
    traces.emplace_back();
    for (const PairedBatch& batch : campaign.batches) {
      const std::vector<Vector> columns = columns_of(batch);
      Matrix trace(batch.time_s.size(), static_cast<Index>(columns.size()));
      for (std::size_t k = 0; k < columns.size(); ++k) trace.col(static_cast<Index>(k)) = columns[k];
      traces.back().push_back(trace);
    }
  }
};

inline Vector since_first(const Vector& course) { return course.array() - course(0); }

/// The part of each batch's simulated rise that each drive causes (by drive, by batch): a regression on the traces.
struct Contributions {
  std::vector<std::vector<Vector>> courses;
  double explained = 0;
};

inline Contributions contributions(const PairedCampaign& campaign, const Drives& drives, Index channel) {
  Index columns = 0;
  for (const auto& drive : drives.traces) columns += drive[0].cols();
  Matrix regressors(campaign.rows(), columns);
  Vector rise(campaign.rows());
  for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
    Index at = 0;
    for (const auto& drive : drives.traces) {
      campaign.part(regressors, b).middleCols(at, drive[b].cols()) = drive[b];
      at += drive[b].cols();
    }
    campaign.part(rise, b) = since_first(campaign.batches[b].simulated.col(channel));
  }
  const double scale = std::sqrt(rise.squaredNorm() / static_cast<double>(campaign.rows())) + 1e-9;
  const Vector fitted =
      fit_with_prior(cross_products(regressors, rise), Vector::Constant(columns, 30 * scale), .01 * scale).coefficients;
  Contributions result;
  Index at = 0;
  for (const auto& drive : drives.traces) {
    result.courses.emplace_back();
    for (const Matrix& trace : drive) result.courses.back().push_back(trace * fitted.segment(at, trace.cols()));
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
inline CalibrationBasis calibration_basis(const PairedCampaign& campaign, const detail::Drives& drives, Index channel) {
  const bool displacement = channel >= campaign.temperatures;
  const std::vector<double> lags_s = lag_ladder_s(campaign);
  const detail::Contributions parts = detail::contributions(campaign, drives, channel);
  CalibrationBasis basis;
  basis.explained = parts.explained;

  Vector um_per_K = Vector::Zero(campaign.temperatures);
  if (displacement && campaign.temperatures > 0) {
    Matrix rises(campaign.rows(), campaign.temperatures);
    Vector displaced(campaign.rows());
    for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
      const Matrix& simulated = campaign.batches[b].simulated;
      campaign.part(rises, b) =
          simulated.leftCols(campaign.temperatures).rowwise() - simulated.row(0).head(campaign.temperatures);
      campaign.part(displaced, b) = simulated.col(channel);
    }
    um_per_K =
        fit_with_prior(cross_products(rises, displaced), Vector::Constant(campaign.temperatures, 3), .2).coefficients;
  }

  std::vector<double> prior_sd;
  for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
    const PairedBatch& batch = campaign.batches[b];
    std::vector<Vector> columns;
    prior_sd.clear();
    basis.borrowed.clear();
    const auto add = [&](const Vector& column, double sd) {
      columns.push_back(column);
      prior_sd.push_back(sd);
    };
    if (!displacement) add(Vector::Ones(batch.time_s.size()), .5);
    for (const auto& drive : parts.courses) {
      add(drive[b], .3);
      for (std::size_t k = 0; k < 3; ++k) add(low_pass(batch.time_s, drive[b], lags_s[k], 0) - drive[b], .5);
    }
    for (Index j = 0; j < campaign.temperatures; ++j) {
      const Vector rise = detail::since_first(batch.simulated.col(j));
      if (!displacement && j != channel) add(rise - detail::since_first(batch.simulated.col(channel)), .15);
      if (!displacement) continue;
      basis.borrowed.push_back(static_cast<Index>(columns.size()));
      add(detail::since_first(batch.measured.col(j)) - rise, 1.5 * std::abs(um_per_K(j)) + .02);
      add(rise, .3 * std::abs(um_per_K(j)) + .02);
    }
    basis.regressors.conservativeResize(campaign.rows(), static_cast<Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k)
      campaign.part(basis.regressors, b).col(static_cast<Index>(k)) = columns[k];
  }
  basis.prior_sd = Eigen::Map<const Vector>(prior_sd.data(), static_cast<Index>(prior_sd.size()));
  return basis;
}

}  // namespace thermfit
