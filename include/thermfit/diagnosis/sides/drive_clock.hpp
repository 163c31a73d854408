#pragma once

/// A clock in another unit than was read.

#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/drive_weighing.hpp"

namespace thermfit::detail {

/// Seconds read as minutes and the like.
template <typename Scalar>
std::vector<DataProblem> drive_clock(const DriveWeighing<Scalar>& of) {
  for (const double factor : {60., 1000., 3600., 60000.})
    for (const bool longer : {true, false}) {
      Campaign otherwise = of.real();
      for (Batch& batch : otherwise) batch.time_s *= longer ? factor : 1 / factor;
      const std::vector<std::size_t> where = of.better(of.misfits(otherwise), .7);
      DataProblem problem;
      problem.kind = DataProblem::Kind::clock_unit;
      problem.figure = longer ? 1 / factor : factor;
      if (auto one = of.weigh(std::move(problem), otherwise, where)) return {std::move(*one)};
    }
  return {};
}

}  // namespace thermfit::detail
