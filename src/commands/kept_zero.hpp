#pragma once

#include <limits>
#include <string>
#include <vector>

#include "thermfit/controller/dynamic_row.hpp"
#include "thermfit/controller/retained_datum.hpp"

namespace thermfit::cli {

/// The zero of a state file `thermfit-datum/1`, and what there is to say of the file.
struct KeptZero {
  RetainedDatum<double, dynamic_size> zero;  ///< none where the file is missing, damaged, or another model's
  double time_s =
      std::numeric_limits<double>::quiet_NaN();  ///< the clock of the input when it was stored; NaN: not known
  std::string remark;                            ///< empty where it was read and taken
};

/// Reads the zero of the sensors `names` for the model of that identity, which has so many lags, -1: no features and no
/// session to remember. Never throws: a controller that comes back from a power cycle goes on without a zero, and says
/// so.
KeptZero read_zero(const std::string& path, const std::vector<std::string>& names, std::uint32_t model, int lags);

/// Stores a zero, of a model with features the session and the clock of the input too, so that a power cut leaves the
/// old file or the new one. Throws Error when it cannot be written.
void write_zero(const std::string& path, const std::vector<std::string>& names,
                const RetainedDatum<double, dynamic_size>& zero, bool session, double time_s);

}  // namespace thermfit::cli
