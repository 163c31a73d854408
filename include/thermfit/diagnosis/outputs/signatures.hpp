#pragma once

/// The catalogue of effects as the traces they leave in paired outputs, where no network is known.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "thermfit/constants.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/outputs/calibration_basis.hpp"
#include "thermfit/network/effect.hpp"

namespace thermfit {

/// One effect at one place, with its shape parameter (a lag, a delay, an exponent) fixed: its regressors in each batch.
struct PairedSignature {
  std::string effect, location, driver;
  Stage stage = Stage::heat;
  std::vector<Index> channels;  ///< in which the regressors count, each with coefficients of its own
  Matrix columns;               ///< all batches below each other
  Estimate strength;            ///< name and unit of the coefficient of a single column, and its factor in `value`
  std::vector<Estimate> shape;  ///< what is fixed in this variant
  bool unit_strength = false;   ///< the coefficient is 1 by its law: the shape alone sets the size
  std::vector<std::pair<Index, int>> acts_on;  ///< where its heat flow acts, with the sign of the response (0: either)
};

namespace detail {

/// Builds the signatures of every effect at every place; `predicted` holds the calibrated displacement by batch.
class SignatureBuilder {
 public:
  SignatureBuilder(const PairedCampaign& campaign, double reference_degC, std::vector<std::vector<Vector>> predicted)
      : campaign_(campaign),
        reference_degC_(reference_degC),
        predicted_(std::move(predicted)),
        lags_s_(lag_ladder_s(campaign)) {}

  std::vector<PairedSignature> all() {
    readings();
    displacement();
    heat();
    boundary();
    conduction();
    return std::move(found_);
  }

 private:
  using Course = std::function<Vector(const PairedBatch&, std::size_t)>;

  /// One column in one channel.
  PairedSignature& single(const std::string& effect, const std::string& location, Stage stage, Index channel,
                          Estimate strength, const Course& course) {
    PairedSignature one{effect, location, "", stage, {channel}, {}, std::move(strength), {}, false, {}};
    one.columns.resize(campaign_.rows(), 1);
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b)
      campaign_.part(one.columns, b) = course(campaign_.batches[b], b);
    one.unit_strength = one.strength.name == "strength";
    found_.push_back(std::move(one));
    return found_.back();
  }

  /// A heat flow: its traces through the ladder of lags, in every channel.
  PairedSignature& spread(const std::string& effect, const std::string& location, Stage stage, const Course& flow,
                          const Course& second = {}) {
    PairedSignature one{effect, location, "", stage, {}, {}, {}, {}, false, {}};
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      const bool given = c < campaign_.temperatures && is_room(c);
      if (!given) one.channels.push_back(c);
    }
    one.columns.resize(campaign_.rows(), second ? 8 : 4);
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b) {
      const PairedBatch& batch = campaign_.batches[b];
      std::vector<Vector> flows{flow(batch, b)};
      if (second) flows.push_back(second(batch, b));
      Index at = 0;
      for (const Vector& one_flow : flows)
        for (std::size_t k = 0; k < 4; ++k)
          campaign_.part(one.columns, b).col(at++) = low_pass(batch.time_s, one_flow, lags_s_[k], 0);
    }
    found_.push_back(std::move(one));
    return found_.back();
  }

  const std::string& name(Index channel) const { return campaign_.channels[static_cast<std::size_t>(channel)]; }
  bool is_room(Index channel) const { return name(channel) == campaign_.room; }
  double duration_s() const { return lags_s_[4] / 4; }
  bool has_room() const { return !campaign_.room.empty(); }

  Vector rise_over_room(const PairedBatch& batch, Index c) const {
    return has_room() ? Vector(batch.measured.col(c) - batch.room_degC) : since_first(batch.measured.col(c));
  }

  void readings() {
    for (Index c = 0; c < campaign_.temperatures; ++c) {
      if (is_room(c)) continue;
      single("sensor-offset", name(c), Stage::measurement, c, {"offset_K", "K", 1, -1},
             [](const PairedBatch& batch, std::size_t) { return Vector::Ones(batch.time_s.size()); });
      single("sensor-gain", name(c), Stage::measurement, c, {"gain", "", 1, -1},
             [&](const PairedBatch& batch, std::size_t) -> Vector {
               return batch.simulated.col(c).array() - reference_degC_;
             });
      single("sensor-drift", name(c), Stage::measurement, c, {"rate_K_per_h", "K/h", 1, -1},
             [](const PairedBatch& batch, std::size_t) -> Vector { return batch.time_s / 3600; });
      for (double share = .003; share < .25; share *= 1.35) {
        const double lag_s = share * duration_s();
        single("sensor-lag", name(c), Stage::measurement, c, {"strength", "1", 1, -1},
               [&](const PairedBatch& batch, std::size_t) -> Vector {
                 return low_pass(batch.time_s, batch.simulated.col(c), lag_s, batch.simulated(0, c)) -
                        batch.simulated.col(c);
               })
            .shape = {{"lag_s", "s", lag_s, -1}};
      }
    }
  }

  /// Displacements that count from their first sample show only the change of an effect since then.
  Vector zeroed(Vector course) const { return campaign_.zeroed ? since_first(course) : course; }

  void displacement() {
    for (Index c = campaign_.temperatures; c < campaign_.channel_count(); ++c) {
      const bool single_output = campaign_.channel_count() == campaign_.temperatures + 1;
      const std::string output = single_output ? "displacement" : name(c);
      const std::vector<Vector>& predicted = predicted_[static_cast<std::size_t>(c - campaign_.temperatures)];
      for (std::size_t i = 0; i < campaign_.inputs.size(); ++i) {
        double largest = 0;
        for (const PairedBatch& batch : campaign_.batches)
          largest = std::max(largest, batch.inputs.col(static_cast<Index>(i)).cwiseAbs().maxCoeff());
        if (largest == 0) continue;
        single("speed-shift", output, Stage::expansion, c, {"shift_um", "um", 1, -1},
               [&](const PairedBatch& batch, std::size_t) {
                 return zeroed((batch.inputs.col(static_cast<Index>(i)) / largest).array().square());
               })
            .driver = campaign_.inputs[i];
      }
      double range = 0, largest = 0;
      for (const Vector& course : predicted) {
        range = std::max(range, course.maxCoeff() - course.minCoeff());
        largest = std::max(largest, course.cwiseAbs().maxCoeff());
      }
      for (double share = .004; share < .3; share *= 1.3) {
        const double half_width = share * range;
        single(
            "hysteresis", output, Stage::expansion, c, {"strength", "1", 1, -1},
            [&](const PairedBatch&, std::size_t b) -> Vector { return play(predicted[b], half_width) - predicted[b]; })
            .shape = {{"half_width_um", "um", half_width, -1}};
      }
      for (double share = .002; share < .12; share *= 1.3) {
        const double delay_s = share * duration_s();
        single("clock-offset", output, Stage::measurement, c, {"strength", "1", 1, -1},
               [&](const PairedBatch& batch, std::size_t b) -> Vector {
                 return delayed(batch.time_s, predicted[b], delay_s) - predicted[b];
               })
            .shape = {{"late_s", "s", delay_s, -1}};
      }
      single("probe-drift", output, Stage::measurement, c, {"rate_um_per_h", "um/h", 1, -1},
             [](const PairedBatch& batch, std::size_t) -> Vector { return batch.time_s / 3600; })
          .driver = "time";
      if (has_room())
        single("probe-drift", output, Stage::measurement, c, {"um_per_K", "um/K", 1, -1},
               [](const PairedBatch& batch, std::size_t) { return since_first(batch.room_degC); })
            .driver = "ambient";
      for (Index j = 0; j < campaign_.temperatures; ++j) {
        if (is_room(j)) continue;
        single("missing-expansion", name(j), Stage::expansion, c, {"um_per_K", "um/K", 1, -1},
               [&](const PairedBatch& batch, std::size_t) { return since_first(batch.measured.col(j)); });
        single("nonlinear-expansion", name(j), Stage::expansion, c, {"um_per_K2", "um/K2", 1, -1},
               [&](const PairedBatch& batch, std::size_t) {
                 return zeroed((batch.measured.col(j).array() - reference_degC_).square());
               });
      }
    }
  }

  void heat() {
    const auto constant = [](const PairedBatch& batch, std::size_t) { return Vector::Ones(batch.time_s.size()); };
    spread("heat-source", "", Stage::heat, constant).driver = "constant";
    for (std::size_t i = 0; i < campaign_.inputs.size(); ++i) {
      const Index column = static_cast<Index>(i);
      double largest = 0;
      for (const PairedBatch& batch : campaign_.batches)
        largest = std::max(largest, batch.inputs.col(column).cwiseAbs().maxCoeff());
      if (largest == 0) continue;
      const auto power = [&, column, largest](double exponent) {
        return [column, largest, exponent](const PairedBatch& batch, std::size_t) -> Vector {
          return (batch.inputs.col(column).array().abs() / largest).pow(exponent);
        };
      };
      spread("heat-source", "", Stage::heat, power(1)).driver = campaign_.inputs[i];
      if (on_off(column)) continue;
      for (const double exponent : {1.5, 2., 3.}) {
        PairedSignature& one =
            spread("friction-law", "source driven by " + campaign_.inputs[i], Stage::heat, power(exponent));
        one.driver = campaign_.inputs[i];
        one.shape = {{"exponent", "", exponent, -1}};
      }
    }
  }

  bool on_off(Index column) const {
    for (const PairedBatch& batch : campaign_.batches)
      for (const double value : batch.inputs.col(column))
        if (value != 0 && value != 1) return false;
    return true;
  }

  void boundary() {
    for (Index c = 0; c < campaign_.temperatures; ++c) {
      if (is_room(c)) continue;
      for (std::size_t i = 0; i < campaign_.inputs.size(); ++i) {
        const Index column = static_cast<Index>(i);
        double largest = 0;
        for (const PairedBatch& batch : campaign_.batches)
          largest = std::max(largest, batch.inputs.col(column).cwiseAbs().maxCoeff());
        if (largest == 0) continue;
        if (on_off(column)) {
          spread(
              "coolant", name(c), Stage::boundary,
              [&](const PairedBatch& batch, std::size_t) -> Vector { return batch.inputs.col(column); },
              [&](const PairedBatch& batch, std::size_t) -> Vector {
                return batch.inputs.col(column).cwiseProduct(batch.measured.col(c) -
                                                             Vector::Constant(batch.time_s.size(), reference_degC_)) /
                       10;
              })
              .acts_on = {{c, 0}};
          found_.back().driver = campaign_.inputs[i];
        } else {
          spread("forced-convection", name(c), Stage::boundary, [&](const PairedBatch& batch, std::size_t) -> Vector {
            return (batch.inputs.col(column).array().abs() / largest).pow(.8) * rise_over_room(batch, c).array();
          }).acts_on = {{c, -1}};
          found_.back().driver = campaign_.inputs[i];
        }
      }
      spread("natural-convection", name(c), Stage::boundary, [&](const PairedBatch& batch, std::size_t) -> Vector {
        const Vector rise = rise_over_room(batch, c);
        return rise.array() * (rise.array().abs() / 10).pow(.5);
      }).acts_on = {{c, -1}};
      if (has_room())
        spread("radiation", name(c), Stage::boundary, [&](const PairedBatch& batch, std::size_t) -> Vector {
          return ((batch.measured.col(c).array() + ice_point_K) / 293.15).pow(4) -
                 ((batch.room_degC.array() + ice_point_K) / 293.15).pow(4);
        }).acts_on = {{c, -1}};
      spread("thermal-memory", name(c), Stage::conduction, [&](const PairedBatch& batch, std::size_t) -> Vector {
        const Vector rise = since_first(batch.measured.col(c));
        return rise - low_pass(batch.time_s, rise, lags_s_[2], 0);
      }).acts_on = {{c, -1}};
    }
    if (has_room() && !campaign_.room_is_simulated)
      spread("ambient-drift", "ambient", Stage::boundary,
             [](const PairedBatch& batch, std::size_t) { return since_first(batch.room_degC); });
    PairedSignature start{"initial-gradient", "", "", Stage::initial, {}, {}, {}, {}, false, {}};
    for (Index c = 0; c < campaign_.channel_count(); ++c)
      if (c >= campaign_.temperatures || !is_room(c)) start.channels.push_back(c);
    start.columns.resize(campaign_.rows(), 4);
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b)
      for (std::size_t k = 0; k < 4; ++k)
        campaign_.part(start.columns, b).col(static_cast<Index>(k)) =
            (-campaign_.batches[b].time_s / lags_s_[k]).array().exp();
    found_.push_back(start);
  }

  void conduction() {
    for (Index a = 0; a < campaign_.temperatures; ++a)
      for (Index b = a + 1; b < campaign_.temperatures; ++b) {
        if (is_room(a) || is_room(b)) continue;
        const std::string pair = name(a) + "-" + name(b);
        spread("missing-link", pair, Stage::conduction, [&](const PairedBatch& batch, std::size_t) -> Vector {
          return batch.measured.col(a) - batch.measured.col(b);
        }).acts_on = {{a, -1}, {b, 1}};
        spread("joint-conductance", pair, Stage::conduction, [&](const PairedBatch& batch, std::size_t) -> Vector {
          const Vector sum = batch.measured.col(a) + batch.measured.col(b);
          return (batch.measured.col(a) - batch.measured.col(b)).array() * (sum.array() / 2 - reference_degC_) / 10;
        }).acts_on = {{a, 0}, {b, 0}};
      }
  }

  const PairedCampaign& campaign_;
  double reference_degC_;
  std::vector<std::vector<Vector>> predicted_;
  std::vector<double> lags_s_;
  std::vector<PairedSignature> found_;
};

}  // namespace detail

}  // namespace thermfit
