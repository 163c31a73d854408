/// A thermometer of a measured lathe that steps in the middle of a day and stays there: the compensator must do no
/// worse than if it had been lost.

#include <cmath>
#include <iostream>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/settings_for.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/number.hpp"

using namespace thermfit;

namespace {

/// Days of the lathe, a row taken for a minute, displacement relative to the first row.
Campaign days(const std::string& folder, const std::vector<std::string>& names) {
  CsvOptions options;
  options.temperatures = {"Ambient", "Coolantwall", "Transfomerbed"};
  options.errors = {"Dia Disp"};
  Campaign result;
  for (const std::string& name : names) {
    Batch day = read_campaign({folder + "/day" + name + ".csv"}, options).batches[0];
    day.time_s = Vector::LinSpaced(day.rows(), 0, 60. * static_cast<double>(day.rows() - 1));
    day.errors.values.array() -= day.errors.values(0, 0);
    result.push_back(std::move(day));
  }
  return result;
}

/// Rms of what is left of the displacement, um, when `sensor` reads `fault(true reading)` from a third of the day on.
template <class Fault>
double left_um(const TrainedModel& trained, const Batch& day, std::size_t sensor, Fault fault) {
  CompensationWishes wishes;
  wishes.period_s = 60;
  wishes.zero = ZeroPolicy::first;
  const auto model = narrow_model<double, 3, 1>(trained);
  const auto settings = settings_for<double, 3, 1>(trained, wishes);
  Compensator<double, 3, 1, dynamic_size> device(model, settings);
  device.start();
  double squares = 0;
  for (Index row = 0; row < day.rows(); ++row) {
    std::array<double, 3> readings{};
    for (std::size_t i = 0; i < 3; ++i) readings[i] = day.temperatures.values(row, static_cast<Index>(i));
    if (row >= day.rows() / 3) readings[sensor] = fault(readings[sensor]);
    device.step(readings);
    squares += std::pow(day.errors.values(row, 0) + device.offset_um()[0], 2);
  }
  return std::sqrt(squares / static_cast<double>(day.rows()));
}

}  // namespace

TEST_CASE("a thermometer of a measured lathe that steps and stays there does no more harm than one that is lost",
          "[real]") {
  REQUIRE_SHARED_DATA(data);
  const std::string lathe = data + "/real/ace_lathe";
  TrainingPlan plan;
  plan.options.components = ComponentRule::fixed(2);
  const TrainedModel trained = train(days(lathe, {"01", "02", "03", "04", "05", "06", "07", "08", "09"}), plan);
  for (const Batch& day : days(lathe, {"14", "17"}))
    for (std::size_t sensor = 0; sensor < 3; ++sensor) {
      const double lost = left_um(trained, day, sensor, [](double) { return std::nan(""); });
      std::cout << day.name << ", " << trained.temperatures[sensor] << ": lost " << fixed_text(lost, 2) << " um";
      for (const double step_K : {12., 30.}) {
        const double left = left_um(trained, day, sensor, [&](double degC) { return degC + step_K; });
        std::cout << ", stepped by " << step_K << " K " << fixed_text(left, 2);
        CHECK(left < 1.2 * lost);
      }
      std::cout << '\n';
    }
}
