#pragma once

/// The whole library in reading order, without io/ (which needs nlohmann-json).

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/error.hpp"
#include "thermfit/fit/fit.hpp"
#include "thermfit/fit/jackknife.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/model/linear_model.hpp"
#include "thermfit/moments/moments.hpp"
#include "thermfit/moments/observations.hpp"
#include "thermfit/robustness/cross_batch.hpp"
#include "thermfit/robustness/leave_one_batch_out.hpp"
#include "thermfit/robustness/outside_domain.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"
#include "thermfit/select/rule.hpp"
#include "thermfit/types.hpp"
#include "thermfit/version.hpp"
