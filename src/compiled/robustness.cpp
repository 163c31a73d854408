// The instances of robustness/ that thermfit::compiled holds; what lies below is compiled elsewhere.
#include "thermfit/findings/campaign_findings.hpp"
#include "thermfit/regression.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include "thermfit/study.hpp"
