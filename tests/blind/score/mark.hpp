#pragma once

/// One diagnosis held against the truth.

#include <cmath>
#include <optional>

#include "fresh.hpp"
#include "truth.hpp"

namespace blind {

struct Claim {
  double confidence;
  bool right;
};

struct Mark {
  bool failed = false;  ///< no document: crash, time out, refusal
  std::string verdict, said;
  bool verdict_right = false;
  bool named = false;             ///< any effect is named
  bool top = false;               ///< every true effect is named first (or as one of the found)
  bool in_set = false;            ///< every true effect is among what is named, alternatives included
  bool within = false;            ///< the same with parts of the cause and suspicions
  bool place = false;             ///< and at an acceptable place, or a declared set that holds one
  bool confident_wrong = false;   ///< a name that is not true, stated above 50 %
  std::vector<Claim> claims;      ///< of names
  std::vector<Claim> suspicions;  ///< of parts of the cause and suspicions; right: the name
  double calibrated = NAN, with_effect = NAN, shrink_percent = NAN;
  std::optional<std::pair<double, double>> interval;
  double oracle_shrink_percent = NAN, seconds = NAN;
  std::optional<MeasuredShrink> fresh;  ///< on batches that the diagnosis has not seen
};

inline bool holds(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

/// `a, b` and `a+b` count when each part is acceptable; a link may be given from either end.
inline bool acceptable(const std::vector<std::string>& accepted, const std::string& place) {
  if (holds(accepted, place)) return true;
  const auto cut = place.find_first_of(",+");
  if (cut == std::string::npos) return false;
  const auto rest = place.find_first_not_of(" ", cut + 1);
  return rest != std::string::npos && acceptable(accepted, place.substr(0, cut)) &&
         acceptable(accepted, place.substr(rest));
}

inline double number_or_nan(const Json& object, const char* key) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : NAN;
}

/// Effect and place of one reported entry, with the places it declares equal.
inline bool names_effect(const Json& entry, const TrueEffect& truth) {
  return holds(truth.names, entry.value("effect", ""));
}

inline bool names_place(const Json& entry, const TrueEffect& truth) {
  if (acceptable(truth.locations, entry.value("location", ""))) return true;
  if (entry.contains("same_place"))
    for (const Json& place : entry["same_place"])
      if (acceptable(truth.locations, place.get<std::string>())) return true;
  return false;
}

inline Mark mark(const Truth& truth, const Json& document) {
  Mark mark;
  mark.verdict = document.at("verdict");
  const bool names = mark.verdict == "effect" || mark.verdict == "ambiguous";
  const Json found = names ? document.value("effects", Json::array()) : Json::array();
  mark.named = !found.empty();
  for (const Json& one : found)
    mark.said += (mark.said.empty() ? "" : " + ") + one.value("effect", "") + " @ " + one.value("location", "");
  mark.verdict_right = truth.verdict == "effect" ? names : mark.verdict == truth.verdict;

  mark.top = mark.in_set = mark.place = !truth.effects.empty();
  for (const TrueEffect& effect : truth.effects) {
    // A single effect must come first; of a pair either may.
    const std::size_t leading = std::min(truth.effects.size(), found.size());
    bool top = false, in_set = false, place = false;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (names_effect(found[i], effect)) {
        top = top || i < leading;
        in_set = true;
        place = place || names_place(found[i], effect);
      }
      for (const Json& rival : found[i].value("alternatives", Json::array())) {
        if (!names_effect(rival, effect)) continue;
        in_set = true;
        place = place || names_place(rival, effect);
      }
    }
    mark.top = mark.top && top;
    mark.in_set = mark.in_set && in_set;
    mark.place = mark.place && place;
  }
  mark.within = !truth.effects.empty();
  for (const TrueEffect& effect : truth.effects) {
    bool told = false;
    for (const char* grade : {"effects", "parts", "suspected"})
      for (const Json& one : document.value(grade, Json::array())) {
        told = told || names_effect(one, effect);
        for (const Json& rival : one.value("alternatives", Json::array())) told = told || names_effect(rival, effect);
      }
    mark.within = mark.within && told;
  }
  for (const char* grade : {"parts", "suspected"})
    for (const Json& one : document.value(grade, Json::array()))
      mark.suspicions.push_back({one.value("confidence", 0.),
                                 std::any_of(truth.effects.begin(), truth.effects.end(),
                                             [&](const TrueEffect& effect) { return names_effect(one, effect); })});
  for (const Json& one : found) {
    const auto fits = [&](const TrueEffect& effect) { return names_effect(one, effect); };
    const auto fits_there = [&](const TrueEffect& effect) { return fits(effect) && names_place(one, effect); };
    const double confidence = one.value("confidence", 0.);
    const bool true_name = std::any_of(truth.effects.begin(), truth.effects.end(), fits);
    mark.confident_wrong = mark.confident_wrong || (!true_name && confidence > .5);
    mark.claims.push_back({confidence, std::any_of(truth.effects.begin(), truth.effects.end(), fits_there)});
  }

  const Json gap = document.value("gap", Json::object());
  mark.calibrated = number_or_nan(gap, "calibrated");
  mark.with_effect = number_or_nan(gap, "with_effect");
  mark.shrink_percent = number_or_nan(gap, "shrink_percent");
  const Json interval = gap.value("shrink_ci95_percent", Json::array());
  if (interval.size() == 2 && interval[0].is_number() && interval[1].is_number())
    mark.interval = {interval[0].get<double>(), interval[1].get<double>()};
  return mark;
}

}  // namespace blind
