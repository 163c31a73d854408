#pragma once

/// What runs in the machine: a guarded compensator of fixed size, without heap, exceptions, run-time types or Eigen.
/// What the host prepares for it is in controller/settings_for.hpp and controller/narrow_model.hpp.

#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/dynamic_row.hpp"
