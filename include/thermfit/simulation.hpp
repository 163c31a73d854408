#pragma once

/// A machine as a lumped thermal network: what it is, what drives it, what is added to its physics, and how it is
/// fitted to a campaign.

#include "thermfit/calibration/batch_numbers.hpp"
#include "thermfit/calibration/calibrate.hpp"
#include "thermfit/calibration/fitted_batches.hpp"
#include "thermfit/calibration/shortcomings.hpp"
#include "thermfit/effects/catalogue.hpp"
#include "thermfit/network/excitation.hpp"
#include "thermfit/network/network_check.hpp"
#include "thermfit/network/simulate.hpp"
#include "thermfit/network/thermal_network.hpp"
