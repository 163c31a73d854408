#include "report/model_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cli/table.hpp"
#include "options/error_reference.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

void print_points(const TrainedModel& m, Console& console) {
  std::vector<std::string> header{"point"};
  for (const std::string& error : m.errors) header.push_back(error + " um/K");
  for (const std::string& error : m.errors) header.push_back(error + " std.");
  for (const char* name : {"mean", "sd", "lowest", "highest"}) header.emplace_back(name);
  const bool latent = m.latent.vip.size() > 0;
  if (latent) header.emplace_back("VIP");
  Table table(header);
  for (Index i = 0; i < m.model.sensors(); ++i) {
    std::vector<std::string> row{m.input_name(i)};
    for (Index j = 0; j < m.model.errors(); ++j) row.push_back(fixed_text(m.model.coefficients(i, j), 3));
    for (Index j = 0; j < m.model.errors(); ++j) row.push_back(fixed_text(m.standardised_coefficients(i, j), 3));
    row.push_back(fixed_text(m.temperature_mean(i), 2));
    row.push_back(fixed_text(m.temperature_scale(i), 2));
    row.push_back(fixed_text(m.domain.lowest(i), 1));
    row.push_back(fixed_text(m.domain.highest(i), 1));
    if (latent) row.push_back(fixed_text(m.latent.vip(i), 2));
    table.add(row);
  }
  console.print(table.text(2));
}

/// What the method transfer chose, and the climates it knows.
void print_blocks(const TrainedModel& m, Console& console) {
  if (m.blocks.empty()) return;
  const auto penalty = [](const char* block, double value) {
    return std::string(block) + (std::isfinite(value) ? " " + general_text(value, 3) : " none");
  };
  const auto extra = [&](const char* block, double value) {
    return std::isfinite(value) ? ", " + penalty(block, value) : std::string();
  };
  bool climate = false;
  for (std::size_t e = 0; e < m.blocks.size(); ++e) {
    const TransferRecord& r = m.blocks[e];
    climate = climate || std::isfinite(r.climate_penalty);
    console.print(
        wrap("  " + m.errors[e] + ": penalties chosen by leaving batches out: " + penalty("rise", r.rise_penalty) +
                 ", " + penalty("lag", r.lag_penalty) + (r.lag_min > 0 ? " (" + exact_text(r.lag_min) + " min)" : "") +
                 ", " + penalty("climate", r.climate_penalty) + extra("input", r.input_penalty) +
                 extra("lagged input", r.input_lag_penalty) + extra("difference", r.difference_penalty),
             80, 4));
  }
  if (!m.known_inputs.empty())
    console.print(wrap("  known inputs, in um per unit of their column: " + name_list(m.known_inputs), 80, 4));
  if (climate)
    console.print(wrap("  climate: mean of the points where a batch starts, " + fixed_text(m.climate.lowest, 1) +
                           " to " + fixed_text(m.climate.highest, 1) + " degC in training and clipped to that, less " +
                           fixed_text(m.climate.mean, 2) + " degC",
                       80, 4));
  console.line();
}

void print_components(const TrainedModel& m, Console& console) {
  if (m.components == 0) return;
  Table table({"latent variable", "T explained", "error explained"});
  for (Index a = 0; a < m.components; ++a)
    table.add({std::to_string(a + 1), fixed_text(100 * m.latent.explained_temperature_variance(a), 2) + " %",
               fixed_text(100 * m.latent.explained_error_variance(a), 2) + " %"});
  console.line();
  console.print(table.text(2));
}

void print_substitutes(const TrainedModel& m, Console& console) {
  if (m.substitutes.empty()) return;
  console.line("\nIf one sensor is lost, a substitute on the others takes over:");
  std::vector<std::string> header{"lost"};
  for (const std::string& error : m.errors) header.push_back("S of " + error + ", um");
  Table table(header);
  const auto row = [&](const std::string& name, const Vector& deviation) {
    std::vector<std::string> cells{name};
    for (const double value : deviation) cells.push_back(m.degrees_of_freedom > 0 ? fixed_text(value, 2) : "-");
    table.add(cells);
  };
  row("none", m.residual_deviation_um);
  for (const SubstituteModel& substitute : m.substitutes)
    row(m.temperatures[static_cast<std::size_t>(substitute.lost)], substitute.residual_deviation_um);
  console.print(table.text(2));
}

/// What a model's intercept means where it is no probe's zero.
const char* intercept_in_words(const TrainedModel& m) {
  if (m.error_reference == ErrorReference::start && m.method == "transfer")
    return "The errors are 0 at rise 0, and so is the model.";
  return m.error_reference == ErrorReference::batch
             ? "The intercept is each batch's own: predictions are changes, 0 at rise 0, as the machine's corrections "
               "are since its datum."
             : "The errors are 0 at rise 0; the intercept is what the fit leaves there, and drops out at a datum, from "
               "which the machine's corrections count as these errors do from their start.";
}

}  // namespace

std::string reference_in_words(TemperatureReference reference) {
  return reference == TemperatureReference::rise ? "temperature rise since the first row of the batch, K"
                                                 : "temperature, degC";
}

std::string model_title(const TrainedModel& m) {
  std::string text = m.method == "transfer" ? "Transfer" : upper(m.method);
  if (m.components > 0)
    text += ", " + std::to_string(m.components) + " latent variable" + (m.components > 1 ? "s" : "");
  if (m.method == "ridge") text += ", lambda " + general_text(m.ridge_lambda, 4);
  text += ", on " + name_list(m.temperatures, 12);
  if (m.selection == "given") return text + " (as told)";
  if (m.selection == "all") return text + " (all points)";
  return text + " (chosen by " + m.selection + ")";
}

std::string model_equation(const TrainedModel& m, Index error) {
  const bool own = m.error_reference == ErrorReference::batch;
  std::string text = m.errors[static_cast<std::size_t>(error)] + " = " +
                     (own ? "own intercept" : fixed_text(m.model.intercept(error), 3));
  for (Index i = 0; i < m.model.sensors(); ++i) {
    const double c = m.model.coefficients(i, error);
    text += (c < 0 ? " - " : " + ") + fixed_text(c < 0 ? -c : c, 3) + ' ' + m.input_name(i);
  }
  return text;
}

void print_model(const TrainedModel& m, Console& console) {
  console.print(wrap(console.strong(model_title(m)), 80, 2));
  for (Index j = 0; j < m.model.errors(); ++j) console.print(wrap("  " + model_equation(m, j), 80, 6));
  const bool recorded = m.error_reference == ErrorReference::recorded;
  console.print(wrap(
      "  errors in um" + (recorded ? "" : ", " + in_words(m.error_reference)) + "; " + reference_in_words(m.reference),
      80, 2));
  if (!recorded) console.print(wrap(std::string("  ") + intercept_in_words(m), 80, 2));
  console.line();
  print_blocks(m, console);
  print_points(m, console);
  print_components(m, console);

  Index rows = 0;
  std::vector<std::string> names;
  for (const TrainingBatch& batch : m.batches) rows += batch.rows, names.push_back(batch.name);
  console.line();
  console.print(wrap(
      "Trained on " + std::to_string(rows) + " rows of " + name_list(names, 24) + "; residual standard " +
          "deviation S" +
          [&] {
            std::string text;
            for (Index j = 0; j < m.model.errors(); ++j)
              text += (j ? ", " : " ") + m.errors[static_cast<std::size_t>(j)] + ' ' +
                      (m.degrees_of_freedom > 0 ? fixed_text(m.residual_deviation_um(j), 2) + " um" : "-");
            return text;
          }() +
          (recorded ? "" : ", errors " + in_words(m.error_reference)) + ", " + std::to_string(m.degrees_of_freedom) +
          " degrees of freedom; condition number of the " + "standardised temperatures " +
          general_text(m.condition_number, 3) + ".",
      80, 2));
  console.print(wrap("A new sample is foreign to this model when T2 exceeds " + general_text(m.domain.t2_limit_95, 3) +
                         " (95 %) or " + general_text(m.domain.t2_limit_99, 3) + " (99 %)" +
                         (m.domain.spe_limit_99 > 0 ? ", or SPE " + general_text(m.domain.spe_limit_95, 3) + " or " +
                                                          general_text(m.domain.spe_limit_99, 3)
                                                    : std::string()) +
                         ".",
                     80, 2));
  print_substitutes(m, console);
}

}  // namespace thermfit::cli
