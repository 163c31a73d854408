#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/findings/sound_rows.hpp"

namespace thermfit {

/// When an error has the opposite sign.
struct SignLimits {
  double ridge = 1e-3;     ///< share of each temperature's variance
  double halves = 0.5;     ///< turned round, its residual falls to less than this …
  double usual = 2;        ///< … and to what is usual for the other batches, up to this factor
  double explained = 0.7;  ///< of an error's movement half the batches keep less when predicted (half the squares)
  std::size_t fewest_batches = 4;  ///< below, nobody knows which batch is right
};

/// Thermal errors whose sign is opposite to what the temperatures say by the other batches: turned round, their
/// residual with a ridge regression on the temperatures of the other batches (rises about the means of a batch) falls
/// to what is usual. Batches are turned round one after another, that first which agrees best then; never half of them.
/// One list a batch is added to. Allocates.
template <typename Scalar = double>
void add_sign_findings(const Campaign& campaign, std::vector<std::vector<Finding>>& findings,
                       const SignLimits& limits = {}) {
  const std::size_t count = campaign.size();
  if (count < limits.fewest_batches) return;
  const auto same_names = [&](const Batch& batch) {
    return batch.temperatures.names == campaign[0].temperatures.names && batch.errors.names == campaign[0].errors.names;
  };
  const Index points = campaign[0].temperatures.count();
  if (points == 0 || !std::all_of(campaign.begin(), campaign.end(), same_names)) return;
  for (Index e = 0; e < campaign[0].errors.count(); ++e) {
    const std::string& name = campaign[0].errors.names[static_cast<std::size_t>(e)];
    std::vector<MatrixX<Scalar>> squares;
    std::vector<VectorX<Scalar>> products;
    std::vector<Scalar> energies;
    MatrixX<Scalar> all_squares = MatrixX<Scalar>::Zero(points, points);
    for (std::size_t b = 0; b < count; ++b) {
      const Batch& batch = campaign[b];
      const std::vector<bool> sound = detail::sound_rows(batch, findings[b], true);
      const MatrixX<Scalar>& temperatures = batch.temperatures.values;
      const MatrixX<Scalar>& errors = batch.errors.values;
      MatrixX<Scalar> x(batch.rows(), points);
      VectorX<Scalar> y(batch.rows());
      Index rows = 0;
      for (Index row = 0; row < batch.rows(); ++row) {
        if (!sound[static_cast<std::size_t>(row)] || !temperatures.row(row).allFinite() ||
            !std::isfinite(errors(row, e)))
          continue;
        x.row(rows) = temperatures.row(row);
        y(rows++) = errors(row, e);
      }
      x.conservativeResize(rows, points);
      y.conservativeResize(rows);
      if (rows > 0) {
        x.rowwise() -= x.colwise().mean().eval();
        y.array() -= y.mean();
        // Every batch counts the same, whatever its unit and length: a batch in another unit is no measure of a sign.
        const Scalar size = std::sqrt(y.squaredNorm() + Scalar(1e-300)),
                     rise = std::sqrt(x.squaredNorm() + Scalar(1e-300));
        y /= size;
        x /= rise;
      }
      squares.push_back(x.transpose() * x);
      products.push_back(x.transpose() * y);
      energies.push_back(y.squaredNorm());
      all_squares += squares.back();
    }
    std::vector<MatrixX<Scalar>> inverses;
    for (std::size_t b = 0; b < count; ++b) {
      MatrixX<Scalar> normal = all_squares - squares[b];
      normal.diagonal() *= Scalar(1 + limits.ridge);
      normal.diagonal().array() += Scalar(1e-12);
      inverses.push_back(normal.llt().solve(MatrixX<Scalar>::Identity(points, points)));
    }
    std::vector<Scalar> signs(count, Scalar(1));
    // Residual of batch b, and of b turned round, by the others as they are turned now.
    const auto residuals = [&](std::size_t b) {
      VectorX<Scalar> product = VectorX<Scalar>::Zero(points);
      for (std::size_t o = 0; o < count; ++o)
        if (o != b) product += signs[o] * products[o];
      const VectorX<Scalar> weights = inverses[b] * product;
      const Scalar cross = signs[b] * weights.dot(products[b]), own = weights.dot(squares[b] * weights);
      const auto rms = [&](Scalar square) { return std::sqrt(static_cast<double>(std::max(square, Scalar(0)))); };
      return std::make_pair(rms(energies[b] - 2 * cross + own), rms(energies[b] + 2 * cross + own));
    };
    std::vector<std::size_t> turned;
    while (2 * (turned.size() + 1) < count) {
      std::size_t best = count;
      double best_share = limits.halves;
      for (std::size_t b = 0; b < count; ++b) {
        const auto [as_is, round] = residuals(b);
        if (signs[b] > 0 && as_is > 0 && round / as_is < best_share) {
          best = b;
          best_share = round / as_is;
        }
      }
      if (best == count) break;
      signs[best] = -1;
      turned.push_back(best);
    }
    std::vector<double> usual;
    for (std::size_t b = 0; b < count; ++b) usual.push_back(residuals(b).first);
    const double middle = median(usual);
    if (middle > limits.explained) continue;
    const double allowed = limits.usual * middle;
    for (const std::size_t b : turned) {
      const auto [now, before] = residuals(b);
      if (now > allowed || now > limits.halves * before) continue;
      findings[b].push_back(
          {FindingRule::sign, name, 0, campaign[b].rows() - 1, before / std::max(now, 1e-9), 1 / limits.halves, "times",
           "of opposite sign to what the temperatures say by the other batches: probe turned round?"});
    }
  }
}

}  // namespace thermfit
