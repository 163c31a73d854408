#pragma once

/// A trained model in words.

#include <string>
#include <vector>

#include "cli/console.hpp"
#include "thermfit/model/trained_model.hpp"

namespace thermfit::cli {

/// "PLS, 1 latent variable, on T5, T1 (chosen by correlation)".
std::string model_title(const TrainedModel& model);

/// One line per response: "Z = 6.258 + 1.811 T5 + 1.773 T1".
std::string model_equation(const TrainedModel& model, Index error);

/// "temperature rise since the first row of the batch, K" or "temperature, degC".
std::string reference_in_words(TemperatureReference reference);

/// The whole model: equation, points, training, domain, substitutes.
void print_model(const TrainedModel& model, Console& console);

}  // namespace thermfit::cli
