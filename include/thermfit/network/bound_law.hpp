#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "thermfit/network/moment.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Which column of the sensitivities belongs to a number; -1 where its sensitivity is not wanted.
using Column = Index;

/// A law together with the values, columns and difference steps of the parameters of the effect it belongs to.
struct BoundLaw {
  /// The parameters of one effect.
  struct Owner {
    std::vector<double> values;   ///< in the order of the law
    std::vector<double> steps;    ///< of their central differences
    std::vector<Column> columns;  ///< of their sensitivities
  };
  Law law;                ///< given the values of its owner
  std::size_t owner = 0;  ///< place in ThermalSystem::owners
};

/// Node and share of what enters it.
using Shares = std::vector<std::pair<Index, double>>;

}  // namespace thermfit
