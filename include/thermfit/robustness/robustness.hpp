#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/fit/residuals.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Accuracy S_mean and robustness S_std of eq. (12) and (13), um; divisor K, not K - 1.
template <typename Scalar = double>
struct MeanAndStd {
  Scalar S_mean = 0;  ///< accuracy, um
  Scalar S_std = 0;   ///< robustness, um

  /// Of some figures; zero of none.
  static MeanAndStd of(const std::vector<Scalar>& values) {
    if (values.empty()) return {};
    const auto v = Eigen::Map<const VectorX<Scalar>>(values.data(), static_cast<Index>(values.size())).array();
    const Scalar mean = v.mean();
    return {mean, std::sqrt((v - mean).square().mean())};
  }
};

/// S_mean and S_std of error `error` over batches, from what a model left in each (per batch, per error). Allocates.
template <typename Scalar>
MeanAndStd<Scalar> figure_of(const std::vector<std::vector<Residuals<Scalar>>>& left, std::size_t error) {
  std::vector<Scalar> S;
  for (const auto& batch : left) S.push_back(batch[error].S());
  return MeanAndStd<Scalar>::of(S);
}

/// A matrix of S (row: the batch a model was made from; column: the batch it predicts), summarised.
template <typename Scalar = double>
struct Robustness {
  std::vector<MeanAndStd<Scalar>> models;   ///< row by row: each model over the batches
  std::vector<MeanAndStd<Scalar>> batches;  ///< column by column: each batch over the models
  MeanAndStd<Scalar> per_model;             ///< mean and standard deviation of the models' S_mean
  MeanAndStd<Scalar> pooled;                ///< over all pairs
  Index worst_model = 0;                    ///< of the pair with the largest S
  Index worst_batch = 0;                    ///< of the pair with the largest S
  Scalar worst_S = 0;                       ///< of that pair, um
};

/// Both readings of the paper's table 8, um. `matrix` is K x K; the diagonal, a model on its own batch, is left out
/// unless `own_batch`. Needs two batches then, and a square matrix: Error otherwise. Allocates.
template <typename Derived, typename Scalar = typename Derived::Scalar>
Robustness<Scalar> robustness(const Eigen::MatrixBase<Derived>& matrix, bool own_batch = false) {
  const MatrixView<Scalar> S = matrix;
  if (S.rows() != S.cols() || S.rows() < (own_batch ? 1 : 2)) {
    throw Error("robustness", std::to_string(S.rows()) + " models on " + std::to_string(S.cols()) + " batches",
                "two batches or more, each with its model");
  }
  Robustness<Scalar> result;
  std::vector<Scalar> all, means;
  std::vector<std::vector<Scalar>> columns(static_cast<std::size_t>(S.cols()));
  for (Index model = 0; model < S.rows(); ++model) {
    std::vector<Scalar> row;
    for (Index batch = 0; batch < S.cols(); ++batch) {
      if (model == batch && !own_batch) continue;
      const Scalar value = S(model, batch);
      row.push_back(value);
      columns[static_cast<std::size_t>(batch)].push_back(value);
      if (value > result.worst_S) {
        result.worst_S = value;
        result.worst_model = model;
        result.worst_batch = batch;
      }
    }
    all.insert(all.end(), row.begin(), row.end());
    result.models.push_back(MeanAndStd<Scalar>::of(row));
    means.push_back(result.models.back().S_mean);
  }
  for (const auto& column : columns) result.batches.push_back(MeanAndStd<Scalar>::of(column));
  result.per_model = MeanAndStd<Scalar>::of(means);
  result.pooled = MeanAndStd<Scalar>::of(all);
  return result;
}

}  // namespace thermfit
