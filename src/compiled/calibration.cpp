// The instances of include/thermfit/calibration/ that thermfit::compiled holds: see thermfit/compiled.hpp.
#include "thermfit/network/simulate.hpp"
#include "thermfit/statistics/residual_noise.hpp"
#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE
#include "thermfit/calibration/calibrate.hpp"
#include "thermfit/calibration/held_out.hpp"
