#pragma once

/// What a fit says of a single batch: where its parts started, and the room that nothing measured.

#include <string>
#include <vector>

namespace thermfit {

/// A number with its standard error.
struct FittedNumber {
  double value = 0;           ///< in the unit that its owner names
  double standard_error = 0;  ///< posterior
};

/// Numbers of one batch that no other batch can tell.
struct FittedBatch {
  std::string batch;                     ///< name
  std::vector<FittedNumber> start_degC;  ///< by node; empty where starts were not fitted
  bool room = false;                     ///< whether the room was
  FittedNumber room_degC;                ///< its mean over the batch
  FittedNumber room_drift_K;             ///< from the first to the last sample; 0 where a drift did not pay
};

}  // namespace thermfit
