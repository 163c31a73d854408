#include "thermfit/controller/state_machine.hpp"

#include <string>

#include "support/catch.hpp"

using State = thermfit::CompensatorState;
using Event = thermfit::CompensatorEvent;

namespace {

/// The behaviour once more, in sentences rather than as a table.
State expected(State state, Event event) {
  if (event == Event::start) return State::starting;
  if (state == State::off) return State::off;
  if (event == Event::stop) return State::stopping;
  if (state == State::stopping) return event == Event::at_zero ? State::off : State::stopping;
  switch (event) {
    case Event::demand:
      return State::tracking;
    case Event::substitute_demand:
      return State::substituting;
    case Event::hold_expired:
      return state == State::no_datum ? state : State::fallback;
    case Event::no_zero:
      return State::no_datum;
    case Event::no_demand:
      return state == State::starting || state == State::fallback || state == State::no_datum ? state : State::holding;
    default:
      return state;
  }
}

}  // namespace

TEST_CASE("every pair of state and event leads where the description says", "[controller]") {
  for (int s = 0; s < thermfit::compensator_states; ++s)
    for (int e = 0; e < thermfit::compensator_events; ++e) {
      INFO("state " << s << ", event " << e);
      const auto state = static_cast<State>(s);
      const auto event = static_cast<Event>(e);
      CHECK(next_state(state, event) == expected(state, event));
    }
}

TEST_CASE("only the two following states move the offset to the demand, only waiting states keep it", "[controller]") {
  using thermfit::OffsetTarget;
  const OffsetTarget expected_targets[] = {OffsetTarget::zero,   OffsetTarget::rest, OffsetTarget::demand,
                                           OffsetTarget::demand, OffsetTarget::rest, OffsetTarget::zero,
                                           OffsetTarget::zero,   OffsetTarget::zero};
  for (int s = 0; s < thermfit::compensator_states; ++s)
    CHECK(offset_target(static_cast<State>(s)) == expected_targets[s]);
}

TEST_CASE("no chain of events leaves the compensator stuck: start and stop always lead back", "[controller]") {
  for (int s = 0; s < thermfit::compensator_states; ++s) {
    const auto state = static_cast<State>(s);
    CHECK(next_state(next_state(state, Event::start), Event::demand) == State::tracking);
    CHECK(next_state(next_state(state, Event::stop), Event::at_zero) == State::off);
  }
}
