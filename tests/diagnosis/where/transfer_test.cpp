#include "thermfit/diagnosis/where/transfer.hpp"

#include "support/catch.hpp"
#include "support/small_machine.hpp"

using namespace thermfit;

TEST_CASE("a model from a true simulator transfers, one from a wrong simulator does not", "[gap]") {
  ThermalNetwork wrong = small_machine();
  for (auto& [node, um_per_K] : wrong.displacements[0].um_per_K) um_per_K *= 2;
  const Campaign real = small_campaign(small_machine(), 4), poor = small_campaign(wrong, 4);
  const Transfer transfer = transfer_of({poor, real, real}, real, "Z");
  REQUIRE(transfer.points.size() == 2);
  CHECK(transfer.S_mean[0] > 3 * transfer.S_mean[1]);
  CHECK(transfer.S_mean[1] == transfer.S_mean[2]);
}

TEST_CASE("without the error or with too few points there is no transfer", "[gap]") {
  const Campaign real = small_campaign(small_machine(), 2);
  CHECK(transfer_of({real, real, real}, real, "X").points.empty());
  CHECK(transfer_of({real, real, real}, real, "Z", 9).points.empty());
}
