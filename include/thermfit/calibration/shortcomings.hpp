#pragma once

/// What says that a calibration failed: numbers for a report that begins with them.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/calibrate.hpp"
#include "thermfit/calibration/misfit.hpp"

namespace thermfit {

/// When a calibration is none.
struct ShortcomingLimits {
  double no_better = .98;        ///< misfit after over before, where there was one
  double misfit_expected = 5;    ///< rms of a channel over what is expected of a right machine
  double beyond_belief_sds = 4;  ///< a parameter that moved further, in prior standard deviations
  double not_pinned_sds = 2;     ///< one that moved further and that the data do not know
};

/// One reason why a calibrated machine is not to be believed.
struct Shortcoming {
  /// Which.
  enum class Kind {
    not_better,     ///< it fits no better than the machine as given: `value` after, `before`: rms over expectation
    misfit,         ///< channel `name` is off by `value`, `before` times what noise and lumping excuse
    beyond_belief,  ///< parameter `name` moved to `value`, by `sds` prior standard deviations
    at_bound,       ///< parameter `name` would go further than `value` if it were allowed
    not_pinned      ///< parameter `name` moved by `sds`, although the data do not know it
  };
  Kind kind = Kind::misfit;  ///< says which of the others are filled
  std::string name;          ///< of a channel or a parameter
  std::string unit;          ///< of `value`
  double value = 0;          ///< see Kind
  double before = 0;         ///< see Kind
  double sds = 0;            ///< signed, prior standard deviations

  /// Whether a machine with it must not replace the one given.
  bool spoils() const { return kind == Kind::not_better || kind == Kind::beyond_belief || kind == Kind::at_bound; }
};

/// Why `calibration` failed, worst kind first; nothing where it did not. Allocates.
template <typename Scalar = double>
std::vector<Shortcoming> shortcomings(const Calibration& calibration, const MachineRecord& seen,
                                      const ShortcomingLimits& limits = {}) {
  using Kind = Shortcoming::Kind;
  std::vector<Shortcoming> result;
  const VectorX<Scalar> before = misfit_of<Scalar>(seen, calibration.residual_before),
                        after = misfit_of<Scalar>(seen, calibration.fit.residual);
  const double channels = static_cast<double>(std::max<Index>(1, after.size()));
  const double was = std::sqrt(before.sum() / channels), is = std::sqrt(after.sum() / channels);
  if (was > 2 && is > limits.no_better * was) result.push_back({Kind::not_better, "", "", is, was, 0});
  std::vector<Shortcoming> misfits;
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    if (const double times = std::sqrt(after(static_cast<Index>(c))); times > limits.misfit_expected)
      misfits.push_back({Kind::misfit, seen.channels[c].name, seen.channels[c].displacement ? "um" : "K",
                         rms_of(calibration.fit.residual[c]), times, 0});
  std::stable_sort(misfits.begin(), misfits.end(),
                   [](const Shortcoming& a, const Shortcoming& b) { return a.before > b.before; });
  std::vector<Shortcoming> moved;
  for (Index j = 0; j < calibration.fit.coordinates.size(); ++j) {
    const Parameter& one = calibration.fit.parameter(j);
    const Identified& known = calibration.identified[static_cast<std::size_t>(j)];
    const double sds = calibration.fit.coordinates(j);
    if (one.kind == Parameter::Kind::start || one.kind == Parameter::Kind::effect || one.of_batch()) continue;
    const Kind kind = known.at_bound                             ? Kind::at_bound
                      : std::abs(sds) > limits.beyond_belief_sds ? Kind::beyond_belief
                                                                 : Kind::not_pinned;
    if (kind == Kind::not_pinned && (known.pinned() || std::abs(sds) < limits.not_pinned_sds)) continue;
    moved.push_back({kind, one.name, one.unit, one.value(sds), one.mean, sds});
  }
  std::stable_sort(moved.begin(), moved.end(), [](const Shortcoming& a, const Shortcoming& b) {
    return a.spoils() != b.spoils() ? a.spoils() : std::abs(a.sds) > std::abs(b.sds);
  });
  for (auto* more : {&misfits, &moved})
    for (Shortcoming& one : *more) result.push_back(std::move(one));
  return result;
}

}  // namespace thermfit
