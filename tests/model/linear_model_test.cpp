#include "thermfit/model/linear_model.hpp"

#include <utility>

#include "support/catch.hpp"
#include "thermfit/model/training_domain.hpp"

using namespace thermfit;

TEST_CASE("a linear model predicts alike in fixed and dynamic sizes, one sample or many", "[model]") {
  LinearModel<> dynamic{Matrix(3, 2), Vector(2)};
  dynamic.coefficients << 1, -2, .5, 0, 0, 4;
  dynamic.intercept << 10, -1;
  LinearModel<float, 3, 2> fixed{dynamic.coefficients.cast<float>(), dynamic.intercept.cast<float>()};
  Matrix rows(2, 3);
  rows << 1, 2, 3, 0, -4, .25;
  const Matrix many = dynamic.predict_rows(rows);
  for (Index r = 0; r < 2; ++r) {
    const Vector one = dynamic.predict(rows.row(r).transpose());
    const Eigen::Vector2f narrow = fixed.predict(rows.row(r).transpose().cast<float>().eval());
    CHECK((many.row(r).transpose() - one).norm() == 0);
    CHECK((narrow.cast<double>() - one).norm() < 1e-6);
  }
  CHECK(many(0, 0) == 12);
  CHECK(many(0, 1) == 9);
  CHECK(fixed.sensors() == 3);
  CHECK(fixed.errors() == 2);
  static_assert(noexcept(fixed.predict(std::declval<const Eigen::Vector3f&>())), "controller code never throws");
}

TEST_CASE("distance to the training domain splits into the plane of the scores and what is left", "[model]") {
  TrainingDomain<double, 3, 2> domain;
  domain.mean << 1, 2, 3;
  domain.scale << 1, 2, .5;
  domain.rotations << 1, 0, 0, 1, 0, 0;
  domain.loadings = domain.rotations;
  domain.score_variance << 4, 1;
  const DomainDistance<> at_mean = domain.distance(Eigen::Vector3d(1, 2, 3));
  CHECK(at_mean.t2 == 0);
  CHECK(at_mean.spe == 0);
  const DomainDistance<> inside = domain.distance(Eigen::Vector3d(3, 8, 3));  // z = (2, 3, 0)
  CHECK(inside.t2 == Approx(2 * 2 / 4.0 + 3 * 3));
  CHECK(inside.spe == Approx(0));
  const DomainDistance<> beside = domain.distance(Eigen::Vector3d(1, 2, 4));  // z = (0, 0, 2)
  CHECK(beside.t2 == Approx(0));
  CHECK(beside.spe == Approx(4));
  TrainingDomain<> dynamic;
  dynamic.mean = domain.mean;
  dynamic.scale = domain.scale;
  dynamic.rotations = domain.rotations;
  dynamic.loadings = domain.loadings;
  dynamic.score_variance = domain.score_variance;
  CHECK(dynamic.distance(Vector(Eigen::Vector3d(3, 8, 4))).t2 == Approx(inside.t2));
  CHECK(dynamic.distance(Vector(Eigen::Vector3d(3, 8, 4))).spe == Approx(beside.spe));
}
