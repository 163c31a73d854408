#pragma once

/// The whole library in reading order, without io/ (which needs nlohmann-json).

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/error.hpp"
#include "thermfit/model/linear_model.hpp"
#include "thermfit/types.hpp"
#include "thermfit/version.hpp"
