#include "report/transfer_text.hpp"

#include <cmath>

#include "thermfit/number.hpp"

namespace thermfit::cli {

std::string in_words(const TransferPenalties<>& penalties, const std::vector<double>& lags_min) {
  const bool lag = std::isfinite(penalties.lag) && penalties.lag_index < lags_min.size();
  return (lag ? "lag " + exact_text(lags_min[penalties.lag_index]) + " min" : std::string("no lag")) +
         (std::isfinite(penalties.climate) ? ", with the climate" : ", no climate");
}

std::string in_words(const MeanAndStd<>& figure) {
  return "S_mean " + fixed_text(figure.S_mean, 2) + " um, S_std " + fixed_text(figure.S_std, 2) + " um";
}

}  // namespace thermfit::cli
