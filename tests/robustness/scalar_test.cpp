#include "robustness/scalar_cases.hpp"

using namespace scalars;

TEST_CASE("correlations, rankings and grey relational grades keep the digits of float", "[robustness]") {
  rankings_agree<float, double>();
}

TEST_CASE("S, S_mean and S_std across batches keep the digits of float", "[robustness]") {
  robustness_agrees<float, double>();
}

TEST_CASE("batches left out and the jackknife keep the digits of float", "[robustness]") {
  left_out_agrees<float, double>();
}
