#include "thermfit/fit/block_ridge.hpp"

#include <Eigen/QR>
#include <limits>
#include <random>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

constexpr double gone = std::numeric_limits<double>::infinity();

/// Rows of eight columns, the first six of very different size, and a response.
struct Rows {
  Matrix columns{40, 8};
  Vector response{40};

  Rows() {
    std::mt19937 random(7);
    for (Index r = 0; r < 40; ++r) {
      for (Index c = 0; c < 8; ++c)
        columns(r, c) = std::pow(10, static_cast<double>(c) / 3) * (static_cast<double>(random()) / 4294967296. - .4);
      response(r) = columns(r, 0) - .1 * columns(r, 4) + static_cast<double>(random()) / 4294967296.;
    }
  }
  Matrix products() const { return columns.transpose() * columns; }
  Vector cross() const { return columns.transpose() * response; }
};

/// The same by least squares on rows, each penalty as a row more: `sqrt(lambda) s b = 0`, by QR.
Vector by_rows(const Rows& rows, const std::vector<PenalisedBlock<>>& blocks, PenaltyScale scale) {
  Matrix a = Matrix::Zero(48, 8);
  a.topRows(40) = rows.columns;
  Vector y = Vector::Zero(48);
  y.head(40) = rows.response;
  for (const PenalisedBlock<>& block : blocks)
    for (Index c = block.first; c < block.first + block.count; ++c) {
      const double mean =
          rows.columns.middleCols(block.first, block.count).squaredNorm() / static_cast<double>(block.count);
      const double square = scale == PenaltyScale::block ? mean : rows.columns.col(c).squaredNorm();
      a(40 + c, c) = std::sqrt(block.penalty * square);
    }
  return a.householderQr().solve(y);
}

}  // namespace

TEST_CASE("block ridge is least squares with a row for every penalty", "[fit]") {
  const Rows rows;
  const std::vector<PenalisedBlock<>> blocks{{0, 3, .01}, {3, 3, 2}, {6, 1, 1e-3}};  // the last column goes free
  for (const PenaltyScale scale : {PenaltyScale::block, PenaltyScale::column}) {
    const Vector b = block_ridge(rows.products(), rows.cross(), blocks, scale);
    CHECK((b - by_rows(rows, blocks, scale)).norm() < 1e-10 * b.norm());
  }
}

TEST_CASE("block ridge without penalty is least squares", "[fit]") {
  const Rows rows;
  const Vector b = block_ridge(rows.products(), rows.cross(), {{0, 8, 0}});
  CHECK((b - rows.columns.householderQr().solve(rows.response)).norm() < 1e-9 * b.norm());
}

TEST_CASE("a block penalised infinitely is not there, one of zeros has coefficients 0", "[fit]") {
  Rows rows;
  const Vector without = block_ridge(rows.products(), rows.cross(), {{0, 3, .1}, {3, 5, gone}});
  CHECK(without.tail(5).isZero(0));
  const Matrix products = rows.products().topLeftCorner(3, 3);
  CHECK(without.head(3) == block_ridge(products, Vector(rows.cross().head(3)), {{0, 3, .1}}));
  rows.columns.middleCols(3, 2).setZero();
  const Vector zero = block_ridge(rows.products(), rows.cross(), {{0, 3, .1}, {3, 2, .1}, {5, 3, .1}});
  CHECK(zero.segment(3, 2).isZero(0));
  CHECK(zero.allFinite());
  CHECK(block_ridge(rows.products(), rows.cross(), {{0, 8, gone}}).isZero(0));
}

TEST_CASE("under the column scale the unit of a column makes no difference", "[fit]") {
  Rows rows;
  const std::vector<PenalisedBlock<>> blocks{{0, 8, .05}};
  const Vector b = block_ridge(rows.products(), rows.cross(), blocks, PenaltyScale::column);
  rows.columns.col(2) *= 1000;
  const Vector other = block_ridge(rows.products(), rows.cross(), blocks, PenaltyScale::column);
  CHECK(other(2) * 1000 == Approx(b(2)));
  CHECK(other(5) == Approx(b(5)));
}
