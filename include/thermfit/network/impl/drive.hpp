#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/network/excitation.hpp"
#include "thermfit/network/room_shape.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit::detail {

template <typename Scalar>
using RowVectorX = Eigen::Matrix<Scalar, 1, Eigen::Dynamic>;

/// An excitation as one system sees it: the inputs it asks for, ambient after the effects on it, heat of a step.
template <typename Scalar>
class Drive {
 public:
  Drive(const Lazy<ThermalSystem, Scalar>& system, const Lazy<Excitation, Scalar>& excitation)
      : system_(system), excitation_(excitation) {
    const Index samples = excitation.samples();
    inputs_.resize(samples, static_cast<Index>(system.inputs.size()));
    for (std::size_t i = 0; i < system.inputs.size(); ++i) {
      const Index from = excitation.find_input(system.inputs[i]);
      if (from < 0 || !excitation.inputs.col(from).allFinite()) {
        std::string known;
        for (const std::string& name : excitation.input_names) known += (known.empty() ? "" : ", ") + name;
        throw Error("batch " + excitation.batch,
                    (from < 0 ? "there is no input column '" : "missing values in column '") + system.inputs[i] + "'",
                    known, "an effect of the machine is driven by it");
      }
      inputs_.col(static_cast<Index>(i)) = excitation.inputs.col(from);
    }
    ambient_ = excitation.ambient_degC;
    const std::size_t number = static_cast<std::size_t>(std::max<Index>(0, excitation.number));
    if (excitation.number >= 0 && number < system.batches.size()) of_batch_ = &system.batches[number];
    if (of_batch_ != nullptr && !of_batch_->ambient_K.empty()) move_room();
    if (!system.ambient_laws.empty()) apply_ambient_laws();
    history_ = {excitation.time_s, ambient_};
    const VectorX<Scalar>& measured = excitation.measured_ambient_degC;
    measured_history_ = {excitation.time_s, measured.size() > 0 ? measured : ambient_};
  }

  Drive(const Drive&) = delete;  // the histories point into it
  Drive& operator=(const Drive&) = delete;

  Index samples() const { return ambient_.size(); }
  const Lazy<Excitation, Scalar>& excitation() const { return excitation_; }

  /// Numbers of this batch alone; null where it has none.
  const ThermalSystem::OfBatch* of_batch() const { return of_batch_; }
  /// K by which the batch's own numbers move the room at the first sample.
  double first_move_K() const { return first_move_K_; }

  double time_s(Index sample) const { return excitation_.time_s(sample); }

  /// Linear between samples; the last value after the last.
  double ambient(Index sample, double time_s) const { return between(ambient_, sample, time_s); }
  /// Derivative of ambient with respect to each parameter at a time; no columns when no effect acts on ambient.
  bool ambient_moves() const { return ambient_tangents_.size() > 0; }
  RowVectorX<Scalar> ambient_tangent(Index sample, double time_s) const {
    const double f = fraction(sample, time_s);
    if (f == 0) return ambient_tangents_.row(sample);
    return (1 - f) * ambient_tangents_.row(sample) + f * ambient_tangents_.row(sample + 1);
  }
  /// K/s from a sample to the next.
  double ambient_rate(Index sample) const { return rate(ambient_, sample); }
  double measured_ambient_rate(Index sample) const {
    const VectorX<Scalar>& measured = excitation_.measured_ambient_degC;
    return rate(measured.size() > 0 ? measured : ambient_, sample);
  }

  /// The moment at a time, with the inputs of `sample`; `temperature_degC` may be null.
  Moment moment(Index sample, double time_s, const double* temperature_degC) const {
    Moment now;
    now.time_s = time_s;
    now.ambient_degC = ambient(sample, time_s);
    now.first_ambient_degC = ambient_(0);
    const VectorX<Scalar>& measured = excitation_.measured_ambient_degC;
    now.measured_ambient_degC = measured.size() > 0 ? between(measured, sample, time_s) : now.ambient_degC;
    now.first_measured_ambient_degC = measured.size() > 0 ? measured(0) : now.first_ambient_degC;
    now.ambient = &history_;
    now.measured_ambient = &measured_history_;
    const VectorX<Scalar>& readings = excitation_.first_reading_degC;
    now.first_reading_degC = readings.size() > 0 ? readings.data() : nullptr;
    now.inputs = inputs_.row(sample).data();
    now.temperature_degC = temperature_degC;
    return now;
  }

  /// (u/scale)^exponent of a source; of |u| where the exponent is not 1, so that reverse motion heats too.
  double activity(const ThermalSystem::Source& source, Index sample) const {
    if (source.input < 0) return 1;
    const double u = inputs_(sample, source.input) / source.scale;
    return source.exponent == 1 ? u : std::pow(std::abs(u), source.exponent);
  }

  bool same_inputs(Index a, Index b) const { return inputs_.row(a) == inputs_.row(b); }

 private:
  double fraction(Index sample, double time_s) const {
    if (sample + 1 >= samples()) return 0;
    return (time_s - time_s_(sample)) / (time_s_(sample + 1) - time_s_(sample));
  }
  double between(const VectorX<Scalar>& values, Index sample, double time_s) const {
    const double f = fraction(sample, time_s);
    return f == 0 ? values(sample) : values(sample) + f * (values(sample + 1) - values(sample));
  }

  double rate(const VectorX<Scalar>& values, Index sample) const {
    if (sample + 1 >= samples()) return 0;
    return (values(sample + 1) - values(sample)) / (time_s_(sample + 1) - time_s_(sample));
  }

  /// The room by the numbers of this batch.
  void move_room() {
    const std::vector<Column>& columns = of_batch_->ambient_columns;
    if (std::any_of(columns.begin(), columns.end(), [](Column one) { return one >= 0; }))
      ambient_tangents_ = MatrixX<Scalar>::Zero(samples(), system_.columns);
    const double end_s = time_s_(samples() - 1);
    for (std::size_t i = 0; i < columns.size(); ++i)
      for (Index k = 0; k < samples(); ++k) {
        const double shape = room_shape(i, end_s > 0 ? time_s_(k) / end_s : 0);
        ambient_(k) += of_batch_->ambient_K[i] * shape;
        if (k == 0) first_move_K_ += of_batch_->ambient_K[i] * shape;
        if (columns[i] >= 0) ambient_tangents_(k, columns[i]) = shape;
      }
  }

  void apply_ambient_laws() {
    if (ambient_tangents_.size() == 0) ambient_tangents_ = MatrixX<Scalar>::Zero(samples(), system_.columns);
    for (const BoundLaw& law : system_.ambient_laws) {
      const VectorX<Scalar> before = ambient_;
      for (Index k = 0; k < samples(); ++k) {
        Moment now = moment(k, time_s_(k), nullptr);
        now.ambient_degC = before(k);
        now.first_ambient_degC = before(0);
        const double step = 1e-4;
        Moment above = now, below = now;
        above.ambient_degC += step;
        below.ambient_degC -= step;
        ambient_tangents_.row(k) *= (system_.value(law, above) - system_.value(law, below)) / (2 * step);
        system_.derivatives(law, now, [&](Column column, double slope) { ambient_tangents_(k, column) += slope; });
        ambient_(k) = system_.value(law, now);
      }
    }
  }

  const Lazy<ThermalSystem, Scalar>& system_;
  const Lazy<Excitation, Scalar>& excitation_;
  const VectorX<Scalar>& time_s_ = excitation_.time_s;
  RowMatrixX<Scalar> inputs_;
  VectorX<Scalar> ambient_;
  MatrixX<Scalar> ambient_tangents_;  ///< samples x parameters
  const ThermalSystem::OfBatch* of_batch_ = nullptr;
  double first_move_K_ = 0;
  RoomHistory history_, measured_history_;
};

}  // namespace thermfit::detail
