#pragma once

/// The catalogue of effects, in the order of the chain from heat to reading. Names are a contract.

#include <memory>

#include "thermfit/compiled.hpp"
#include "thermfit/effects/boundary.hpp"
#include "thermfit/effects/conduction.hpp"
#include "thermfit/effects/expansion.hpp"
#include "thermfit/effects/heat.hpp"
#include "thermfit/effects/initial.hpp"
#include "thermfit/effects/measurement.hpp"

namespace thermfit {

/// All effects of the catalogue. Allocates.
template <typename Scalar = double>
EffectLibrary standard_effects() {
  EffectLibrary library;
  library.add(std::make_shared<HeatSourceEffect>())
      .add(std::make_shared<FrictionLaw>())
      .add(std::make_shared<Coolant>())
      .add(std::make_shared<AmbientDrift>())
      .add(std::make_shared<ForcedConvection>())
      .add(std::make_shared<NaturalConvection>())
      .add(std::make_shared<Radiation>())
      .add(std::make_shared<JointConductance>())
      .add(std::make_shared<MissingLink>())
      .add(std::make_shared<ThermalMemory>())
      .add(std::make_shared<MissingExpansion>())
      .add(std::make_shared<NonlinearExpansion>())
      .add(std::make_shared<SpeedShift>())
      .add(std::make_shared<Hysteresis>())
      .add(std::make_shared<InitialGradient>())
      .add(std::make_shared<SensorOffset>())
      .add(std::make_shared<SensorGain>())
      .add(std::make_shared<SensorDrift>())
      .add(std::make_shared<SensorLag>())
      .add(std::make_shared<ProbeDrift>())
      .add(std::make_shared<ClockOffset>());
  return library;
}

THERMFIT_COMPILED_TEMPLATE(EffectLibrary standard_effects<double>());

}  // namespace thermfit
