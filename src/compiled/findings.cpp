// The instances of include/thermfit/findings/ that thermfit::compiled holds: see thermfit/compiled.hpp.
#include "thermfit/compiled.hpp"
#include "thermfit/statistics/residual_noise.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE
#include "thermfit/findings/campaign_findings.hpp"
