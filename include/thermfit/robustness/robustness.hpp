#pragma once

#include <cmath>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Accuracy S_mean and robustness S_std of eq. (12) and (13), um; divisor K, not K - 1.
struct MeanAndStd {
  double S_mean = 0;
  double S_std = 0;

  static MeanAndStd of(const std::vector<double>& values) {
    if (values.empty()) return {};
    const auto v = Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size())).array();
    const double mean = v.mean();
    return {mean, std::sqrt((v - mean).square().mean())};
  }
};

/// A matrix of S (row: the batch a model was made from; column: the batch it predicts), summarised.
struct Robustness {
  std::vector<MeanAndStd> models;          ///< row by row: each model over the batches
  std::vector<MeanAndStd> batches;         ///< column by column: each batch over the models
  MeanAndStd per_model;                    ///< mean and standard deviation of the models' S_mean
  MeanAndStd pooled;                       ///< over all pairs
  Index worst_model = 0, worst_batch = 0;  ///< the pair with the largest S
  double worst_S = 0;
};

/// Both readings of the paper's table 8, um. `S` is K x K; the diagonal, a model on its own batch, is left out unless
/// `own_batch`. Needs two batches then, and a square matrix: Error otherwise.
inline Robustness robustness(const Matrix& S, bool own_batch = false) {
  if (S.rows() != S.cols() || S.rows() < (own_batch ? 1 : 2)) {
    throw Error("robustness", std::to_string(S.rows()) + " models on " + std::to_string(S.cols()) + " batches",
                "two batches or more, each with its model");
  }
  Robustness result;
  std::vector<double> all, means;
  std::vector<std::vector<double>> columns(static_cast<std::size_t>(S.cols()));
  for (Index model = 0; model < S.rows(); ++model) {
    std::vector<double> row;
    for (Index batch = 0; batch < S.cols(); ++batch) {
      if (model == batch && !own_batch) continue;
      const double value = S(model, batch);
      row.push_back(value);
      columns[static_cast<std::size_t>(batch)].push_back(value);
      if (value > result.worst_S) {
        result.worst_S = value;
        result.worst_model = model;
        result.worst_batch = batch;
      }
    }
    all.insert(all.end(), row.begin(), row.end());
    result.models.push_back(MeanAndStd::of(row));
    means.push_back(result.models.back().S_mean);
  }
  for (const auto& column : columns) result.batches.push_back(MeanAndStd::of(column));
  result.per_model = MeanAndStd::of(means);
  result.pooled = MeanAndStd::of(all);
  return result;
}

}  // namespace thermfit
