// The parts together, as haptics/safety.hpp calls them in one tick.
#include <gtest/gtest.h>

#include "riffler/haptics/coupling.hpp"
#include "riffler/haptics/limits.hpp"
#include "riffler/haptics/passivity.hpp"
#include "riffler/haptics/safety.hpp"
#include "stress/random.hpp"
#include "support/allocations.hpp"

namespace riffler::haptics::tick_test {
namespace {

/// A device without motors to speak of, a tool that is held in place, and all that is between.
class Loop {
 public:
  explicit Loop(const Vec3& where = Vec3(0), const CouplingSettings& coupling = {})
      : coupling_(coupling),
        passivity_(PassivitySettings{}),
        safety_(SafetySettings{}),
        tool_{where, {0, 0, 1}},
        last_(tool_) {
    safety_.switch_on();
    capability_.push[5] = false;
  }

  Wrench tick(Observation now) {
    const auto [way, turn] = pose_error(now.pose, last_);
    const Twist displacement{way, turn};
    last_ = now.pose;
    if (now.dt > 0) now.twist = 1 / now.dt * displacement;
    if (!lets_force_through(safety_.observe(now))) w_ = {};
    passivity_.observe(held_.wrench(), displacement, now.dt);
    const auto [on_grip, on_tool, energy] = couple(coupling_, pose_error(now.pose, tool_), now.twist, {});
    w_ = limited(limits_, capability_, w_, on_grip, now.twist, now.dt);
    w_ = passivity_.control(w_, capability_);
    w_ = magnitude_gain(limits_, w_) * w_;
    held_ = safety_.release(w_);
    return held_.wrench();
  }

  const Safety& safety() const { return safety_; }
  const Passivity& passivity() const { return passivity_; }

 private:
  CouplingSettings coupling_;
  LimitSettings limits_;
  Capability capability_;
  Passivity passivity_;
  Safety safety_;
  Pose tool_, last_;
  Wrench w_;
  SafeWrench held_;
};

Observation at(double t) {
  Observation o;
  o.dt = 1e-3, o.age = 1e-4, o.homed = o.dead_man = true;
  o.pose.tip = {2 * std::sin(3 * t), std::sin(2 * t), 0};
  o.pose.axis = glm::normalize(Vec3(0.1 * std::sin(t), 0, 1));
  return o;
}

TEST(HapticTick, AllocatesNothing) {
  const long before = test::allocations();
  const auto* proof = new std::array<int, 100>();
  EXPECT_GT(test::allocations(), before) << "the count counts";
  delete proof;
  Loop loop;
  double sum = 0;
  const long start = test::allocations();
  for (int k = 0; k < 20'000; ++k) {
    Observation o = at(k * 1e-3);
    // Faults of every kind are no reason to allocate.
    if (k % 3000 == 1500) o.dt = 0.03;
    if (k == 9000) o.pose.tip.x = NAN;
    sum += glm::length(loop.tick(o).force);
  }
  EXPECT_EQ(test::allocations(), start);
  EXPECT_GT(sum, 100);
  EXPECT_GE(loop.safety().log().count(), 4u);
}

TEST(HapticTick, LateTicksOfAnyLengthNeverMakeTheForceJumpUp) {
  stress::Random random(1);
  Loop loop;
  double last = 0;
  double t = 0;
  for (int k = 0; k < 100'000; ++k) {
    const double dt = random.one_in(50) ? random.uniform(2e-3, 40e-3) : random.one_in(50) ? 0 : 1e-3;
    t += dt;
    Observation o = at(t);
    o.dt = dt;
    const double force = glm::length(loop.tick(o).force);
    ASSERT_TRUE(std::isfinite(force));
    ASSERT_LE(force - last, LimitSettings{}.rate.linear * dt + 3e-3 / SafetySettings{}.ramp * 5 + 1e-9) << k;
    ASSERT_LE(force, LimitSettings{}.wrench.linear * (1 + 1e-12));
    last = force;
  }
}

TEST(HapticTick, APoseThatIsNotANumberGivesNoForceInThatTickNorAfter) {
  Loop loop;
  for (int k = 0; k < 1000; ++k) loop.tick(at(k * 1e-3));
  EXPECT_GT(glm::length(loop.tick(at(1.0)).force), 0);
  Observation o = at(1.001);
  o.pose.axis.x = NAN;
  EXPECT_EQ(loop.tick(o), Wrench{});
  for (int k = 1002; k < 3000; ++k) EXPECT_EQ(loop.tick(at(k * 1e-3)), Wrench{});
  EXPECT_TRUE(std::isfinite(loop.passivity().energy()));
}

TEST(HapticTick, AMassWithoutAnyDampingGetsNoMoreThanTheReserve) {
  // No stiffness is passive on it. The hand shakes it; ramp, limits and controller stand between it and the coupling.
  for (const double stiffness : {0.5, 5.0, 50.0}) {
    CouplingSettings coupling;
    coupling.stiffness = stiffness;
    Loop loop(Vec3(0), coupling);
    stress::Random random(1);
    const double mass = 1.5e-4, dt = 1e-3;
    Vec3 x(0.5, 0, 0), v(0), hand(0);
    long double delivered = 0;
    double stiffest = 0;
    for (int k = 0; k < 100'000; ++k) {
      Observation o = at(0);
      o.pose = {x, {0, 0, 1}};
      const Vec3 force = loop.tick(o).force;
      stiffest = std::max(stiffest, glm::length(force));
      if (k % 64 == 0) hand = random.uniform(0, 1.5) * random.direction();
      // The hand brakes what is fast, and holds on to what goes off.
      const Vec3 push = hand - 1e-3 * v - 0.05 * x;
      const Vec3 a = (force + push) / mass, way = dt * v + 0.5 * dt * dt * a;
      for (int i = 0; i < 3; ++i) delivered += static_cast<long double>(force[i]) * way[i];
      x += way, v += dt * a;
      ASSERT_LE(delivered, PassivitySettings{}.reserve + 1e-9L) << stiffness << " " << k;
    }
    EXPECT_GT(stiffest, 0.5) << "there was a force";
    EXPECT_EQ(loop.safety().log().count(), 0u);
  }
}

TEST(HapticTick, IsTheSameFarFromTheOrigin) {
  const Vec3 offset(1e5, -1e5, 1e5);
  Loop near, far(offset);
  for (int k = 0; k < 3000; ++k) {
    Observation o = at(k * 1e-3);
    const Wrench here = near.tick(o);
    o.pose.tip += offset;
    EXPECT_LT(glm::length(far.tick(o).force - here.force), 1e-6) << k;
  }
}

}  // namespace
}  // namespace riffler::haptics::tick_test
