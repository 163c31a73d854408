#include "thermfit/statistics/course_start.hpp"

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("a course starts at its first reading, warm-up or not", "[statistics]") {
  CHECK(course_start({.5, 13.3, 23, 29.6, 35.3, 40, 43, 45, 46, 47}, 3).value == .5);
  CHECK(course_start({0, 0, 0, 0, 0, 0}, 3).value == 0);
  CHECK(course_start({5}, 3).value == 5);
  CHECK(std::isnan(course_start({}, 3).value));
  std::vector<double> warming;
  for (int k = 0; k < 30; ++k) warming.push_back(30 * (1 - std::exp(-k / 5.)));
  CHECK(course_start(warming, .1).off == 0);
}

TEST_CASE("one bad first reading is no start: the course taken back is", "[statistics]") {
  for (const double bad : {-999.9, 0., 250., 1e12}) {
    std::vector<double> x;
    for (int k = 0; k < 30; ++k) x.push_back(100 + 2 * k);
    x[0] = bad;
    const CourseStart start = course_start(x, 3);
    CAPTURE(bad);
    CHECK(start.value == 100);
    CHECK(start.off == Approx(std::abs(102 - bad - 2)));
  }
}

TEST_CASE("what lies within the noise is a start", "[statistics]") {
  CHECK(course_start({2, 0, 1, 2, 3, 4}, 5).value == 2);
  CHECK(course_start({20, 0, 1, 2, 3, 4}, 5).value == -1);
}
