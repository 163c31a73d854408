#include "report/calibration_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/table.hpp"
#include "report/fitted_batches_text.hpp"
#include "thermfit/calibration/fitted_batches.hpp"
#include "thermfit/number.hpp"
#include "thermfit/statistics/rms.hpp"

namespace thermfit::cli {
namespace {

/// Reasons told before the rest is only counted.
constexpr std::size_t most_reasons = 6;

const Parameter& parameter(const Calibration& calibration, std::size_t j) { return calibration.fit.parameters[j]; }

void print_channels(const Calibration& calibration, const MachineRecord& seen, Console& console) {
  Table table({"channel", "unit", "rms before", "rms after", "noise"});
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    const ObservedChannel& channel = seen.channels[c];
    table.add({channel.name, channel.displacement ? "um" : "K", general_text(rms_of(calibration.residual_before[c]), 3),
               general_text(rms_of(calibration.fit.residual[c]), 3), general_text(channel.floor, 3)});
  }
  console.print(table.text(2));
}

void print_parameters(const Calibration& calibration, bool all, Console& console) {
  std::vector<std::size_t> order(calibration.fit.parameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!all) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::abs(calibrated(calibration, a).moved) > std::abs(calibrated(calibration, b).moved);
    });
    order.erase(
        std::remove_if(order.begin(), order.end(), [&](std::size_t j) { return parameter(calibration, j).of_batch(); }),
        order.end());
    const auto still = [&](std::size_t j) { return std::abs(calibrated(calibration, j).moved) < 0.5; };
    order.erase(std::find_if(order.begin(), order.end(), still), order.end());
    if (order.size() > 20) order.resize(20);
  }
  if (order.empty()) return console.line("  Nothing moved by half a prior standard deviation or more.");
  std::vector<std::string> header{"parameter", "from", "to", "moved"};
  if (all) header.insert(header.begin() + 3, "+-");
  Table table(header);
  for (const std::size_t j : order) {
    const auto [one, moved, value, standard_error] = calibrated(calibration, j);
    const std::string to = general_text(value, 4);
    std::vector<std::string> row{one.name, general_text(one.mean, 4), one.unit.empty() ? to : to + ' ' + one.unit,
                                 fixed_text(moved, 1)};
    if (all) row.insert(row.begin() + 3, general_text(standard_error, 2));
    table.add(row);
  }
  console.print(table.text(2));
}

void print_unknown(const Calibration& calibration, Console& console) {
  std::string not_pinned, bounded;
  std::vector<std::string> pairs;
  for (std::size_t j = 0; j < calibration.identified.size(); ++j) {
    const Identified& one = calibration.identified[j];
    if (parameter(calibration, j).of_batch()) continue;
    const std::string& name = parameter(calibration, j).name;
    if (one.at_bound) bounded += (bounded.empty() ? "" : ", ") + name;
    if (!one.pinned()) {
      not_pinned += (not_pinned.empty() ? "" : ", ") + name;
    } else if (one.trades_with > static_cast<Index>(j) ||
               (one.trades_with >= 0 && calibration.identified[static_cast<std::size_t>(one.trades_with)].trades_with !=
                                            static_cast<Index>(j))) {
      pairs.push_back(name + " against " + parameter(calibration, static_cast<std::size_t>(one.trades_with)).name +
                      " (correlation " + fixed_text(one.correlation, 2) + ")");
    }
  }
  const auto paragraph = [&](const std::string& text) { console.print(wrap(text, 80, 2)); };
  if (!not_pinned.empty()) paragraph("Not pinned by these data, left near what was known before: " + not_pinned + ".");
  if (!pairs.empty()) {
    console.line("Known only together:");
    for (const std::string& pair : pairs) console.print(wrap("  " + pair, 80, 4));
  }
  if (!bounded.empty()) paragraph("At a bound: " + bounded + ".");
}

}  // namespace

CalibratedParameter calibrated(const Calibration& calibration, std::size_t j) {
  const Parameter& parameter = calibration.fit.parameters[j];
  const double moved = calibration.fit.coordinates(static_cast<Index>(j));
  return {parameter, moved, parameter.value(moved), calibration.identified[j].sd * parameter.slope(moved)};
}

std::string identified_in_words(const Calibration& calibration, std::size_t j) {
  const Identified& one = calibration.identified[j];
  std::string words = one.pinned() ? "pinned" : "not pinned by these data";
  if (one.trades_with >= 0)
    words += "; trades off with " + parameter(calibration, static_cast<std::size_t>(one.trades_with)).name;
  if (one.at_bound) words += "; at its bound";
  return words;
}

bool CalibrationVerdict::failed() const {
  return std::any_of(shortcomings.begin(), shortcomings.end(),
                     [](const Shortcoming& one) { return one.kind != Shortcoming::Kind::not_pinned; });
}

bool CalibrationVerdict::spoilt() const {
  return std::any_of(shortcomings.begin(), shortcomings.end(), [](const Shortcoming& one) { return one.spoils(); });
}

std::string shortcoming_in_words(const Shortcoming& one) {
  using Kind = Shortcoming::Kind;
  const std::string value = general_text(one.value, 3) + (one.unit.empty() ? "" : " " + one.unit);
  const std::string sds = fixed_text(std::abs(one.sds), 1) + " prior standard deviations";
  switch (one.kind) {
    case Kind::not_better:
      return "it fits no better than the machine as given (" + general_text(one.before, 3) +
             " times what noise excuses "
             "before, " +
             general_text(one.value, 3) + " times after)";
    case Kind::misfit:
      return one.name + " is still off by " + value + " rms, " + general_text(one.before, 2) +
             " times what noise and lumping excuse: no parameter closes that";
    case Kind::beyond_belief:
      return one.name + " went from " + general_text(one.before, 3) + " to " + value + ", " + sds + ": beyond belief";
    case Kind::at_bound:
      return one.name + " stands at its bound, " + value;
    case Kind::not_pinned:
      return one.name + " moved by " + sds + " although these data do not pin it";
  }
  return {};
}

std::string suspect_in_words(const ThermalNetwork::AddedEffect& one) {
  const std::string at = one.location.empty() ? "" : " at " + one.location;
  if (one.effect == "missing-link") return "a link " + one.location;
  if (one.effect == "thermal-memory") return "a node (a hidden mass)" + at;
  if (one.effect == "heat-source" && one.driver == "constant")
    return "a second boundary or a constant heat" + at + " (a wall, a floor, a neighbour of another temperature)";
  if (one.effect == "heat-source") return "heat" + at + " driven by " + one.driver;
  if (one.effect == "ambient-drift") return "the course of the room, which is no column";
  if (one.effect == "initial-gradient")
    return "a start other than the machine file says" + at + " (\"initial\": \"fitted\")";
  return one.effect + at + (one.driver.empty() ? "" : " driven by " + one.driver);
}

void print_calibration(const Calibration& calibration, const MachineRecord& seen, const CalibrationVerdict& verdict,
                       bool all, Console& console) {
  if (verdict.failed()) {
    console.line("The calibration failed:");
    std::size_t told = 0;
    for (const Shortcoming& one : verdict.shortcomings)
      if (told < most_reasons) {
        console.print(wrap(" - " + shortcoming_in_words(one), 80, 3));
        ++told;
      }
    if (verdict.shortcomings.size() > told)
      console.line(" - " + std::to_string(verdict.shortcomings.size() - told) + " more: --json lists them");
    if (!verdict.suspects.empty()) {
      std::string lacks;
      for (const ThermalNetwork::AddedEffect& one : verdict.suspects)
        lacks += (lacks.empty() ? "" : "; or ") + suspect_in_words(one);
      console.print(wrap("The machine may lack " + lacks + ". `thermfit diagnose` weighs them.", 80, 0));
    }
    console.line();
  }
  console.line(std::to_string(seen.batches()) + (seen.batches() == 1 ? " batch, " : " batches, ") +
               std::to_string(seen.channels.size()) + (seen.channels.size() == 1 ? " channel, " : " channels, ") +
               std::to_string(std::count_if(calibration.fit.parameters.begin(), calibration.fit.parameters.end(),
                                            [](const Parameter& one) { return !one.of_batch(); })) +
               " parameters");
  print_channels(calibration, seen, console);
  console.line();
  console.line(all ? "Parameters (moved: in prior standard deviations)"
                   : "What moved most (in prior standard deviations; --all shows every parameter)");
  print_parameters(calibration, all, console);
  console.line();
  print_unknown(calibration, console);
  const std::string batches = fitted_batches_text(fitted_batches(calibration.fit, seen));
  if (!batches.empty()) console.print('\n' + batches);
  const std::size_t starts = calibration.log_posteriors.size();
  if (starts > 1)
    console.line(std::to_string(calibration.agreeing) + " of " + std::to_string(starts) +
                 " starts ended in the same optimum.");
  if (!calibration.fit.converged) console.line("Not converged: the values above are where it stopped, not an optimum.");
}

}  // namespace thermfit::cli
