#include "thermfit/robustness/robustness.hpp"

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("S_mean and S_std follow eq. (12) and (13) in both readings, own batch left out", "[robustness]") {
  Matrix S(3, 3);
  S << 100, 1, 3,  //
      2, 100, 6,   //
      5, 7, 100;
  const Robustness<> r = robustness(S);
  CHECK(r.models[0].S_mean == Approx(2));
  CHECK(r.models[0].S_std == Approx(1));  // divisor K
  CHECK(r.models[2].S_mean == Approx(6));
  CHECK(r.batches[0].S_mean == Approx(3.5));
  CHECK(r.batches[2].S_mean == Approx(4.5));
  CHECK(r.per_model.S_mean == Approx(4));
  CHECK(r.per_model.S_std == Approx(std::sqrt((4.0 + 0 + 4) / 3)));
  CHECK(r.pooled.S_mean == Approx(4));
  CHECK(r.pooled.S_std == Approx(std::sqrt((9.0 + 1 + 4 + 4 + 1 + 9) / 6)));
  CHECK(r.worst_S == 7);
  CHECK(r.worst_model == 2);
  CHECK(r.worst_batch == 1);
}

TEST_CASE("the own batch counts when asked for", "[robustness]") {
  Matrix S(2, 2);
  S << 1, 3, 5, 7;
  const Robustness<> r = robustness(S, true);
  CHECK(r.models[0].S_mean == Approx(2));
  CHECK(r.pooled.S_mean == Approx(4));
  CHECK(r.pooled.S_std == Approx(std::sqrt(5.0)));
  CHECK(r.worst_S == 7);
  CHECK(robustness(Matrix::Constant(1, 1, 2.5), true).per_model.S_mean == 2.5);
}

TEST_CASE("one batch alone, or models and batches that do not pair, are an Error", "[robustness]") {
  CHECK_THROWS_AS(robustness(Matrix::Ones(1, 1)), Error);
  CHECK_THROWS_AS(robustness(Matrix::Ones(2, 3)), Error);
  CHECK_THROWS_AS(robustness(Matrix(0, 0), true), Error);
}
