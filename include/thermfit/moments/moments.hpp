#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/error.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Count, means, range and centred cross-products of joint (temperatures, errors): all that a linear fit, a
/// correlation and the S of any linear model need, whatever the number of rows.
///
/// Channels are ordered temperatures first, then errors. Rows are added in blocks that are centred on their own mean
/// and merged by the pairwise update of Chan, Golub and LeVeque (The American Statistician 37, 1983):
/// `M = M_a + M_b + d d' n_a n_b / n` with `d = mean_b - mean_a`. No difference of large sums is ever taken.
///
/// Scalar is what the sums are kept in: float, double or long double. `Moments moments(temperatures, errors)` takes
/// that of its rows; `Moments<>` is double.
template <typename Scalar = double>
class Moments {
 public:
  Moments() = default;

  /// No rows yet, of `temperatures` points and `errors` responses.
  Moments(Index temperatures, Index errors)
      : temperatures_(temperatures),
        mean_(VectorX<Scalar>::Zero(temperatures + errors)),
        lowest_(VectorX<Scalar>::Constant(temperatures + errors, std::numeric_limits<Scalar>::infinity())),
        highest_(-lowest_),
        products_(MatrixX<Scalar>::Zero(temperatures + errors, temperatures + errors)) {}

  /// Of all rows of `temperatures` (rows x points) and `errors` (rows x responses). Throws like add_rows.
  template <typename Temperatures, typename Errors>
  Moments(const Eigen::MatrixBase<Temperatures>& temperatures, const Eigen::MatrixBase<Errors>& errors)
      : Moments(temperatures.cols(), errors.cols()) {
    add_rows(temperatures, errors);
  }

  /// Rows seen; of several batches about their own means, less one for each batch but the first.
  Index rows() const { return rows_; }
  /// Temperature points.
  Index temperatures() const { return temperatures_; }
  /// Responses.
  Index errors() const { return mean_.size() - temperatures_; }

  /// Per point, K of rise or degC.
  auto temperature_mean() const { return mean_.head(temperatures_); }
  /// Per response, um.
  auto error_mean() const { return mean_.tail(errors()); }
  /// Per point: the lowest value seen.
  auto temperature_lowest() const { return lowest_.head(temperatures_); }
  /// Per point: the highest value seen.
  auto temperature_highest() const { return highest_.head(temperatures_); }

  /// Sums over rows of products of deviations from the mean (not divided): points x points.
  auto temperature_products() const { return products_.topLeftCorner(temperatures_, temperatures_); }
  /// Points x responses, of the same sums.
  auto cross_products() const { return products_.topRightCorner(temperatures_, errors()); }
  /// Responses x responses, of the same sums.
  auto error_products() const { return products_.bottomRightCorner(errors(), errors()); }

  /// Channel `c` (temperatures first, then errors) does not vary: its range is empty, or its deviation is no more
  /// than the rounding of its values. Such a channel carries no information and is left out of every scaling.
  bool constant(Index c) const {
    const Scalar largest = std::max(std::abs(lowest_(c)), std::abs(highest_(c)));
    const Scalar rounding = 16 * std::numeric_limits<Scalar>::epsilon() * largest;
    return !(highest_(c) - lowest_(c) > rounding);
  }

  /// Adds rows. The widths must agree and every value be finite: throws Error naming row (from 0 within this call)
  /// and column otherwise, and is then unchanged. Allocates one block, and a copy of what has no contiguous columns
  /// (a row-major matrix, an expression).
  template <typename Temperatures, typename Errors>
  void add_rows(const Eigen::MatrixBase<Temperatures>& temperatures, const Eigen::MatrixBase<Errors>& errors) {
    add_blocks(temperatures, errors);
  }

  /// Adds the rows another Moments has seen. An empty one (of any width) changes nothing; otherwise the widths must
  /// agree, or Error is thrown.
  void merge(const Moments& other);

  /// The same rows seen through the temperature columns `points`, in that order, and the error columns `responses`.
  /// Columns that do not exist: Error. Allocates the result.
  Moments subset(const std::vector<Index>& points, const std::vector<Index>& responses) const;

  /// The same rows seen through the temperature columns `points`, with all errors.
  Moments subset(const std::vector<Index>& points) const {
    std::vector<Index> responses(static_cast<std::size_t>(errors()));
    for (Index e = 0; e < errors(); ++e) responses[static_cast<std::size_t>(e)] = e;
    return subset(points, responses);
  }

  /// The same rows with `offset` (one per temperature point) taken off every temperature: absolute temperatures to
  /// rises, with the first row of the batch as offset. Products of deviations do not change.
  template <typename Offset>
  Moments minus(const Eigen::MatrixBase<Offset>& offset) const {
    Moments result = *this;
    result.mean_.head(temperatures_) -= offset;
    result.lowest_.head(temperatures_) -= offset;
    result.highest_.head(temperatures_) -= offset;
    return result;
  }

  /// The same rows about their own mean, in temperatures and errors: a batch whose intercept is a free number. All
  /// means are 0. Merged with others of this kind there is no term between batches, and each further batch takes a
  /// degree of freedom: K batches of n rows count as n - K + 1, so that a variance has the divisor n - K. Allocates the
  /// result.
  Moments about_own_mean() const {
    Moments result = *this;
    result.lowest_ -= mean_;
    result.highest_ -= mean_;
    result.mean_.setZero();
    result.about_own_mean_ = true;
    return result;
  }

 private:
  using Rows = MatrixView<Scalar>;

  void add_blocks(const Rows& temperatures, const Rows& errors);

  template <class Block>
  static Moments of_block(const Eigen::MatrixBase<Block>& rows, Index temperatures, Index first_row) {
    Moments block(temperatures, rows.cols() - temperatures);
    block.rows_ = rows.rows();
    block.mean_ = rows.colwise().mean().transpose();
    if (!block.mean_.allFinite()) refuse_non_finite(rows, temperatures, first_row);
    block.lowest_ = rows.colwise().minCoeff().transpose();
    block.highest_ = rows.colwise().maxCoeff().transpose();
    const MatrixX<Scalar> deviations = rows.rowwise() - block.mean_.transpose();
    block.products_.template triangularView<Eigen::Lower>() = deviations.transpose() * deviations;
    block.products_ = block.products_.template selfadjointView<Eigen::Lower>();
    return block;
  }

  template <class Block>
  static void refuse_non_finite(const Eigen::MatrixBase<Block>& rows, Index temperatures, Index first_row) {
    for (Index r = 0; r < rows.rows(); ++r) {
      for (Index c = 0; c < rows.cols(); ++c) {
        if (std::isfinite(rows(r, c))) continue;
        throw Error("row " + std::to_string(first_row + r) + ", " + (c < temperatures ? "temperature " : "error ") +
                        std::to_string(c < temperatures ? c : c - temperatures),
                    std::isnan(rows(r, c)) ? "nan" : "an infinite value", "finite numbers",
                    "drop or hold missing values first");
      }
    }
    throw Error("rows", "values whose sum overflows", "finite sums");
  }

  static Index checked(Index index, Index size, const char* what) {
    if (index >= 0 && index < size) return index;
    throw Error(what, std::to_string(index), "0 to " + std::to_string(size - 1));
  }

  static std::string shape(const Rows& m) { return std::to_string(m.rows()) + " x " + std::to_string(m.cols()); }

  Index rows_ = 0;
  Index temperatures_ = 0;
  bool about_own_mean_ = false;
  VectorX<Scalar> mean_, lowest_, highest_;
  MatrixX<Scalar> products_;
};

/// Moments of rows keep their scalar.
template <typename Temperatures, typename Errors>
Moments(const Eigen::MatrixBase<Temperatures>&, const Eigen::MatrixBase<Errors>&)
    -> Moments<typename Temperatures::Scalar>;

template <typename Scalar>
void Moments<Scalar>::add_blocks(const Rows& temperatures, const Rows& errors) {
  if (temperatures.cols() != temperatures_ || errors.cols() != this->errors() || temperatures.rows() != errors.rows()) {
    throw Error("rows", shape(temperatures) + " temperatures and " + shape(errors) + " errors",
                std::to_string(temperatures_) + " and " + std::to_string(this->errors()) +
                    " columns with equal numbers of rows");
  }
  Moments sum = *this;
  constexpr Index block_rows = 256;  // a block of some ten channels stays in the first-level cache
  MatrixX<Scalar> block(block_rows, mean_.size());
  for (Index first = 0; first < temperatures.rows(); first += block_rows) {
    const Index count = std::min(block_rows, temperatures.rows() - first);
    block.topLeftCorner(count, temperatures_) = temperatures.middleRows(first, count);
    block.topRightCorner(count, this->errors()) = errors.middleRows(first, count);
    sum.merge(of_block(block.topRows(count), temperatures_, first));
  }
  *this = std::move(sum);
}

template <typename Scalar>
void Moments<Scalar>::merge(const Moments& other) {
  if (other.rows_ == 0) return;
  if (rows_ == 0 && mean_.size() == 0) {
    *this = other;
    return;
  }
  if (other.temperatures_ != temperatures_ || other.errors() != errors()) {
    throw Error("moments",
                std::to_string(other.temperatures_) + " temperatures and " + std::to_string(other.errors()) + " errors",
                std::to_string(temperatures_) + " and " + std::to_string(errors()) + ", as in those merged before");
  }
  if (other.about_own_mean_ != about_own_mean_ && rows_ > 0)
    throw Error("moments", "some about the mean of their batch, some not", "all of one kind");
  about_own_mean_ = other.about_own_mean_;
  const Index further = about_own_mean_ && rows_ > 0 ? 1 : 0;
  const Scalar total = static_cast<Scalar>(rows_ + other.rows_);
  const Scalar share = static_cast<Scalar>(other.rows_) / total;
  const VectorX<Scalar> step = other.mean_ - mean_;
  products_ += other.products_;
  products_.noalias() += (static_cast<Scalar>(rows_) * share * step) * step.transpose();
  mean_ += share * step;
  lowest_ = lowest_.cwiseMin(other.lowest_);
  highest_ = highest_.cwiseMax(other.highest_);
  rows_ += other.rows_ - further;
}

template <typename Scalar>
Moments<Scalar> Moments<Scalar>::subset(const std::vector<Index>& points, const std::vector<Index>& responses) const {
  std::vector<Index> channels;
  for (const Index point : points) channels.push_back(checked(point, temperatures_, "point"));
  for (const Index response : responses) {
    channels.push_back(temperatures_ + checked(response, errors(), "response"));
  }
  Moments result(static_cast<Index>(points.size()), static_cast<Index>(responses.size()));
  result.rows_ = rows_;
  result.about_own_mean_ = about_own_mean_;
  result.mean_ = mean_(channels);
  result.lowest_ = lowest_(channels);
  result.highest_ = highest_(channels);
  result.products_ = products_(channels, channels);
  return result;
}

/// All of them together, merged in their order. Widths must agree, or Error.
template <typename Scalar>
Moments<Scalar> merged(const std::vector<Moments<Scalar>>& batches) {
  Moments<Scalar> total;
  for (const Moments<Scalar>& batch : batches) total.merge(batch);
  return total;
}

/// Entry i: all batches but the i-th, from merged prefixes and suffixes: 3K merges for K batches and, unlike taking
/// a batch away from the total, no cancellation. Widths must agree, or Error.
template <typename Scalar>
std::vector<Moments<Scalar>> leave_one_out(const std::vector<Moments<Scalar>>& batches) {
  std::vector<Moments<Scalar>> result(batches.size());
  Moments<Scalar> before, after;
  for (std::size_t i = 0; i < batches.size(); ++i) {
    result[i] = before;
    before.merge(batches[i]);
  }
  for (std::size_t i = batches.size(); i-- > 0;) {
    result[i].merge(after);
    Moments<Scalar> longer = batches[i];
    longer.merge(after);
    after = std::move(longer);
  }
  return result;
}

THERMFIT_COMPILED_TEMPLATE(void Moments<double>::add_blocks(const Rows&, const Rows&));
THERMFIT_COMPILED_TEMPLATE(void Moments<double>::merge(const Moments<double>&));
THERMFIT_COMPILED_TEMPLATE(Moments<double> Moments<double>::subset(const std::vector<Index>&, const std::vector<Index>&)
                               const);

}  // namespace thermfit
