#include <cmath>

#include "support/catch.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/io/json/machine.hpp"
#include "thermfit/network/simulate.hpp"

using namespace thermfit;

TEST_CASE("24 machines x 9 batches simulate to the last printed digit of an independent implementation",
          "[network][reference]") {
  const std::string data = THERMFIT_SOURCE_DIR "/data";
  const EffectLibrary none;
  int compared = 0;
  double worst = 0;
  for (int c = 1; c <= 24; ++c) {
    const std::string folder = data + "/withheld/case-" + (c < 10 ? "0" : "") + std::to_string(c);
    const ThermalNetwork network = read_machine(folder + "/machine.json", none);
    for (int k = 1; k <= 9; ++k) {
      const std::string name = "/K0" + std::to_string(k) + ".csv";
      const Campaign real = read_campaign({folder + "/real" + name}).batches;
      const Batch expected = read_campaign({folder + "/sim" + name}).batches.front();
      const Simulation simulated = simulate(network, excitations_of(network, real), none).front();
      for (std::size_t s = 0; s < network.sensors.size(); ++s) {
        const Index column = expected.temperatures.find(network.sensors[s].column);
        REQUIRE(column >= 0);
        worst =
            std::max(worst, (simulated.channels.col(static_cast<Index>(s)) - expected.temperatures.values.col(column))
                                .cwiseAbs()
                                .maxCoeff());
      }
      worst = std::max(worst, (simulated.channels.rightCols(1) - expected.errors.values.col(expected.errors.find("Z")))
                                  .cwiseAbs()
                                  .maxCoeff());
      ++compared;
    }
  }
  CHECK(compared == 216);
  INFO("largest difference " << worst);
  CHECK(worst <= 1.0e-4);  // four decimals are printed: one unit in the last place
}
