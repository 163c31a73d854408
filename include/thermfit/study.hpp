#pragma once

/// How far models can be trusted on batches they were not made from: S across batches, leave-one-batch-out, and the
/// paper's whole comparison; with all of regression.hpp.

#include "thermfit/findings/finding_groups.hpp"
#include "thermfit/findings/leave_out.hpp"
#include "thermfit/regression.hpp"
#include "thermfit/robustness/cross_batch.hpp"
#include "thermfit/robustness/leave_one_batch_out.hpp"
#include "thermfit/robustness/robustness.hpp"
#include "thermfit/robustness/study.hpp"
#include "thermfit/robustness/transfer_left_out.hpp"
