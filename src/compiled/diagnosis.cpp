// The instances of diagnosis/ that thermfit::compiled holds; what lies below is compiled elsewhere.
#include "thermfit/calibration/calibrate.hpp"
#include "thermfit/calibration/held_out.hpp"
#include "thermfit/findings/findings.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include "thermfit/diagnosis/diagnose.hpp"
#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"
