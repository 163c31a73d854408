// The instances of include/thermfit/statistics/ that thermfit::compiled holds: see thermfit/compiled.hpp.
#include "thermfit/compiled.hpp"
#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE
#include "thermfit/statistics/follows.hpp"
#include "thermfit/statistics/prior_fit.hpp"
#include "thermfit/statistics/residual_noise.hpp"
#include "thermfit/statistics/whiteness.hpp"
