#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "thermfit/moments/observations.hpp"

namespace thermfit {

/// A selection rule is anything that names the best temperature points of a batch:
///
///     std::vector<Index> rule(const Observations<Scalar>& batch, Index count);
///
/// It returns `count` different columns of the temperatures, best first, or fewer where it finds no more; the set for
/// one count need not contain that for a smaller one. ByCorrelation and ByFcgr are rules, and so is a lambda.
template <class Rule, typename Scalar = double>
inline constexpr bool is_selection_rule =
    std::is_invocable_r_v<std::vector<Index>, const Rule&, const Observations<Scalar>&, Index>;

/// The points `rule` names, checked: a wrong callable fails to compile with a sentence, a wrong column is an Error.
template <class Rule, typename Scalar>
std::vector<Index> select_points(const Rule& rule, const Observations<Scalar>& batch, Index count) {
  static_assert(is_selection_rule<Rule, Scalar>,
                "A selection rule is called as rule(const thermfit::Observations<Scalar>& batch, thermfit::Index "
                "count) and returns std::vector<thermfit::Index>, the chosen temperature columns, best first.");
  const std::vector<Index> points = rule(batch, count);
  std::vector<bool> seen(static_cast<std::size_t>(batch.moments.temperatures()), false);
  for (const Index point : points) {
    if (point < 0 || point >= batch.moments.temperatures() || seen[static_cast<std::size_t>(point)]) {
      throw Error("selection rule", "point " + std::to_string(point),
                  "different columns from 0 to " + std::to_string(batch.moments.temperatures() - 1));
    }
    seen[static_cast<std::size_t>(point)] = true;
  }
  return points;
}

}  // namespace thermfit
