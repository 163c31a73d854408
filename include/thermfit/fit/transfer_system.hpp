#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "thermfit/features/climate_range.hpp"
#include "thermfit/fit/block_ridge.hpp"
#include "thermfit/fit/residuals.hpp"
#include "thermfit/fit/transfer_batch.hpp"

namespace thermfit {

/// Range over some batches. Zero of none.
template <typename Scalar>
ClimateRange<Scalar> climate_range(const std::vector<const TransferBatch<Scalar>*>& batches) {
  if (batches.empty()) return {};
  ClimateRange<Scalar> range{batches.front()->climate_degC, batches.front()->climate_degC, 0};
  for (const TransferBatch<Scalar>* batch : batches) {
    range.lowest = std::min(range.lowest, batch->climate_degC);
    range.highest = std::max(range.highest, batch->climate_degC);
    range.mean += batch->climate_degC / static_cast<Scalar>(batches.size());
  }
  return range;
}

/// How the blocks of the method `transfer` are penalised, and its lag. Infinite: the block is left out.
template <typename Scalar = double>
struct TransferPenalties {
  Scalar rise = std::numeric_limits<Scalar>::infinity();        ///< of b
  Scalar lag = std::numeric_limits<Scalar>::infinity();         ///< of c
  Scalar climate = std::numeric_limits<Scalar>::infinity();     ///< of g
  PenaltyScale scale = PenaltyScale::block;                     ///< what coefficients are measured in
  std::size_t lag_index = 0;                                    ///< which of the lags
  Scalar input = std::numeric_limits<Scalar>::infinity();       ///< of changes of known inputs
  Scalar input_lag = std::numeric_limits<Scalar>::infinity();   ///< of lagged inputs
  Scalar difference = std::numeric_limits<Scalar>::infinity();  ///< of differences
};

/// Coefficients of one error: `z = a + sum b_j R_j + sum c_j x_j + factor sum g_j R_j`, and those of known inputs and
/// differences.
template <typename Scalar = double>
struct TransferCoefficients {
  Scalar intercept_um = 0;       ///< a
  VectorX<Scalar> rise;          ///< b, um/K
  VectorX<Scalar> lagged;        ///< c, um/K
  VectorX<Scalar> climate;       ///< g, um/K^2
  VectorX<Scalar> input;         ///< of the change of each known input, um per unit of it
  VectorX<Scalar> input_lagged;  ///< of each lagged input
  VectorX<Scalar> difference;    ///< um/K
};

/// Normal equations of some batches, each counted alike whatever its rows, for one lag: sums of their products, also
/// times the climate and its square, from which the products of all columns follow.
template <typename Scalar = double>
class TransferSystem {
 public:
  TransferSystem() = default;

  /// Of `batches` through lag `lag`, climates about `centre`.
  TransferSystem(const std::vector<const TransferBatch<Scalar>*>& batches, std::size_t lag, Scalar centre)
      : centre_(centre) {
    for (const TransferBatch<Scalar>* batch : batches) add(*batch, lag, 1);
  }

  /// The same less `batches`, which must be among them.
  TransferSystem without(const std::vector<const TransferBatch<Scalar>*>& batches, std::size_t lag) const {
    TransferSystem result = *this;
    for (const TransferBatch<Scalar>* batch : batches) result.add(*batch, lag, -1);
    return result;
  }

  /// Coefficients of error `error` under `penalties`, with climates about `mean`. The intercept is
  /// 0 unless it is asked for. Allocates.
  TransferCoefficients<Scalar> solve(Index error, const TransferPenalties<Scalar>& penalties, Scalar mean,
                                     bool intercept) const {
    const Index p = points_, lags = std::isfinite(penalties.lag) && has_lag_ ? p : 0;
    const Index inputs = std::isfinite(penalties.input) ? inputs_ : 0;
    const Index input_lags = std::isfinite(penalties.input_lag) && has_lag_ ? inputs_ : 0;
    const Index differences = std::isfinite(penalties.difference) ? one_ - first_difference_ : 0;
    const Index climates = std::isfinite(penalties.climate) ? p : 0, rises = std::isfinite(penalties.rise) ? p : 0;
    const Index response = one_ + 1 + error;
    const Scalar shift = mean - centre_;
    std::vector<Index> plain;  // columns of the products, then those times the climate
    for (Index j = 0; j < rises; ++j) plain.push_back(j);
    for (Index j = 0; j < lags; ++j) plain.push_back(p + j);
    for (Index j = 0; j < inputs; ++j) plain.push_back(first_input_ + j);
    for (Index j = 0; j < input_lags; ++j) plain.push_back(first_input_ + inputs_ + j);
    for (Index j = 0; j < differences; ++j) plain.push_back(first_difference_ + j);
    const Index constant = static_cast<Index>(plain.size());
    if (intercept) plain.push_back(one_);
    const Index n = static_cast<Index>(plain.size());
    MatrixX<Scalar> products(n + climates, n + climates);
    VectorX<Scalar> cross(n + climates);
    products.topLeftCorner(n, n) = plain_(plain, plain);
    cross.head(n) = plain_(plain, response);
    if (climates > 0) {
      const auto head = Eigen::seqN(0, p);
      products.topRightCorner(n, p) = once_(plain, head) - shift * plain_(plain, head);
      products.bottomLeftCorner(p, n) = products.topRightCorner(n, p).transpose();
      products.bottomRightCorner(p, p) =
          twice_(head, head) - 2 * shift * once_(head, head) + shift * shift * plain_(head, head);
      cross.tail(p) = once_(head, response) - shift * plain_(head, response);
    }
    const VectorX<Scalar> solved = block_ridge(products, cross,
                                               {{0, rises, penalties.rise},
                                                {rises, lags, penalties.lag},
                                                {n, climates, penalties.climate},
                                                {rises + lags, inputs, penalties.input, true},
                                                {rises + lags + inputs, input_lags, penalties.input_lag, true},
                                                {constant - differences, differences, penalties.difference}},
                                               penalties.scale);
    TransferCoefficients<Scalar> result{intercept ? solved(constant) : Scalar(0),
                                        VectorX<Scalar>::Zero(p),
                                        VectorX<Scalar>::Zero(p),
                                        VectorX<Scalar>::Zero(p),
                                        VectorX<Scalar>::Zero(inputs_),
                                        VectorX<Scalar>::Zero(inputs_),
                                        VectorX<Scalar>::Zero(one_ - first_difference_)};
    result.input.head(inputs) = solved.segment(rises + lags, inputs);
    result.input_lagged.head(input_lags) = solved.segment(rises + lags + inputs, input_lags);
    result.difference.head(differences) = solved.segment(constant - differences, differences);
    result.rise.head(rises) = solved.head(rises);
    result.lagged.head(lags) = solved.segment(rises, lags);
    result.climate.head(climates) = solved.tail(climates);
    return result;
  }

 private:
  void add(const TransferBatch<Scalar>& batch, std::size_t lag, Scalar sign) {
    if (batch.rows == 0 && plain_.size() > 0) return;
    if (batch.rows == 0) sign = 0;
    const MatrixX<Scalar>& products = batch.products[lag];
    points_ = batch.points;
    one_ = batch.columns() - 1;
    has_lag_ = batch.has_lag;
    inputs_ = batch.inputs;
    first_input_ = batch.first_input();
    first_difference_ = batch.first_difference();
    if (plain_.size() == 0) plain_ = once_ = twice_ = MatrixX<Scalar>::Zero(products.rows(), products.cols());
    const Scalar climate = batch.climate_degC - centre_;
    plain_ += sign * products;
    once_ += (sign * climate) * products;
    twice_ += (sign * climate * climate) * products;
  }

  Scalar centre_ = 0;
  Index points_ = 0, one_ = 0, inputs_ = 0, first_input_ = 0, first_difference_ = 0;
  bool has_lag_ = false;
  MatrixX<Scalar> plain_, once_, twice_;
};

/// What the coefficients leave of error `error` in a batch whose rises are multiplied by `factor` for the climate.
/// Allocates a column.
template <typename Scalar>
Residuals<Scalar> residuals(const TransferCoefficients<Scalar>& model, const TransferBatch<Scalar>& batch,
                            std::size_t lag, Scalar factor, Index error) {
  const MatrixX<Scalar>& products = batch.products[lag];
  const Index p = batch.points, lags = batch.has_lag ? p : 0, columns = batch.columns();
  VectorX<Scalar> b(columns);
  b.head(p) = model.rise + factor * model.climate;
  b.segment(p, lags) = model.lagged.head(lags);
  b.segment(batch.first_input(), batch.inputs) = model.input;
  if (batch.has_lag) b.segment(batch.first_input() + batch.inputs, batch.inputs) = model.input_lagged;
  b.segment(batch.first_difference(), batch.differences) = model.difference;
  b(columns - 1) = model.intercept_um;
  const Index response = columns + error;
  const Scalar square = b.dot(products.topLeftCorner(columns, columns) * b) -
                        2 * b.dot(products.col(response).head(columns)) + products(response, response);
  const Scalar mean = b.dot(products.col(columns - 1).head(columns)) - products(columns - 1, response);
  return {batch.rows, mean, static_cast<Scalar>(batch.rows) * std::max(Scalar(0), square - mean * mean)};
}

}  // namespace thermfit
