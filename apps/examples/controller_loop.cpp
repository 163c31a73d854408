// A compensator inside a control loop: the work offset is probed on a made machine, it warms up, one thermometer
// breaks, the loop goes on.
//
// Corrections are relative to the datum: the moment when the work offset was probed. Each cycle: read the thermometers
// (NaN for one that did not answer), step, add the offset to the axis command, and look at the status word; store
// retained() when a new zero is there, and resume() with it after a power cycle. Everything is of fixed size; in a real
// loop the model and the settings come from `thermfit export model.json --target cpp`.

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "thermfit/controller/compensator.hpp"

namespace {

using Compensator = thermfit::Compensator<double, 2, 1, 1>;  // two thermometers, one axis, one latent variable

// error_um = 0.5 + 3 spindle + 1 column, temperatures as rise in K; without a sensor, the other one alone.
constexpr Compensator::Model model{true,
                                   {},  // no derived channels
                                   {{{{{3, 1}}}}, {{.5}}},
                                   {{{{{{{0, 9}}}}, {{.5}}}, {{{{{3.4, 0}}}}, {{.5}}}}},
                                   {{true, true}},
                                   {{{{4}}, {{4}}}},  // um: a thermometer that comes back agrees so far
                                   {{{5, 2}}, {{.2, .5}}, {{{{.7, .7}}}}, {{{{.7, .7}}}}, {{.5}}, 20, 2},
                                   {{17.5}},
                                   1};

constexpr thermfit::SensorLimits<double> thermometer{5,    70,  .5, 0, 3600,  // degC, degC, K a step, frozen after
                                                     -1e6, 1e6, .2};          // samples at rest agree to .2 K
constexpr Compensator::Settings settings{{{thermometer, thermometer}},
                                         {5, 30, 1, 1800},  // lost after, trusted after, moved, all frozen after
                                         600,               // steps an offset may be held
                                         thermfit::DomainPolicy::warn,
                                         {},            // no derived channels
                                         {},            // no probe
                                         {{{60, .2}}},  // clamp um, slew um a step
                                         thermfit::OutputSign::correction,
                                         {},  // no zero without a datum
                                         5};  // steps without a heartbeat
static_assert(thermfit::broken_rule(settings) == nullptr);

struct Machine {
  double spindle_K = 0, column_K = 0;
  void warm_up() {  // one second
    spindle_K += (12 - spindle_K) / 900;
    column_K += (.35 * spindle_K - column_K) / 1200;
  }
  double error_um() const { return .5 + 3 * spindle_K + column_K; }
};

}  // namespace

int main() {
  Machine machine;
  Compensator compensator(model, settings);
  if (!compensator.start()) return 1;
  compensator.take_datum();
  const double at_datum_um = machine.error_um();
  double worst_um = 0;
  bool told = false;
  for (int second = 0; second <= 3600; ++second) {
    machine.warm_up();
    std::array<double, 2> readings{21 + machine.spindle_K, 21 + machine.column_K};
    if (second >= 1800) readings[0] = std::numeric_limits<double>::quiet_NaN();  // the wire breaks

    const thermfit::CompensatorStatus status = compensator.step(readings);
    const double command_um = 0 + compensator.offset_um()[0];                  // the programmed position is 0
    const double position_um = command_um + machine.error_um() - at_datum_um;  // relative to what was probed

    if (second > 60 && second < 1800) worst_um = std::fmax(worst_um, std::fabs(position_um));
    if (status.state() == thermfit::CompensatorState::substituting && !told) {
      std::printf("%d s: sensor %d lost, its substitute works\n", second, status.sensor());
      told = true;
    }
    if (second % 600 == 0)
      std::printf("%4d s: error %6.2f um, offset %7.2f um, left %6.2f um, state %d\n", second, machine.error_um(),
                  compensator.offset_um()[0], position_um, static_cast<int>(status.state()));
  }
  std::printf("largest error left before the break: %.2f um\n", worst_um);
  return worst_um < 1 && told ? 0 : 1;
}
