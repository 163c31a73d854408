/// The instances for double of moments/, select/, fit/, model/ and robustness/ (thermfit/compiled.hpp).

#include "thermfit/compiled.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include "thermfit/study.hpp"
