#pragma once

#include <limits>

#include "thermfit/controller/arithmetic.hpp"
#include "thermfit/controller/row.hpp"
#include "thermfit/controller/session.hpp"

namespace thermfit {

/// A zero to be stored over a power cycle: plain data. "None" is not 0 degC: the mark is 0, and a sensor without a zero
/// holds NaN. A copy that is torn, or another model's, is not taken. Of a model with features it begins with where the
/// lags and the climate of the session were.
template <class Scalar, int Sensors, int Features = none_or_dynamic(Sensors), int Lags = none_or_dynamic(Sensors)>
struct RetainedDatum : RetainedSession<Scalar, Features, Lags> {
  using Session = RetainedSession<Scalar, Features, Lags>;  ///< what there is besides the zero

  std::uint32_t mark = 0;            ///< `valid_mark` where there is a zero
  std::uint32_t model = 0;           ///< ControllerModel::identity of the model it belongs to
  std::uint32_t through_zero = 0;    ///< 1: the intercept drops out
  Row<Scalar, Sensors> zero_degC{};  ///< of each sensor; NaN: it had none
  std::uint32_t digest = 0;          ///< FNV-1a, 32 bits, over the bytes of all the others in their order

  static constexpr std::uint32_t valid_mark = 0x54464431u;  ///< "TFD1"

  /// Where lags and climate were.
  Session& session() noexcept { return *this; }
  /// Where lags and climate were.
  const Session& session() const noexcept { return *this; }

  /// Whether it is whole, and the model's of that identity.
  bool valid(std::uint32_t identity) const noexcept {
    return mark == valid_mark && model == identity && digest == digest_of_all();
  }

  /// Marks it as the model's of that identity, with its digest.
  void seal(std::uint32_t identity) noexcept {
    mark = valid_mark;
    model = identity;
    digest = digest_of_all();
  }

 private:
  std::uint32_t digest_of_all() const noexcept {
    std::uint32_t result = fnv1a_begin;
    for (const std::uint32_t word : {mark, model, through_zero}) result = fnv1a(result, &word, sizeof word);
    const auto see = [&](Scalar value) {
      const Scalar known = is_finite(value) ? value : Scalar(-1e9);
      result = fnv1a(result, &known, sizeof known);
    };
    for (const Scalar zero : zero_degC) see(zero);
    session().each(see);
    return result;
  }
};

}  // namespace thermfit
