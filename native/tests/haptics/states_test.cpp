#include "riffler/haptics/states.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <string>

namespace riffler::haptics::states_test {
namespace {

using S = ForceState;

TEST(States, EveryTransitionIsAsInTheTable) {
  // Rows: states; columns: events, in the order of the enums.
  //   on        homed     press     release   risen      late         trip        rested    reset
  const ForceState table[kForceStates][kForceEvents] = {
      {S::Homing, S::Off, S::Off, S::Off, S::Off, S::Off, S::Off, S::Off, S::Off},
      {S::Homing, S::Ready, S::Homing, S::Homing, S::Homing, S::Homing, S::Tripped, S::Homing, S::Homing},
      {S::Ready, S::Ready, S::Ramp, S::Ready, S::Ready, S::Ready, S::Tripped, S::Ready, S::Ready},
      {S::Ramp, S::Ramp, S::Ramp, S::Ready, S::Active, S::Degraded, S::Tripped, S::Ramp, S::Ramp},
      {S::Active, S::Active, S::Active, S::Ready, S::Active, S::Degraded, S::Tripped, S::Active, S::Active},
      {S::Degraded, S::Degraded, S::Degraded, S::Ready, S::Active, S::Degraded, S::Tripped, S::Degraded, S::Degraded},
      {S::Tripped, S::Tripped, S::Tripped, S::Tripped, S::Tripped, S::Tripped, S::Tripped, S::Ready, S::Homing},
  };
  for (std::size_t s = 0; s < kForceStates; ++s)
    for (std::size_t e = 0; e < kForceEvents; ++e)
      EXPECT_EQ(next(static_cast<ForceState>(s), static_cast<ForceEvent>(e)), table[s][e])
          << name(static_cast<ForceState>(s)) << ", " << name(static_cast<ForceEvent>(e));
}

TEST(States, ForceIsReachedThroughTheRampAlone) {
  for (std::size_t s = 0; s < kForceStates; ++s)
    for (std::size_t e = 0; e < kForceEvents; ++e) {
      const ForceState from = static_cast<ForceState>(s), to = next(from, static_cast<ForceEvent>(e));
      if (!lets_force_through(from) && lets_force_through(to)) {
        EXPECT_EQ(from, S::Ready);
        EXPECT_EQ(to, S::Ramp);
      }
    }
}

TEST(States, EveryCauseHasItsOwnSentence) {
  std::set<std::string> sentences, names;
  for (std::size_t k = 0; k < kCauses; ++k) {
    const std::string text = sentence(static_cast<Cause>(k));
    EXPECT_GT(text.size(), 10u);
    EXPECT_EQ(text.back(), '.');
    sentences.insert(text);
  }
  EXPECT_EQ(sentences.size(), kCauses);
  for (std::size_t k = 0; k < kForceStates; ++k) names.insert(name(static_cast<ForceState>(k)));
  for (std::size_t k = 0; k < kForceEvents; ++k) names.insert(name(static_cast<ForceEvent>(k)));
  EXPECT_EQ(names.size(), kForceStates + kForceEvents);
}

TEST(States, TheForceDoesNotReturnByItselfWhileThePoseIsInDoubt) {
  for (const Cause c : {Cause::NotFinite, Cause::DeviceFault, Cause::NotHomed, Cause::Redundancy, Cause::Jump,
                        Cause::BadWrench, Cause::Excess})
    EXPECT_FALSE(heals(c)) << sentence(c);
  for (const Cause c :
       {Cause::BadTime, Cause::DeviceLate, Cause::Overspeed, Cause::LateTick, Cause::Stale, Cause::NoDeadMan})
    EXPECT_TRUE(heals(c)) << sentence(c);
}

}  // namespace
}  // namespace riffler::haptics::states_test
