#include "thermfit/calibration/step_in_box.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

const Matrix information{{4., 1.}, {1., 3.}};
const Vector gradient{{1., 2.}}, nowhere = Vector::Zero(2), far_off = Vector::Constant(2, 100);

}  // namespace

TEST_CASE("a step within the box is Newton's") {
  const Vector step = step_in_box(information, gradient, nowhere, -far_off, far_off);
  CHECK((information * step - gradient).norm() < 1e-14);
}

TEST_CASE("a coordinate that would leave the box stops at its wall and the others are solved for anew") {
  const Vector high{{100., .5}};
  const Vector step = step_in_box(information, gradient, nowhere, -far_off, high);
  CHECK(step(1) == .5);
  CHECK(4 * step(0) == Approx(1 - .5));
}

TEST_CASE("a box without room is not left") {
  CHECK(step_in_box(information, gradient, far_off, far_off, far_off) == nowhere);
}
