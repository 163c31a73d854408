#include "robustness/scalar_cases.hpp"

using namespace scalars;

TEST_CASE("correlations, rankings and grey relational grades keep the digits of double", "[robustness]") {
  rankings_agree<double, long double>();
}

TEST_CASE("S, S_mean and S_std across batches keep the digits of double", "[robustness]") {
  robustness_agrees<double, long double>();
}

TEST_CASE("batches left out and the jackknife keep the digits of double", "[robustness]") {
  left_out_agrees<double, long double>();
}
