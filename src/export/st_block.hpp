#pragma once

/// A function block of Structured Text: its model and settings, and what its inputs and outputs are called.

#include "export/st_text.hpp"
#include "export/test_vectors.hpp"

namespace thermfit::cli {

/// What every part of a function block is written from.
template <class Scalar>
class StBlock : public StText<Scalar> {
 public:
  using Device = HostCompensator<Scalar>;

  StBlock(const ExportRequest& request, const typename Device::Model& model, const typename Device::Settings& settings)
      : request_(request),
        model_(model),
        settings_(settings),
        sensors_(identifiers(request.trained.temperatures)),
        errors_(identifiers(request.trained.errors)) {}

 protected:
  using Base = StText<Scalar>;
  using Base::number;
  using Base::of;

  std::size_t sensors() const { return sensors_.size(); }
  std::size_t errors() const { return errors_.size(); }
  std::size_t components() const { return model_.domain.rotations.size(); }
  std::string reading_of(std::size_t i) const { return "Temperature_" + sensors_[i]; }
  std::string output(std::size_t j) const { return "Offset_" + errors_[j] + "_" + request_.unit.identifier; }

  /// Whether coefficients are of derived channels, and how many lags there are.
  bool derived() const { return !model_.features.channels.empty(); }
  std::size_t lags() const { return model_.features.lag_sensor.size(); }
  /// What coefficient f multiplies.
  std::string input(std::size_t f) const { return derived() ? "f" + number(f) + "_value" : of(f, "value"); }
  std::size_t inputs() const { return model_.inputs(); }

  const ExportRequest& request_;
  const typename Device::Model& model_;
  const typename Device::Settings& settings_;
  std::vector<std::string> sensors_, errors_;
};

}  // namespace thermfit::cli
