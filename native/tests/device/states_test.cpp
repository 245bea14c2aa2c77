// The pen's state machine: every state with every set of events, compared with the list of allowed transitions.
#include "device/firmware/pen_states.h"

#include <gtest/gtest.h>

#include <set>

namespace riffler::device::states_test {
namespace {

constexpr unsigned kAllEvents = 1U << RIFFLER_PEN_EVENTS;

TEST(PenStates, EveryStateHandlesEveryEvent) {
  for (int state = 0; state < RIFFLER_PEN_STATES; ++state)
    for (unsigned events = 0; events < kAllEvents; ++events) {
      const bool ready = events & RIFFLER_PEN_ON_READY, disable = events & RIFFLER_PEN_ON_DISABLE,
                 enable = events & RIFFLER_PEN_ON_ENABLE, full = events & RIFFLER_PEN_ON_FULL;
      int expected = state;
      if (events & RIFFLER_PEN_ON_FAULT) {
        expected = RIFFLER_PEN_FAULT;
      } else if (state == RIFFLER_PEN_BOOT && ready) {
        expected = RIFFLER_PEN_IDLE;
      } else if (state == RIFFLER_PEN_IDLE && enable) {
        expected = RIFFLER_PEN_RAMP;
      } else if (state == RIFFLER_PEN_RAMP && (disable || full)) {
        expected = disable ? RIFFLER_PEN_IDLE : RIFFLER_PEN_ACTIVE;
      } else if ((state == RIFFLER_PEN_ACTIVE || state == RIFFLER_PEN_FAULT) && disable) {
        expected = RIFFLER_PEN_IDLE;
      }
      EXPECT_EQ(riffler_pen_next_state(static_cast<riffler_pen_state>(state), events), expected)
          << riffler_pen_state_text(static_cast<unsigned>(state)) << ", events " << events;
    }
}

TEST(PenStates, ForceIsReachedThroughTheRampOnly) {
  for (unsigned events = 0; events < kAllEvents; ++events) {
    for (const auto state : {RIFFLER_PEN_BOOT, RIFFLER_PEN_IDLE, RIFFLER_PEN_FAULT})
      EXPECT_NE(riffler_pen_next_state(state, events), RIFFLER_PEN_ACTIVE);
    EXPECT_NE(riffler_pen_next_state(RIFFLER_PEN_FAULT, events), RIFFLER_PEN_RAMP);
    EXPECT_NE(riffler_pen_next_state(RIFFLER_PEN_ACTIVE, events), RIFFLER_PEN_RAMP);
  }
}

TEST(PenStates, AStateThatDoesNotExistIsAFault) {
  for (int state = RIFFLER_PEN_STATES; state < 8; ++state) {
    EXPECT_EQ(riffler_pen_next_state(static_cast<riffler_pen_state>(state), 0), RIFFLER_PEN_FAULT);
    EXPECT_FALSE(riffler_pen_pushes(static_cast<riffler_pen_state>(state)));
  }
}

}  // namespace
}  // namespace riffler::device::states_test
