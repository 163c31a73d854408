#pragma once

#include <cmath>
#include <random>

#include "thermfit/types.hpp"

/// Rows of temperatures and errors driven by a few heat sources: collinear, as on a machine.
struct ThermalRows {
  thermfit::Matrix temperatures, errors;

  /// `noise` in K and um; two sources; every point a mixture of them.
  ThermalRows(thermfit::Index rows, thermfit::Index points, thermfit::Index responses, unsigned seed, double noise = .1)
      : temperatures(rows, points), errors(rows, responses) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    for (thermfit::Index r = 0; r < rows; ++r) {
      const double hot = 5 * normal(generator), slow = 2 * normal(generator);
      for (thermfit::Index p = 0; p < points; ++p) {
        const double share = static_cast<double>(p) / static_cast<double>(points);
        temperatures(r, p) = 20 + (1 - share) * hot + share * slow + noise * normal(generator);
      }
      for (thermfit::Index e = 0; e < responses; ++e) {
        errors(r, e) = 3 * hot - (1 + static_cast<double>(e)) * slow + noise * normal(generator);
      }
    }
  }
};
