#include "report/calibration_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/table.hpp"
#include "thermfit/number.hpp"
#include "thermfit/statistics/rms.hpp"

namespace thermfit::cli {
namespace {

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

void print_calibration(const Calibration& calibration, const MachineRecord& seen, bool all, Console& console) {
  console.line(std::to_string(seen.batches()) + (seen.batches() == 1 ? " batch, " : " batches, ") +
               std::to_string(seen.channels.size()) + " channels, " +
               std::to_string(calibration.fit.parameters.size()) + " parameters");
  print_channels(calibration, seen, console);
  console.line();
  console.line(all ? "Parameters (moved: in prior standard deviations)"
                   : "What moved most (in prior standard deviations; --all shows every parameter)");
  print_parameters(calibration, all, console);
  console.line();
  print_unknown(calibration, console);
  const std::size_t starts = calibration.log_posteriors.size();
  if (starts > 1)
    console.line(std::to_string(calibration.agreeing) + " of " + std::to_string(starts) +
                 " starts ended in the same optimum.");
  if (!calibration.fit.converged) console.line("Not converged: the values above are where it stopped, not an optimum.");
}

}  // namespace thermfit::cli
