// The instances of calibration/ that thermfit::compiled holds; what lies below is compiled elsewhere.
#include "thermfit/network/simulate.hpp"
#include "thermfit/statistics/follows.hpp"
#include "thermfit/statistics/prior_fit.hpp"
#include "thermfit/statistics/residual_noise.hpp"
#include "thermfit/statistics/whiteness.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include "thermfit/calibration/batch_numbers.hpp"
#include "thermfit/calibration/calibrate.hpp"
#include "thermfit/calibration/fitted_batches.hpp"
#include "thermfit/calibration/held_out.hpp"
