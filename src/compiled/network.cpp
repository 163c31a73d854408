// The instances of include/thermfit/network/ that thermfit::compiled holds: see thermfit/compiled.hpp.
#include "thermfit/compiled.hpp"
#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE
#include "thermfit/network/simulate.hpp"
