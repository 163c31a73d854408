#include "export/test_vectors.hpp"

#include <set>

#include "controller/example_model.hpp"
#include "support/catch.hpp"

using namespace thermfit;
using namespace thermfit::cli;
using State = CompensatorState;

namespace {

/// What the status words at the ends of the vectors say.
struct Seen {
  std::set<State> states;
  std::set<SensorFault> faults;
  std::set<ZeroSource> zeros;
  bool outside_with_substitute = false;

  explicit Seen(const std::vector<TestVector<double>>& course) {
    for (const TestVector<double>& vector : course) {
      const CompensatorStatus status{vector.status};
      states.insert(status.state());
      faults.insert(status.fault());
      zeros.insert(status.zero_source());
      outside_with_substitute |= status.outside_domain() && status.state() == State::substituting;
    }
  }
};

}  // namespace

TEST_CASE("what an export tests itself with meets every state, every fault and every zero", "[export]") {
  const auto model = narrow_model<double>(example_model());
  CompensationWishes wishes;
  const auto waits = settings_for<double>(example_model(), wishes);
  wishes.zero = ZeroPolicy::first;
  const auto takes_first = settings_for<double>(example_model(), wishes);

  const Seen all(TestCourse<double>(model, waits).run_all());
  CHECK(all.states.size() == compensator_states);
  CHECK(all.faults.size() == 9);
  CHECK(all.zeros == std::set<ZeroSource>{ZeroSource::none, ZeroSource::datum, ZeroSource::retained});
  CHECK(all.outside_with_substitute);
  CHECK(Seen(TestCourse<double>(model, takes_first).run_all()).zeros.count(ZeroSource::first) == 1);

  const Seen from_readings(TestCourse<double>(model, waits, 1e6).run());  // neither heartbeat nor power cycle
  CHECK(from_readings.states.size() == compensator_states);
  CHECK(from_readings.faults == std::set<SensorFault>{SensorFault::none, SensorFault::range, SensorFault::rate,
                                                      SensorFault::stuck, SensorFault::recovering,
                                                      SensorFault::disagrees});
  CHECK(from_readings.outside_with_substitute);
}
