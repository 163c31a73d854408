#pragma once

/// The whole library, a door a topic, without io/ (which needs nlohmann-json).

#include "thermfit/controller.hpp"
#include "thermfit/controller/narrow_model.hpp"
#include "thermfit/controller/settings_for.hpp"
#include "thermfit/diagnosis.hpp"
#include "thermfit/regression.hpp"
#include "thermfit/simulation.hpp"
#include "thermfit/study.hpp"
#include "thermfit/version.hpp"
