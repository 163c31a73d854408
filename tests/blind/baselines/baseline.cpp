/// thermfit_blind_baseline: four simple diagnoses with the document of the real one, to be scored beside it.
///   thermfit_blind_baseline largest-residual|greedy|black-box|chance machine.json BATCH.csv… --json [--without a,b]

#include <iostream>

#include "blind/generator/random.hpp"
#include "linear_gap.hpp"

namespace {

using blind::LinearFit;
using blind::LinearGap;
using thermfit::Index;
using thermfit::Vector;
using Json = nlohmann::ordered_json;
using Added = thermfit::ThermalNetwork::AddedEffect;

Json entry(const Added& added, double confidence) {
  Json one{{"effect", added.effect}, {"location", added.location}, {"confidence", confidence}};
  if (!added.driver.empty()) one["driver"] = added.driver;
  return one;
}

Json gap_of(const LinearGap& gap, double with_effect) {
  const double calibrated = gap.output_rms(LinearFit(gap, {}).held_out(gap, gap.residual));
  return {{"as_simulated", gap.output_rms(gap.as_simulated)},
          {"calibrated", calibrated},
          {"with_effect", with_effect < 0 ? calibrated : with_effect},
          {"shrink_percent", with_effect < 0 || calibrated == 0 ? 0 : 100 * (1 - with_effect / calibrated)}};
}

std::vector<Added> candidates(const LinearGap& gap, const std::vector<std::string>& without) {
  std::vector<Added> kept;
  for (const Added& added : gap.library.candidates(gap.setting))
    if (std::find(without.begin(), without.end(), added.effect) == without.end()) kept.push_back(added);
  return kept;
}

/// The thermometer or displacement that is off most for its noise, and the effect there that looks most like it.
Json largest_residual(const LinearGap& gap, const std::vector<Added>& all) {
  std::vector<double> square(gap.channels.size(), 0);
  for (const blind::Piece& piece : gap.pieces)
    square[piece.channel] += gap.residual.segment(piece.first, piece.rows).squaredNorm();
  const auto worst = static_cast<std::size_t>(std::max_element(square.begin(), square.end()) - square.begin());
  const auto& channel = gap.channels[worst];
  std::string node;
  if (!channel.displacement) {
    const auto& sensor = gap.network.sensors[static_cast<std::size_t>(channel.column)];
    node = gap.network.nodes[static_cast<std::size_t>(sensor.node)].name;
  }
  const Added* best = nullptr;
  double closest = -1;
  Vector signature;
  for (const Added& added : all) {
    const bool near = channel.displacement ? added.location == "displacement" || added.location == channel.name
                                           : added.location == channel.name || added.location == node;
    if (!near) continue;
    const Vector shown = gap.signature(added);
    double along = 0, own = 0, seen = 0;
    for (const blind::Piece& piece : gap.pieces) {
      if (piece.channel != worst) continue;
      const auto a = shown.segment(piece.first, piece.rows), b = gap.residual.segment(piece.first, piece.rows);
      along += a.dot(b), own += a.squaredNorm(), seen += b.squaredNorm();
    }
    const double cosine = own > 0 && seen > 0 ? std::abs(along) / std::sqrt(own * seen) : 0;
    if (cosine > closest) closest = cosine, best = &added, signature = shown;
  }
  if (!best) return {{"verdict", "unknown"}, {"effects", Json::array()}, {"gap", gap_of(gap, -1)}};
  const Vector left = LinearFit(gap, {signature}).held_out(gap, gap.residual);
  return {{"verdict", "effect"},
          {"effects", Json::array({entry(*best, closest)})},
          {"gap", gap_of(gap, gap.output_rms(left))}};
}

/// Forward selection: the candidate with the greatest likelihood ratio under white noise, as long as it passes the
/// 5 % test of chi-square with one degree of freedom; three at most.
Json greedy(const LinearGap& gap, const std::vector<Added>& all) {
  const auto normal_of = [&](const LinearFit& fit) {
    thermfit::Matrix normal = fit.columns.transpose() * fit.columns;
    normal.diagonal() += fit.penalty;
    return normal;
  };
  std::vector<Vector> signatures;
  for (const Added& added : all) signatures.push_back(gap.signature(added));
  std::vector<Vector> chosen;
  Json found = Json::array();
  for (int step = 0; step < 3; ++step) {
    const LinearFit fit(gap, chosen);
    const Eigen::LDLT<thermfit::Matrix> solver(normal_of(fit));
    const auto left_of = [&](const Vector& values) {
      return Vector(values - fit.columns * solver.solve(fit.columns.transpose() * values));
    };
    const Vector left = left_of(gap.residual);
    const double rows = static_cast<double>(left.size()), before = left.squaredNorm();
    double best = 0;
    std::size_t which = all.size();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!signatures[i].allFinite() || signatures[i].squaredNorm() < 1e-12) continue;
      const Vector rest = left_of(signatures[i]);
      const double own = signatures[i].dot(rest);
      if (own < 1e-9 * signatures[i].squaredNorm()) continue;
      const double gained = std::pow(left.dot(signatures[i]), 2) / own;
      const double ratio = rows * std::log(before / std::max(before - gained, 1e-9 * before));
      if (ratio > best) best = ratio, which = i;
    }
    if (which == all.size() || best < 3.84) break;
    chosen.push_back(signatures[which]);
    found.push_back(entry(all[which], 1 - std::exp(-.5 * best)));
  }
  if (chosen.empty()) return {{"verdict", "miscalibration"}, {"effects", Json::array()}, {"gap", gap_of(gap, -1)}};
  const Vector left = LinearFit(gap, chosen).held_out(gap, gap.residual);
  return {{"verdict", "effect"}, {"effects", found}, {"gap", gap_of(gap, gap.output_rms(left))}};
}

/// The displacement's residual regressed on inputs and temperatures, batch by batch left out: a shrink without a name.
Json black_box(const LinearGap& gap) {
  const thermfit::Batch& first = gap.campaign.front();
  const Index inputs = first.inputs.count(), sensors = first.temperatures.count();
  const Index features = inputs + sensors + 2;
  LinearGap copy = gap;
  copy.jacobian = thermfit::Matrix::Zero(gap.residual.size(), features);
  for (const blind::Piece& piece : gap.pieces) {
    if (!gap.channels[piece.channel].displacement) continue;
    const thermfit::Batch& batch = gap.campaign[piece.batch];
    auto block = copy.jacobian.middleRows(piece.first, piece.rows);
    for (Index i = 0; i < inputs; ++i) {
      const double largest = std::max(1., batch.inputs.values.col(i).cwiseAbs().maxCoeff());
      block.col(i) = batch.inputs.values.col(i) / largest;
    }
    block.middleCols(inputs, sensors) = batch.temperatures.values.rowwise() - batch.temperatures.values.row(0);
    block.col(features - 2) = batch.time_s / 3600;
    block.col(features - 1).setOnes();
  }
  return {{"verdict", "unknown"},
          {"effects", Json::array()},
          {"gap", gap_of(gap, gap.output_rms(LinearFit(copy, {}).held_out(copy, gap.residual)))}};
}

Json chance(const LinearGap& gap, const std::vector<Added>& all) {
  std::uint64_t seed = 1;
  for (const auto& node : gap.network.nodes) seed = seed * 31 + static_cast<std::uint64_t>(node.capacity_J_per_K);
  blind::Random random(seed);
  std::vector<std::string> names;
  for (const Added& added : all)
    if (names.empty() || names.back() != added.effect) names.push_back(added.effect);
  const std::string name = random.pick(names);
  std::vector<Added> places;
  for (const Added& added : all)
    if (added.effect == name) places.push_back(added);
  return {{"verdict", "effect"},
          {"effects", Json::array({entry(random.pick(places), 1. / static_cast<double>(all.size()))})},
          {"gap", gap_of(gap, -1)}};
}

Json diagnose(const std::vector<std::string>& words) {
  std::vector<std::string> files, without;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "--json") continue;
    if (words[i] == "--without" && i + 1 < words.size()) {
      const std::string& list = words[++i];
      for (std::size_t at = 0; at <= list.size();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        without.push_back(list.substr(at, end - at));
        at = end + 1;
      }
    } else {
      files.push_back(words[i]);
    }
  }
  if (files.size() < 2)
    throw std::runtime_error("usage: thermfit_blind_baseline METHOD machine.json BATCH.csv… --json");
  const LinearGap gap(files[0], {files.begin() + 1, files.end()});
  const auto all = candidates(gap, without);
  if (words[0] == "largest-residual") return largest_residual(gap, all);
  if (words[0] == "greedy") return greedy(gap, all);
  if (words[0] == "black-box") return black_box(gap);
  if (words[0] == "chance") return chance(gap, all);
  throw std::runtime_error("no baseline '" + words[0] + "'");
}

}  // namespace

int main(int count, char** words) {
  try {
    std::cout << diagnose(std::vector<std::string>(words + 1, words + count)).dump(1) << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "thermfit_blind_baseline: " << error.what() << "\n";
    return 2;
  }
}
