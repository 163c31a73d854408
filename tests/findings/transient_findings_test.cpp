#include "thermfit/findings/transient_findings.hpp"

#include "support/catch.hpp"
#include "support/vcenter55.hpp"

using namespace thermfit;

TEST_CASE("a first reading that is off the rows that follow is told, on every sensor of every batch", "[findings]") {
  for (const Batch& batch : vcenter55())
    for (Index c = 0; c < batch.temperatures.count(); ++c) {
      Vector readings = batch.temperatures.values.col(c);
      CHECK(first_reading_off_K(Series(readings)) == 0);
      const double trend = readings(4) - readings(1);
      readings(0) += trend > 0 ? 2 : -2;
      CHECK(first_reading_off_K(Series(readings)) == Approx(2).margin(0.7));
    }
}

TEST_CASE("a step along the course that follows may be a machine that starts", "[findings]") {
  Vector starts(8);
  starts << 20, 23, 24.5, 25.2, 25.6, 25.8, 25.9, 25.95;
  CHECK(first_reading_off_K(Series(starts)) == 0);
}
