#include "thermfit/calibration/start_tolerance.hpp"

#include "support/bench_campaign.hpp"
#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("a share of the start costs what its starts do") {
  const ThermalNetwork machine = bench::machine();
  MachineRecord seen = observations_of(machine, bench::campaign(machine, 2, 3));
  double squares = 0;
  for (std::size_t b = 0; b < 2; ++b) {
    Excitation& one = seen.excitations[b];
    for (Index s = 0; s < 5; ++s) one.first_reading_degC(s) = one.ambient_degC(0) + static_cast<double>(s) + 1;
    one.first_reading_degC(1) = std::nan("");
    squares += 1 + 9 + 16;  // T1, T3 and T4; T5 is the room's
  }
  CHECK(start_share_sd(machine, seen) == Approx(start_tolerance_K / std::sqrt(squares)));
}

TEST_CASE("a machine that reads the room everywhere has no start to share") {
  const ThermalNetwork machine = bench::machine();
  MachineRecord seen = observations_of(machine, bench::campaign(machine, 1, 3));
  for (Index s = 0; s < 5; ++s) seen.excitations[0].first_reading_degC(s) = seen.excitations[0].ambient_degC(0);
  CHECK(start_share_sd(machine, seen) == 0);
}
