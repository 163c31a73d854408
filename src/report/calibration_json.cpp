#include "report/calibration_json.hpp"

#include <nlohmann/json.hpp>

#include "report/fitted_batches_json.hpp"
#include "thermfit/calibration/fitted_batches.hpp"

namespace thermfit::cli {

using Json = nlohmann::ordered_json;

std::string calibration_json(const Calibration& calibration, const MachineRecord& seen,
                             const CalibrationVerdict& verdict) {
  Json document{{"format", "thermfit-calibration/1"},
                {"machine", calibration.fit.prior.name},
                {"batches", seen.names},
                {"converged", calibration.fit.converged},
                {"iterations", calibration.fit.iterations},
                {"starts", calibration.log_posteriors.size()},
                {"agreeing_starts", calibration.agreeing},
                {"log_posterior", calibration.fit.log_posterior}};
  document["failed"] = verdict.failed();
  Json& shortcomings = document["shortcomings"] = Json::array();
  for (const Shortcoming& one : verdict.shortcomings) shortcomings.push_back(shortcoming_in_words(one));
  Json& suspects = document["suspects"] = Json::array();
  for (const ThermalNetwork::AddedEffect& one : verdict.suspects)
    suspects.push_back({{"effect", one.effect}, {"location", one.location}, {"driver", one.driver}});
  Json& channels = document["channels"] = Json::array();
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    channels.push_back({{"channel", seen.channels[c].name},
                        {"unit", seen.channels[c].displacement ? "um" : "K"},
                        {"rms_before", rms_of(calibration.residual_before[c])},
                        {"rms_after", rms_of(calibration.fit.residual[c])},
                        {"noise", seen.channels[c].floor}});
  Json& parameters = document["parameters"] = Json::array();
  for (std::size_t j = 0; j < calibration.fit.parameters.size(); ++j) {
    const auto [one, moved, value, standard_error] = calibrated(calibration, j);
    const Identified& known = calibration.identified[j];
    if (one.of_batch()) continue;
    parameters.push_back(
        {{"parameter", one.name},
         {"unit", one.unit},
         {"from", one.mean},
         {"to", value},
         {"standard_error", standard_error},
         {"moved_prior_sds", moved},
         {"posterior_over_prior_sd", known.sd},
         {"pinned", known.pinned()},
         {"trades_with", known.trades_with < 0
                             ? Json(nullptr)
                             : Json(calibration.fit.parameters[static_cast<std::size_t>(known.trades_with)].name)},
         {"correlation", known.trades_with < 0 ? Json(nullptr) : Json(known.correlation)},
         {"at_bound", known.at_bound},
         {"in_words", identified_in_words(calibration, j)}});
  }
  const std::vector<FittedBatch> batches = fitted_batches(calibration.fit, seen);
  if (!batches.empty()) document["of_batches"] = fitted_batches_json<Json>(batches, calibration.fit.prior);
  return document.dump(1) + '\n';
}

}  // namespace thermfit::cli
