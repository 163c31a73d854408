// The catalogue, which thermfit::compiled holds; what lies below is compiled elsewhere.
#include "thermfit/network/simulate.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include "thermfit/effects/catalogue.hpp"
