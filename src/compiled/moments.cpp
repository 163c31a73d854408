// The instances of moments/ and select/ that thermfit::compiled holds; what lies below is compiled elsewhere.
#include "thermfit/statistics/residual_noise.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include "thermfit/moments/moments.hpp"
#include "thermfit/moments/observations.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"
#include "thermfit/select/rule.hpp"
