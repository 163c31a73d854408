/// thermfit_blind_campaigns: makes blind cases from a seed. Usage in tests/blind/README.md.

#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

#include "case.hpp"
#include "thermfit/io/files/atomic_file.hpp"

namespace {

using blind::Card;

/// Sixty cases in balanced proportion; every deck has its own pairs and its own order.
std::vector<Card> deck(blind::Random random) {
  std::vector<Card> cards;
  std::vector<std::string> known, unknown;
  for (const auto& [name, law] : blind::known_effects()) known.push_back(name);
  for (const auto& [name, law] : blind::unknown_effects()) unknown.push_back(name);
  for (int i = 0; i < 8; ++i) cards.push_back({});
  for (int i = 0; i < 8; ++i) cards.push_back({{}, true});
  for (const std::string& name : known) cards.push_back({{name}});
  for (int i = 0; i < 3; ++i) cards.push_back({{random.pick(known)}});
  random.shuffle(unknown);
  for (std::size_t i = 0; i < 6; ++i) cards.push_back({{unknown[i]}});

  const std::vector<std::string> heat{"heat-source",  "friction-law",       "coolant",       "forced-convection",
                                      "missing-link", "natural-convection", "thermal-memory"};
  const std::vector<std::string> other{"speed-shift",       "hysteresis",    "sensor-offset",   "sensor-gain",
                                       "sensor-lag",        "sensor-drift",  "probe-drift",     "clock-offset",
                                       "missing-expansion", "ambient-drift", "initial-gradient"};
  for (int i = 0; i < 5; ++i) cards.push_back({{random.pick(heat), random.pick(other)}});
  const std::vector<std::string> distinct{"heat-source",    "friction-law",      "coolant",           "missing-link",
                                          "thermal-memory", "clock-offset",      "hysteresis",        "speed-shift",
                                          "sensor-lag",     "missing-expansion", "natural-convection"};
  for (int i = 0; i < 5; ++i) cards.push_back({{random.pick(distinct)}, false, true});
  const std::vector<std::string> hidden{"friction-law",      "speed-shift",    "forced-convection", "heat-source",
                                        "joint-conductance", "thermal-memory", "probe-drift",       "initial-gradient"};
  for (int i = 0; i < 3; ++i) cards.push_back({{random.pick(hidden)}, false, false, true});
  cards.push_back({{}, true, false, true});
  random.shuffle(cards);
  return cards;
}

Card card_of(std::uint64_t seed, std::uint64_t number) {
  const auto cards = deck(blind::Random(seed).fork(1u << 20).fork((number - 1) / 60));
  return cards[(number - 1) % cards.size()];
}

/// `none`, `miscalibration`, or effect names joined by `+`.
Card card_named(const std::string& text) {
  if (text == "none") return {};
  if (text == "miscalibration") return {{}, true};
  Card card;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('+', at), text.size());
    card.effects.push_back(text.substr(at, end - at));
    at = end + 1;
    if (!blind::known_effects().count(card.effects.back()) && !blind::unknown_effects().count(card.effects.back()))
      throw std::runtime_error("--effect: no effect '" + card.effects.back() + "'");
  }
  return card;
}

int make(const std::map<std::string, std::string>& given) {
  const auto number = [&](const char* name, std::uint64_t otherwise) {
    const auto it = given.find(name);
    if (it == given.end()) return otherwise;
    const auto value = thermfit::parse_number(it->second);
    if (!value || *value < 0 || *value != std::floor(*value))
      throw std::runtime_error(std::string(name) + ": not a count");
    return static_cast<std::uint64_t>(*value);
  };
  if (!given.count("--out")) throw std::runtime_error("--out DIR is needed");
  const std::uint64_t seed = number("--seed", 1), count = number("--count", 10), first = number("--first", 1);
  for (std::uint64_t n = first; n < first + count; ++n) {
    Card card = given.count("--effect") ? card_named(given.at("--effect")) : card_of(seed, n);
    if (given.count("--remove")) card.removed = true;
    if (given.count("--poor")) card.poor = true;
    const blind::Case made = blind::make_case(seed, n, card);
    const std::string digits = std::to_string(n);
    const std::filesystem::path folder = std::filesystem::path(given.at("--out")) /
                                         (std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits);
    for (const char* part : {"real", "fresh"}) std::filesystem::create_directories(folder / part);
    for (const auto& [file, text] : made.batches) thermfit::write_atomically((folder / file).string(), text);
    thermfit::write_atomically((folder / "machine.json").string(), made.machine.dump(1) + "\n");
    thermfit::write_atomically((folder / "truth.json").string(), made.truth.dump(1) + "\n");
  }
  return 0;
}

}  // namespace

int main(int count, char** words) {
  std::map<std::string, std::string> given;
  try {
    for (int i = 1; i < count; ++i) {
      const std::string word = words[i];
      if (word == "--remove" || word == "--poor")
        given[word] = "";
      else if (word.rfind("--", 0) == 0 && i + 1 < count)
        given[word] = words[++i];
      else
        throw std::runtime_error("not understood: " + word);
    }
    return make(given);
  } catch (const std::exception& error) {
    std::cerr << "thermfit_blind_campaigns: " << error.what() << "\n";
    return 2;
  }
}
