// The instances of diagnosis/ itself and of its planning that thermfit::compiled holds; what lies below is compiled
// elsewhere.
#include "thermfit/diagnosis/sides/bad_cells.hpp"
#include "thermfit/diagnosis/sides/compare_machine.hpp"
#include "thermfit/diagnosis/where/where.hpp"
#include "thermfit/findings/findings.hpp"
#include "thermfit/simulation.hpp"
#include "thermfit/statistics/follows.hpp"
#include "thermfit/statistics/prior_fit.hpp"
#include "thermfit/statistics/residual_noise.hpp"
#include "thermfit/statistics/whiteness.hpp"
#include "thermfit/study.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include "thermfit/diagnosis/diagnose.hpp"
#include "thermfit/diagnosis/planning/next_experiment.hpp"
