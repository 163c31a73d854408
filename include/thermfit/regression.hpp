#pragma once

/// From batches to models: what fits, chooses points, predicts, and says what a model leaves (S).
///
/// Templates on the scalar throughout; what is not used costs next to nothing to include.

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/campaign_card.hpp"
#include "thermfit/batch/error_reference.hpp"
#include "thermfit/batch/joined.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/features/feature.hpp"
#include "thermfit/features/lag.hpp"
#include "thermfit/fit/batch_levels.hpp"
#include "thermfit/fit/block_ridge.hpp"
#include "thermfit/fit/fit.hpp"
#include "thermfit/fit/jackknife.hpp"
#include "thermfit/fit/left_out.hpp"
#include "thermfit/fit/residuals.hpp"
#include "thermfit/fit/ridge_penalty.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/fit/training_domain.hpp"
#include "thermfit/fit/transfer.hpp"
#include "thermfit/model/linear_model.hpp"
#include "thermfit/model/outside_domain.hpp"
#include "thermfit/model/predict.hpp"
#include "thermfit/model/probe_level.hpp"
#include "thermfit/moments/moments.hpp"
#include "thermfit/moments/observations.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"
#include "thermfit/select/rule.hpp"
