/// Fits how probable it is that the nearest account of a gap is its cause, given how much it closes and leaves: where
/// the numbers of JudgingOptions come from.

#include <Eigen/Dense>
#include <cstdio>
#include <exception>
#include <iostream>

#include "mark.hpp"

namespace {

struct Row {
  std::string name, said;
  Eigen::Vector2d features;  ///< share closed, -log(1 + left)
  bool right;
};

/// Cases with one true cause, or one that is outside the catalogue, whose evidence outweighs the search.
void collect(const std::filesystem::path& results, const std::filesystem::path& cases, double power,
             std::vector<Row>& rows) {
  for (const blind::Case& one : blind::find_cases(cases)) {
    const bool outside = one.truth.verdict == "unknown";
    if (!outside && one.truth.effects.size() != 1) continue;
    const auto path = results / (one.name + ".json");
    if (!std::filesystem::exists(path)) continue;
    const blind::Json grounds = blind::read_json(path).at("grounds");
    if (grounds.at("nearest").size() != 1) continue;
    const double odds =
        power * grounds.at("gain_nats").get<double>() - std::log(grounds.at("candidates").get<double>());
    if (odds < 0) continue;
    const blind::Json& nearest = grounds["nearest"][0];
    const bool right = !outside && blind::names_effect(nearest, one.truth.effects[0]);
    rows.push_back({cases.filename().string() + "/" + one.name + " " + one.truth.family,
                    nearest.at("effect").get<std::string>() + " @ " + nearest.at("location").get<std::string>(),
                    {grounds.at("closes").get<double>(), -std::log1p(grounds.at("leaves").get<double>())},
                    right});
  }
}

/// Logistic regression with an intercept and a little ridge on all three, by Newton's method; `left_out` takes no part.
Eigen::Vector3d fitted(const std::vector<Row>& rows, std::size_t left_out) {
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  for (int step = 0; step < 50; ++step) {
    Eigen::Matrix3d curvature = 0.1 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d slope = -0.1 * weights;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i == left_out) continue;
      const Eigen::Vector3d x(1, rows[i].features[0], rows[i].features[1]);
      const double p = 1 / (1 + std::exp(-weights.dot(x)));
      slope += ((rows[i].right ? 1 : 0) - p) * x;
      curvature += p * (1 - p) * x * x.transpose();
    }
    weights += curvature.ldlt().solve(slope);
  }
  return weights;
}

}  // namespace

int main(int count, char** words) {
  if (count < 4 || count % 2 != 0) {
    std::cerr << "usage: thermfit_blind_known EVIDENCE_POWER RESULTS CASES [RESULTS CASES …]\n";
    return 2;
  }
  try {
    std::vector<Row> rows;
    for (int i = 2; i + 1 < count; i += 2) collect(words[i], words[i + 1], std::stod(words[1]), rows);
    double brier = 0;
    int confident_wrong = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Eigen::Vector3d without = fitted(rows, i);
      const double p = 1 / (1 + std::exp(-without[0] - without.tail<2>().dot(rows[i].features)));
      brier += std::pow(p - (rows[i].right ? 1 : 0), 2);
      confident_wrong += !rows[i].right && p > .5;
      std::printf("%s  closes %.2f  left %.2f  probability %.2f  %s: %s\n", rows[i].right ? "right" : "wrong",
                  rows[i].features[0], std::expm1(-rows[i].features[1]), p, rows[i].name.c_str(), rows[i].said.c_str());
    }
    const Eigen::Vector3d weights = fitted(rows, rows.size());
    std::printf("%zu accounts; each left out once: Brier %.3f, %d wrong above one half\n", rows.size(),
                brier / static_cast<double>(rows.size()), confident_wrong);
    std::printf("log odds = %.2f + %.2f share - %.2f log(1 + left)\n", weights[0], weights[1], weights[2]);
  } catch (const std::exception& error) {
    std::cerr << "thermfit_blind_known: " << error.what() << "\n";
    return 2;
  }
}
