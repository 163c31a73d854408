#pragma once

/// Why a simulation and its machine disagree, from the network or from the outputs of any simulator; and what is wrong
/// with the data themselves. With all of simulation.hpp.

#include "thermfit/diagnosis/diagnose.hpp"
#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"
#include "thermfit/findings/findings.hpp"
#include "thermfit/simulation.hpp"
