#include "thermfit/batch/paired_campaign.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

Batch batch_of(const std::string& name, const Vector& time_s, double slope) {
  Batch batch;
  batch.name = name;
  batch.time_s = time_s;
  batch.temperatures = {{"T1", "room"}, Matrix(time_s.size(), 2)};
  batch.temperatures.values << slope * time_s, 20 + time_s.array() / 1e4;
  batch.errors = {{"Z"}, 3 * time_s};
  batch.inputs = {{"spindle_rpm"}, Vector::Ones(time_s.size())};
  return batch;
}

const Vector coarse = Vector::LinSpaced(20, 0, 1900), fine = Vector::LinSpaced(191, -100, 1800);

std::string message_of(const Campaign& real, const Campaign& sim, const std::string& room = {}) {
  try {
    pair_campaigns(real, sim, room);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("differently sampled courses are compared at measured samples within the common time", "[gap]") {
  const PairedCampaign paired = pair_campaigns({batch_of("K01", coarse, .01)}, {batch_of("K01", fine, .02)});
  REQUIRE(paired.batches[0].time_s.size() == 19);
  CHECK((paired.batches[0].simulated.col(0) - 2 * paired.batches[0].measured.col(0)).norm() < 1e-9);
  CHECK(paired.resampled);
}

TEST_CASE("the temperature that the simulator took over is its room", "[gap]") {
  const PairedCampaign paired = pair_campaigns({batch_of("K01", coarse, .01)}, {batch_of("K01", coarse, .02)});
  CHECK(paired.room == "room");
  CHECK(paired.room_is_simulated);
  CHECK_FALSE(paired.is_output(1));
  CHECK(paired.channel_count() == 3);
}

TEST_CASE("a temperature that moves although the simulator holds it is the room of a simulator without weather",
          "[gap]") {
  Batch sim = batch_of("K01", coarse, .02);
  sim.temperatures.values.col(1).setConstant(20);
  const PairedCampaign paired = pair_campaigns({batch_of("K01", coarse, .01)}, {sim});
  CHECK(paired.room == "room");
  CHECK_FALSE(paired.room_is_simulated);
}

TEST_CASE("what does not pair is told: names, channels, clocks, missing values, times", "[gap]") {
  const Batch real = batch_of("K01", coarse, .01);
  CHECK(message_of({real}, {batch_of("run1", coarse, .01)}).find("no simulated batch has the name") !=
        std::string::npos);
  CHECK(message_of({real}, {}).find("no batches") != std::string::npos);
  Batch other = real;
  other.temperatures.names = {"A", "B"};
  other.errors.names = {"Y"};
  CHECK(message_of({real}, {other}).find("no channel of the measured batches") != std::string::npos);
  Batch timeless = real;
  timeless.time_s.resize(0);
  CHECK(message_of({timeless}, {real}).find("no time column") != std::string::npos);
  Batch broken = real;
  broken.temperatures.values(3, 0) = std::nan("");
  CHECK(message_of({broken}, {real}).find("CsvOptions::missing") != std::string::npos);
  CHECK(message_of({real}, {batch_of("K01", coarse.array() + 1e5, .01)}).find("in common") != std::string::npos);
  CHECK(message_of({real}, {real}, "T99").find("no temperature 'T99'") != std::string::npos);
}

TEST_CASE("batches and channels that only one side has are left out and named", "[gap]") {
  Batch sim = batch_of("K01", coarse, .02);
  sim.temperatures = {{"room"}, sim.temperatures.values.col(1)};
  const PairedCampaign paired = pair_campaigns({batch_of("K01", coarse, .01), batch_of("K02", coarse, .01)}, {sim});
  CHECK(paired.batches.size() == 1);
  CHECK(paired.channels == std::vector<std::string>{"room", "Z"});
  CHECK(paired.not_simulated == std::vector<std::string>{"T1"});
  CHECK(paired.not_paired == std::vector<std::string>{"K02"});
}
