#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/features/lag.hpp"

/// A machine whose error follows rises, lagged rises and the climate, on days of different climate and course.
struct TransferMachine {
  double lag_min = 20;      ///< of its error
  double per_climate = .1;  ///< um/K^2 of the third point
  double noise_um = 0;      ///< of the probe
  double zero_um = 0;       ///< largest zero of the probe, another in every batch

  /// `batches` days of `rows` minutes with `points` (3 or more) thermometers and the error Z.
  thermfit::Campaign campaign(std::size_t batches, thermfit::Index rows = 150, thermfit::Index points = 4,
                              unsigned seed = 1) const {
    using namespace thermfit;
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) / 4294967296.;
    };
    const auto normal = [&] {  // Box and Muller: the same on every library
      return std::sqrt(-2 * std::log(uniform(1e-12, 1))) * std::cos(uniform(0, 6.283185307179586));
    };
    Campaign campaign;
    for (std::size_t b = 0; b < batches; ++b) {
      Batch batch;
      batch.name = "D" + std::to_string(b + 1);
      batch.time_s = Vector::LinSpaced(rows, 0, 60 * static_cast<double>(rows - 1));
      const double climate = uniform(5, 30);
      Matrix rise = Matrix::Zero(rows, points);
      for (Index p = 0; p < points; ++p) {
        batch.temperatures.names.push_back("T" + std::to_string(p + 1));
        double target = uniform(2, 12);
        for (Index r = 1; r < rows; ++r) {
          if (r % 40 == 0) target = uniform(0, 12);
          rise(r, p) = rise(r - 1, p) + (target - rise(r - 1, p)) / (8 + 6 * static_cast<double>(p)) + .02 * normal();
        }
      }
      batch.temperatures.values = rise.array() + climate;
      const Matrix x = lagged(rise, batch.time_s, 60 * lag_min);
      const double zero = uniform(-zero_um, zero_um);
      batch.errors.names = {"Z"};
      batch.errors.values.resize(rows, 1);
      for (Index r = 0; r < rows; ++r)
        batch.errors.values(r, 0) = zero + 2 * rise(r, 0) - 3 * x(r, 0) + 1.5 * x(r, 1) +
                                    per_climate * (climate - 17.5) * rise(r, 2) + noise_um * normal();
      campaign.push_back(std::move(batch));
    }
    return campaign;
  }
};
