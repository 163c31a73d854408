#include "blind/generator/plant.hpp"

#include <filesystem>
#include <fstream>

#include "blind/generator/case.hpp"
#include "support/catch.hpp"

using namespace blind;

namespace {

/// Two cells, one heated by 10 W, constant air.
Experiment held_input(int samples, int steps, double air_degC) {
  Experiment experiment;
  experiment.interval_s = 60;
  experiment.steps = steps;
  experiment.inputs = {"on"};
  experiment.input = Matrix::Ones(samples, 1);
  experiment.air_degC = Vector::Constant(experiment.fine_rows(), air_degC);
  return experiment;
}

}  // namespace

TEST_CASE("a single cell follows the exponential of its time constant") {
  Plant plant;
  plant.add_cell(600, 2);
  plant.sources = {{"heater", "on", 1, 1, 10, {{0, 1.}}}};
  const Experiment experiment = held_input(31, 6, 20);
  const Matrix trace = simulate(plant, experiment, 0, Vector::Constant(1, 20), {});
  for (Index row = 0; row < trace.rows(); row += 30) {
    const double time_s = experiment.step_s() * static_cast<double>(row);
    CHECK(trace(row, 0) == Approx(20 + 5 * (1 - std::exp(-time_s / 300))).margin(2e-4));
  }
}

TEST_CASE("insulated cells keep their heat, and a link evens them out") {
  Plant plant;
  plant.add_cell(400, 0);
  plant.add_cell(800, 0);
  plant.links = {{0, 1, 5}};
  const Experiment experiment = held_input(61, 6, 0);
  const Matrix trace = simulate(plant, experiment, 0, (Vector(2) << 50, 20).finished(), {});
  const Vector heat = trace * plant.capacity_J_per_K;
  CHECK((heat.array() - heat[0]).abs().maxCoeff() < 1e-8 * heat[0]);
  CHECK(trace(trace.rows() - 1, 0) == Approx(30).margin(.01));
}

TEST_CASE("halving the step of a whole machine with a nonlinear effect changes little, and to second order") {
  Random random(7);
  const Machine machine = random_machine(random);
  Campaign campaign = random_campaign(random, machine, "rich");
  campaign.batches.resize(1);
  const auto run = [&](int steps) {
    Campaign finer = campaign;
    Experiment& batch = finer.batches[0];
    const Experiment& given = campaign.batches[0];
    batch.draught_K.resize(0, 0);
    batch.steps = steps;
    batch.air_degC = Vector::Constant(batch.fine_rows(), given.air_degC[0]);
    const Effect effect = laws::natural_convection(Scene{machine, finer, Random(3)}, 3);
    return every(simulate(machine.plant, batch, 0, at_rest(machine.plant, batch), {effect.heat}), steps);
  };
  const int steps = campaign.batches[0].steps;
  const Matrix coarse = run(steps), fine = run(2 * steps), finest = run(4 * steps);
  CHECK((coarse - finest).cwiseAbs().maxCoeff() < .02);
  CHECK((fine - finest).cwiseAbs().maxCoeff() < .4 * (coarse - finest).cwiseAbs().maxCoeff());
}

TEST_CASE("a case repeats byte for byte and another seed gives another case") {
  const Card card{{"sensor-lag"}};
  const auto once = make_case(3, 5, card), again = make_case(3, 5, card), other = make_case(4, 5, card);
  CHECK(once.machine.dump() == again.machine.dump());
  CHECK(once.truth.dump() == again.truth.dump());
  CHECK(once.batches == again.batches);
  CHECK(once.batches != other.batches);
}

TEST_CASE("without an effect the lumped network can show what the plant shows") {
  for (const std::uint64_t number : {1u, 2u}) {
    const auto made = make_case(11, number, {});
    CHECK(made.truth["lumping_error"]["output_um"].get<double>() < .16);
    CHECK(made.truth["truth"][0]["verdict"] == "none");
  }
}

TEST_CASE("the generator includes nothing of the diagnosed network") {
  for (const auto& entry : std::filesystem::directory_iterator(THERMFIT_SOURCE_DIR "/tests/blind/generator")) {
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      if (line.find("#include \"thermfit/") == 0)
        CHECK((line.find("thermfit/number.hpp") != std::string::npos ||
               line.find("thermfit/io/files/atomic_file.hpp") != std::string::npos));
  }
}
