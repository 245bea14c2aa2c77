#include "riffler/haptics/safety.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "stress/random.hpp"
#include "support/error_of.hpp"

namespace riffler::haptics::safety_test {
namespace {

const Wrench kPush{{1, 2, 2}, {10, 0, 0}};

Observation good() {
  Observation o;
  o.dt = 1e-3, o.age = 5e-4, o.homed = true, o.dead_man = true;
  return o;
}

/// A machine with everything in order, taken to the full force.
class Running {
 public:
  explicit Running(const SafetySettings& settings = {}) : safety(settings) {
    safety.switch_on();
    for (int k = 0; k < 600; ++k) tick(good());
  }
  Wrench tick(const Observation& o, const Wrench& wanted = kPush) {
    safety.observe(o);
    return safety.release(wanted).wrench();
  }
  Trip last_trip() const {
    std::uint64_t from = safety.log().count() - 1;
    Trip trip{};
    safety.log().read(from, {&trip, 1});
    return trip;
  }
  Safety safety;
};

TEST(Safety, RampsMonotonouslyFromNothingToEverything) {
  Safety safety{SafetySettings{}};
  safety.switch_on();
  double last = 0;
  int ticks = 0;
  for (; safety.state() != ForceState::Active; ++ticks) {
    ASSERT_LT(ticks, 1000);
    safety.observe(good());
    const double force = glm::length(safety.release(kPush).wrench().force);
    EXPECT_GT(force, last);
    EXPECT_LE(force - last, 3 * 1e-3 / SafetySettings{}.ramp + 1e-12);
    last = force;
  }
  EXPECT_EQ(ticks, 500);
  EXPECT_EQ(last, 3);
}

TEST(Safety, PassesNothingWithoutChecksInTheSameTick) {
  Running r;
  EXPECT_EQ(r.safety.release(kPush).wrench(), Wrench{}) << "the permission of the last tick was used";
  r.safety.observe(good());
  EXPECT_EQ(r.safety.release(kPush).wrench(), kPush);
  EXPECT_EQ(r.safety.release(kPush).wrench(), Wrench{});
  r.safety.observe(good());
  r.safety.interrupt();
  EXPECT_EQ(r.safety.release(kPush).wrench(), Wrench{});
  EXPECT_EQ(SafeWrench{}.wrench(), Wrench{});
}

TEST(Safety, PassesNothingBeforeItIsOnHomedAndHeld) {
  Safety safety{SafetySettings{}};
  const auto force = [&](const Observation& o) {
    safety.observe(o);
    return glm::length(safety.release(kPush).wrench().force);
  };
  for (int k = 0; k < 10; ++k) EXPECT_EQ(force(good()), 0);
  EXPECT_EQ(safety.state(), ForceState::Off);
  safety.switch_on();
  Observation o = good();
  o.homed = false;
  for (int k = 0; k < 10; ++k) EXPECT_EQ(force(o), 0);
  EXPECT_EQ(safety.state(), ForceState::Homing);
  o.homed = true, o.dead_man = false;
  for (int k = 0; k < 10; ++k) EXPECT_EQ(force(o), 0);
  EXPECT_EQ(safety.state(), ForceState::Ready);
  EXPECT_GT(force(good()), 0);
  EXPECT_EQ(safety.state(), ForceState::Ramp);
  EXPECT_EQ(safety.log().count(), 0u);
}

struct Fault {
  Cause cause;
  std::function<void(Observation&)> spoil;
  double value;
};

std::vector<Fault> faults() {
  return {{Cause::BadTime, [](Observation& o) { o.dt = -1e-3; }, -1e-3},
          {Cause::BadTime, [](Observation& o) { o.dt = INFINITY; }, INFINITY},
          {Cause::NotFinite, [](Observation& o) { o.pose.tip.y = NAN; }, 0},
          {Cause::NotFinite, [](Observation& o) { o.pose.axis.z = INFINITY; }, 0},
          {Cause::NotFinite, [](Observation& o) { o.twist.angular.x = NAN; }, 0},
          {Cause::NotFinite, [](Observation& o) { o.age = NAN; }, 0},
          {Cause::NotFinite, [](Observation& o) { o.redundancy = NAN; }, 0},
          {Cause::DeviceFault, [](Observation& o) { o.device_fault = 7; }, 7},
          {Cause::DeviceLate, [](Observation& o) { o.device_fault = 13, o.device_late = true; }, 13},
          {Cause::NotHomed, [](Observation& o) { o.homed = false; }, 0},
          {Cause::Redundancy, [](Observation& o) { o.redundancy = -0.6; }, -0.6},
          {Cause::Jump, [](Observation& o) { o.pose.tip = {0, 0, 5}; }, 5},
          {Cause::Jump, [](Observation& o) { o.pose.axis = {1, 0, 0}; }, 1.5707963267948966},
          {Cause::Overspeed, [](Observation& o) { o.twist.linear = {0, 1001, 0}; }, 1001},
          {Cause::Overspeed, [](Observation& o) { o.twist.angular = {0, 25, 0}; }, 25},
          {Cause::LateTick, [](Observation& o) { o.dt = 0.04; }, 0.04},
          {Cause::Stale, [](Observation& o) { o.age = 0.021; }, 0.021}};
}

TEST(Safety, TheOutputStatesHowFarTheGateIsOpen) {
  Running r;
  r.safety.observe(good());
  const SafeWrench nothing = r.safety.release({});
  EXPECT_TRUE(nothing.open()) << "and it was only asked for nothing";
  EXPECT_EQ(nothing.gain(), 1);
  EXPECT_FALSE(r.safety.release({}).open()) << "without checks in the same tick";
  Observation o = good();
  o.dead_man = false;
  r.safety.observe(o);
  const SafeWrench falls = r.safety.release({{1, 0, 0}, {}});
  EXPECT_TRUE(falls.open());
  EXPECT_EQ(falls.wrench().force.x, falls.gain());
  for (int k = 0; k < 20; ++k) r.safety.observe(o);
  EXPECT_FALSE(r.safety.release({{1, 0, 0}, {}}).open());
  r.safety.observe(good());
  const SafeWrench ramp = r.safety.release({{1, 0, 0}, {}});
  EXPECT_TRUE(ramp.open());
  EXPECT_EQ(ramp.wrench().force.x, ramp.gain());
  r.safety.observe(good());
  EXPECT_FALSE(r.safety.release({{NAN, 0, 0}, {}}).open());
  EXPECT_FALSE(SafeWrench().open());
}

TEST(Safety, AnInterruptionRestartsTheRampAndKeepsTrips) {
  Running r;
  r.safety.interrupt();
  Observation there = good();
  there.pose.tip += Vec3(50, 0, 0);
  EXPECT_LT(glm::length(r.tick(there).force), 0.01);
  EXPECT_EQ(r.safety.state(), ForceState::Ramp);
  there.pose.tip += Vec3(50, 0, 0);
  r.tick(there);
  EXPECT_EQ(r.safety.cause(), Cause::Jump);
  r.safety.interrupt();
  r.tick(there);
  EXPECT_EQ(r.safety.state(), ForceState::Tripped);
}

TEST(Safety, EveryFaultTripsWithinTheTickAndIsRecorded) {
  for (const Fault& fault : faults()) {
    Running r;
    ASSERT_EQ(r.safety.state(), ForceState::Active);
    Observation o = good();
    fault.spoil(o);
    EXPECT_EQ(r.tick(o), Wrench{}) << sentence(fault.cause);
    EXPECT_EQ(r.safety.state(), ForceState::Tripped);
    EXPECT_EQ(r.safety.cause(), fault.cause);
    ASSERT_EQ(r.safety.log().count(), 1u);
    const Trip trip = r.last_trip();
    EXPECT_EQ(trip.cause, fault.cause);
    EXPECT_EQ(trip.state, ForceState::Active);
    EXPECT_DOUBLE_EQ(trip.value, fault.value);
    EXPECT_NEAR(trip.time, 0.6 + (o.dt > 0 && o.dt < 1 ? o.dt : 0), 1e-9);
    // While it lasts, nothing; one record for one fault.
    for (int k = 0; k < 2000; ++k) EXPECT_EQ(r.tick(fault.cause == Cause::Jump ? good() : o), Wrench{});
  }
}

TEST(Safety, ReturnsThroughTheRampAfterAFaultThatHeals) {
  for (const Fault& fault : faults()) {
    Running r;
    Observation o = good();
    fault.spoil(o);
    r.tick(o);
    double last = 0;
    int silent = 0;
    for (int k = 0; k < 3000; ++k) {
      const double force = glm::length(r.tick(good()).force);
      EXPECT_LE(force - last, 3 * 1e-3 / SafetySettings{}.ramp + 1e-12);
      if (force == 0) ++silent;
      last = force;
    }
    if (heals(fault.cause)) {
      EXPECT_EQ(last, 3);
      EXPECT_NEAR(silent, 500, 2) << "the rest of half a second";
      EXPECT_EQ(r.safety.cause(), Cause::None);
    } else {
      EXPECT_EQ(silent, 3000) << sentence(fault.cause);
      r.safety.reset();
      for (int k = 0; k < 600; ++k) r.tick(good());
      EXPECT_EQ(r.safety.state(), ForceState::Active) << sentence(fault.cause);
    }
  }
}

TEST(Safety, AMoreSevereFaultReplacesOneThatHeals) {
  Running r;
  Observation o = good();
  o.twist.linear = {2000, 0, 0};
  r.tick(o);
  o = good(), o.redundancy = 2;
  r.tick(o);
  EXPECT_EQ(r.safety.cause(), Cause::Redundancy);
  EXPECT_EQ(r.safety.log().count(), 2u);
  for (int k = 0; k < 2000; ++k) r.tick(good());
  EXPECT_EQ(r.safety.state(), ForceState::Tripped);
}

TEST(Safety, AWrenchThatIsNotANumberTripsAndIsZero) {
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)})
    for (int k = 0; k < kCoordinates; ++k) {
      Running r;
      Wrench w = kPush;
      w[k] = bad;
      EXPECT_EQ(r.tick(good(), w), Wrench{});
      EXPECT_EQ(r.safety.cause(), Cause::BadWrench);
    }
  Running r;
  EXPECT_EQ(r.tick(good(), {{21, 0, 0}, {}}), Wrench{});
  EXPECT_EQ(r.last_trip().cause, Cause::Excess);
  EXPECT_EQ(r.last_trip().value, 21);
}

TEST(Safety, StaleDataFadesToZeroInTheStatedTime) {
  const SafetySettings settings;
  Running r;
  double last = 3;
  for (int k = 0; k <= 20; ++k) {
    Observation o = good();
    o.age = k * 1e-3;
    const double force = glm::length(r.tick(o).force);
    EXPECT_LE(force, last);
    EXPECT_NEAR(force, 3 * std::clamp(1 - (o.age - settings.fresh) / settings.fade, 0.0, 1.0), 1e-12);
    EXPECT_EQ(r.safety.state(), k <= 3 ? ForceState::Active : k < 20 ? ForceState::Degraded : ForceState::Tripped);
    last = force;
  }
  EXPECT_EQ(last, 0);
  EXPECT_EQ(r.last_trip().cause, Cause::Stale);
  EXPECT_EQ(r.last_trip().state, ForceState::Degraded);
}

TEST(Safety, AfterAShortGapTheForceGrowsBackAlongTheRamp) {
  Running r;
  Observation o = good();
  o.age = 11.5e-3;
  EXPECT_NEAR(glm::length(r.tick(o).force), 1.5, 1e-9);
  double last = 1.5;
  int ticks = 0;
  for (; r.safety.state() == ForceState::Degraded; ++ticks) {
    const double force = glm::length(r.tick(good()).force);
    EXPECT_NEAR(force - last, last < 3 - 7e-3 ? 6e-3 : force - last, 1e-9);
    last = force;
    ASSERT_LT(ticks, 1000);
  }
  EXPECT_NEAR(ticks, 250, 1);
  EXPECT_EQ(r.safety.log().count(), 0u);
}

TEST(Safety, LateTicksFadeTheForceAndTripAtTheEnd) {
  const SafetySettings settings;
  for (const double dt : {2e-3, 3e-3, 4e-3, 10e-3, 19e-3, 20e-3, 25e-3, 40e-3}) {
    Running r;
    Observation o = good();
    o.dt = dt;
    const double force = glm::length(r.tick(o).force);
    EXPECT_NEAR(force, 3 * std::clamp(1 - (dt - settings.fresh) / settings.fade, 0.0, 1.0), 1e-12) << dt;
    EXPECT_EQ(r.safety.state() == ForceState::Tripped, dt >= 0.02) << dt;
  }
}

TEST(Safety, ATickOfNoTimeIsNoFaultAndNoProgress) {
  Safety safety{SafetySettings{}};
  safety.switch_on();
  Observation o = good();
  for (int k = 0; k < 100; ++k) safety.observe(o), safety.release(kPush);
  const double gain = safety.gain();
  o.dt = 0;
  for (int k = 0; k < 100; ++k) safety.observe(o), safety.release(kPush);
  EXPECT_EQ(safety.gain(), gain);
  EXPECT_EQ(safety.state(), ForceState::Ramp);
}

TEST(Safety, LettingGoEndsTheForceWithoutAJumpAndPressingAgainRamps) {
  Running r;
  Observation o = good();
  o.dead_man = false;
  const double step = 3 * 1e-3 / SafetySettings{}.fall;
  for (int k = 1; k <= 19; ++k) {
    EXPECT_NEAR(glm::length(r.tick(o).force), 3 - k * step, 1e-12);
    EXPECT_TRUE(r.safety.falling());
  }
  r.tick(o);
  EXPECT_EQ(r.tick(o), Wrench{});
  EXPECT_FALSE(r.safety.falling());
  EXPECT_EQ(r.safety.state(), ForceState::Ready);
  EXPECT_EQ(r.safety.cause(), Cause::NoDeadMan);
  EXPECT_EQ(r.last_trip().cause, Cause::NoDeadMan);
  EXPECT_NEAR(glm::length(r.tick(good()).force), 3 * 2e-3, 1e-12);
  EXPECT_EQ(r.safety.cause(), Cause::None);
}

TEST(Safety, LettingGoDuringTheRampFallsFromThere) {
  Safety safety{SafetySettings{}};
  safety.switch_on();
  for (int k = 0; k < 100; ++k) safety.observe(good());
  const double gain = safety.gain();
  EXPECT_NEAR(gain, 0.2, 1e-12);
  Observation o = good();
  o.dead_man = false;
  for (double last = gain; safety.observe(o), safety.falling(); last = safety.gain())
    EXPECT_NEAR(last - safety.gain(), 1e-3 / SafetySettings{}.fall, 1e-12);
}

TEST(Safety, APressWaitsForTheEndOfAFall) {
  Running r;
  Observation o = good();
  o.dead_man = false;
  double last = glm::length(r.tick(o).force);
  for (int k = 0; k < 40; ++k) {
    const double force = glm::length(r.tick(good()).force);
    EXPECT_LE(std::abs(force - last), 3 * 1e-3 / SafetySettings{}.fall + 1e-12);
    last = force;
  }
  EXPECT_EQ(r.safety.state(), ForceState::Ramp);
}

TEST(Safety, AFailedCheckEndsAFallAtOnce) {
  for (const Fault& fault : faults()) {
    Running r;
    Observation o = good();
    o.dead_man = false;
    ASSERT_FALSE(r.tick(o) == Wrench{});
    fault.spoil(o);
    EXPECT_EQ(r.tick(o), Wrench{}) << sentence(fault.cause);
    EXPECT_FALSE(r.safety.falling());
    EXPECT_EQ(r.safety.state(), ForceState::Tripped);
  }
  Running r;
  Observation o = good();
  o.dead_man = false;
  r.tick(o), r.safety.interrupt();
  EXPECT_EQ(r.tick(o), Wrench{}) << "after a gap";
}

TEST(Safety, AMoveThatTheSpeedExplainsIsNoJump) {
  Running r;
  Observation o = good();
  for (int k = 1; k < 100; ++k) {
    o.pose.tip = {0.9 * k, 1e5, 0}, o.twist.linear = {900, 0, 0};
    if (k == 1) {
      // To 1e5 mm and on is a jump; from there on it is a move.
      r.tick(o);
      EXPECT_EQ(r.safety.cause(), Cause::Jump);
      r.safety.reset();
      continue;
    }
    EXPECT_FALSE(r.tick(o) == Wrench{}) << k;
  }
}

TEST(Safety, ADeviceThatIsHomedInABadStateGetsNoForce) {
  for (const Fault& fault : faults()) {
    if (fault.cause == Cause::NotHomed || fault.cause == Cause::Jump) continue;  // what homing is for
    Safety safety{SafetySettings{}};
    safety.switch_on();
    Observation o = good();
    fault.spoil(o);
    for (int k = 0; k < 3; ++k) {
      safety.observe(o);
      EXPECT_EQ(safety.release(kPush).wrench(), Wrench{}) << sentence(fault.cause);
    }
    EXPECT_EQ(safety.cause(), fault.cause);
  }
}

TEST(Safety, ForceAlwaysMeansThatEveryCheckPassed) {
  stress::Random random(1);
  const SafetySettings s;
  SafetySettings quick = s;
  quick.ramp = quick.rest = 5e-3;
  Safety safety(quick);
  Vec3 tip{0}, last_tip{0};
  bool last_known = false;
  long forces = 0, trips = 0, falling = 0;
  double last_gain = 0;
  const std::vector<Fault> kinds = faults();
  for (int k = 0; k < 300'000; ++k) {
    if (random.one_in(200)) safety.switch_on();
    if (random.one_in(3000)) safety.interrupt();
    if (random.one_in(30)) safety.reset();
    Observation o = good();
    o.dead_man = !random.one_in(40);
    o.dt = random.one_in(30) ? random.uniform(0, 0.03) : 1e-3;
    o.age = random.one_in(30) ? random.uniform(0, 0.03) : 1e-3;
    o.pose.tip = tip = tip + random.uniform(0, random.one_in(100) ? 10 : 1) * random.direction();
    o.twist.linear = random.uniform(0, random.one_in(100) ? 2000 : 900) * random.direction();
    if (random.one_in(40)) kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))].spoil(o);
    Wrench wanted = kPush;
    if (random.one_in(100)) wanted[random.below(6)] = random.one_in(2) ? double(NAN) : 1e4;
    const ForceState state = safety.observe(o);
    const Wrench w = safety.release(wanted).wrench();
    if (!(w == Wrench{})) {
      ++forces;
      const bool falls = safety.falling();
      falling += falls;
      ASSERT_TRUE(falls ? state == ForceState::Ready : lets_force_through(state) && o.dead_man);
      ASSERT_TRUE(!falls || safety.gain() <= last_gain);
      ASSERT_EQ(state, safety.state());
      ASSERT_TRUE(finite(w) && finite(wanted) && o.homed && !o.device_fault && o.dt >= 0);
      ASSERT_TRUE(geom::finite(o.pose.tip) && geom::finite(o.pose.axis) && finite(o.twist));
      ASSERT_LT(std::max(o.age, o.dt), s.fresh + s.fade);
      ASSERT_LT(glm::length(o.twist.linear), s.overspeed.linear);
      ASSERT_LT(glm::length(o.twist.angular), s.overspeed.angular);
      ASSERT_LE(std::abs(o.redundancy), s.redundancy);
      if (last_known) {
        ASSERT_LE(glm::length(o.pose.tip - last_tip), s.jump.linear + s.overspeed.linear * o.dt + 1e-9);
      }
      ASSERT_LE(glm::length(w.force), safety.gain() * 3 + 1e-12);
    }
    last_gain = safety.gain();
    // Where it was while off or not homed says nothing.
    if (geom::finite(o.pose.tip)) last_tip = o.pose.tip, last_known = o.homed && state != ForceState::Off;
    last_known = last_known && state != ForceState::Off;
    trips += state == ForceState::Tripped;
  }
  EXPECT_GT(forces, 10'000);
  EXPECT_GT(falling, 1'000);
  EXPECT_GT(trips, 10'000);
  EXPECT_GT(safety.log().count(), 1000u);
}

TEST(Safety, SettingsNameTheFieldThatIsWrong) {
  const auto message = [](auto change) {
    SafetySettings s;
    change(s);
    return test::error_of([&] { Safety safety(s); });
  };
  EXPECT_EQ(message([](auto& s) { s.ramp = 0; }), "ramp must be positive");
  EXPECT_EQ(message([](auto& s) { s.rest = NAN; }), "rest must not be negative");
  EXPECT_EQ(message([](auto& s) { s.overspeed.angular = -1; }), "overspeed.angular must be positive");
  EXPECT_EQ(message([](auto& s) { s.wrench_ceiling.linear = INFINITY; }), "wrench_ceiling.linear must be positive");
}

}  // namespace
}  // namespace riffler::haptics::safety_test
