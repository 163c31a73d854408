#include "thermfit/model/sensor_envelope.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {
Batch batch(std::vector<double> time_s, std::vector<double> first, std::vector<double> second) {
  Batch result;
  result.name = "B";
  const auto rows = static_cast<Index>(first.size());
  if (!time_s.empty()) result.time_s = Vector::Map(time_s.data(), rows);
  result.temperatures.names = {"T1", "T2"};
  result.temperatures.values.resize(rows, 2);
  result.temperatures.values.col(0) = Vector::Map(first.data(), rows);
  result.temperatures.values.col(1) = Vector::Map(second.data(), rows);
  return result;
}
}  // namespace

TEST_CASE("the envelope spans all batches in the order of the names asked for", "[model]") {
  const Campaign campaign{batch({0, 60, 180}, {20, 21, 27}, {5, 5, 5}), batch({0, 60}, {18, 18}, {6, 9})};
  const SensorEnvelope envelope = sensor_envelope(campaign, {"T2", "T1"});
  CHECK(envelope.lowest_degC == Vector(Eigen::Vector2d(5, 18)));
  CHECK(envelope.highest_degC == Vector(Eigen::Vector2d(9, 27)));
  CHECK(envelope.largest_rate_K_per_min == Vector(Eigen::Vector2d(3, 3)));
  CHECK(envelope.longest_still_min == Vector(Eigen::Vector2d(3, 1)));
}

TEST_CASE("without a clock the envelope has a range and no rates", "[model]") {
  const SensorEnvelope envelope = sensor_envelope({batch({}, {20, 21}, {5, 6})}, {"T1"});
  CHECK(envelope.has_range());
  CHECK_FALSE(envelope.has_rates());
}

TEST_CASE("an unknown sensor is refused by name", "[model]") {
  CHECK_THROWS_WITH(sensor_envelope({batch({}, {20}, {5})}, {"T9"}), Catch::Contains("T9"));
}
