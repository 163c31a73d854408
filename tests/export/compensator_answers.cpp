/// compensator_answers float|double MODEL [OPTION…]: what the C++ compensator answers to the lines of standard input,
/// for exports to be compared with. A line is `enable datum heartbeat periods reading…`, answered by `offset… status`;
/// or something that happens to the power: `power`, `cut SENSOR DEGC` (that zero is torn), `foreign` (another model's),
/// `off PERIODS` (it was off for so long); or `probe ERROR UM`, a reading of the probe.
#include <cstdio>
#include <iostream>
#include <optional>
#include <sstream>

#include "cli/arguments.hpp"
#include "options/compensation_options.hpp"
#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/settings_for.hpp"
#include "thermfit/io/json/model.hpp"

namespace {

using namespace thermfit;

template <class Scalar>
int answer(const TrainedModel& trained, const CompensationWishes& wishes) {
  using Device = Compensator<Scalar, dynamic_size, dynamic_size, dynamic_size>;
  const auto model = narrow_model<Scalar>(trained, wishes.domain_limit);
  const auto settings = settings_for<Scalar>(trained, wishes);
  std::optional<Device> device;
  device.emplace(model, settings);
  auto kept = device->retained();
  std::uint32_t off_steps = Device::off_unknown;
  bool awake = false, running = false, datum_before = false;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "probe") {
      std::size_t error = 0;
      words >> error >> word;
      device->probe(error, static_cast<Scalar>(std::stod(word)));
      continue;
    }
    if (word == "power" || word == "off" || word == "cut" || word == "foreign") {
      std::size_t sensor = 0;
      double zero_degC = 0;
      if (word == "cut" && words >> sensor >> zero_degC) kept.zero_degC[sensor] = static_cast<Scalar>(zero_degC);
      off_steps = Device::off_unknown;
      if (word == "off") words >> off_steps;
      if (word == "foreign") kept.seal(model.identity ^ 1);
      device.emplace(model, settings);
      awake = running = datum_before = false;
      continue;
    }
    const bool enable = word == "1";
    int datum = 0;
    CompensatorCall call;
    words >> datum >> call.heartbeat >> call.periods;
    typename Device::Temperatures readings(model.sensors());
    for (Scalar& reading : readings) {
      words >> word;
      reading = static_cast<Scalar>(std::stod(word));
    }
    if (enable && !running) {
      if (awake) device->start();
      if (!awake) device->resume(kept, off_steps);
      awake = true;
    }
    if (!enable && running) device->stop();
    const bool now = datum != 0 && !datum_before;
    if (now) device->take_datum();
    running = enable;
    datum_before = datum != 0;
    const CompensatorStatus status = device->step(readings, call);
    if (awake || now) kept = device->retained();
    for (const Scalar offset_um : device->offset_um()) std::printf("%.17g ", static_cast<double>(offset_um));
    std::printf("%lu\n", static_cast<unsigned long>(status.word));
  }
  return 0;
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> all(words + 1, words + count);
  const cli::Arguments arguments(std::vector<std::string>(all.begin() + 1, all.end()), cli::compensation_options());
  const TrainedModel trained = load_model(arguments.positionals().at(0));
  const CompensationWishes wishes = cli::compensation_wishes(arguments);
  return all[0] == "float" ? answer<float>(trained, wishes) : answer<double>(trained, wishes);
}
