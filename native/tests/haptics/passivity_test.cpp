#include "riffler/haptics/passivity.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "riffler/haptics/coupling.hpp"
#include "stress/passive_bound.hpp"
#include "stress/stability.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::haptics::passivity_test {
namespace {

using stress::Column;

/// Exact positions and ticks, and a device that takes nothing.
PassivitySettings strict(Bounds acceleration) {
  PassivitySettings s;
  s.jitter = 0, s.acceleration = acceleration, s.resolution = {0, 0};
  return s;
}

TEST(Passivity, AccountIsTheSumOfWrenchTimesDisplacement) {
  stress::Random random(1);
  PassivitySettings s = strict({1e5, 1e3});
  s.reserve = 1e3, s.storage = 1e9;
  Passivity passivity(s);
  long double sum = 0;
  for (int n = 0; n < 100'000; ++n) {
    Wrench held;
    Twist moved;
    for (int k = 0; k < kCoordinates; ++k) {
      held[k] = random.uniform(-5, 5), moved[k] = random.uniform(-0.1, 0.1);
      sum -= static_cast<long double>(held[k]) * moved[k];
    }
    passivity.observe(held, moved, 1e-3);
  }
  EXPECT_NEAR(passivity.energy(), s.reserve + static_cast<double>(sum), 1e-9);
}

TEST(Passivity, TheWorstHandWithinTheBoundsNeverCausesADebt) {
  // The hand knows the wrench that is held and goes with it as far as its acceleration lets it, in every coordinate.
  stress::Random random(2);
  for (int session = 0; session < 20; ++session) {
    const Bounds a{random.power_of_ten(3, 6), random.power_of_ten(1, 4)};
    PassivitySettings s = strict(a);
    s.reserve = session % 3 == 0 ? 0 : random.power_of_ten(-3, 1);
    Passivity passivity(s);
    Capability device;
    device.axes[2] = random.direction(), device.axes[0] = random.square_to(device.axes[2]);
    device.axes[1] = glm::cross(device.axes[2], device.axes[0]);
    device.push[5] = session % 2 == 0;
    Twist step;  // along the device's axes
    Wrench held;
    long double delivered = 0;
    for (int n = 0; n < 5000; ++n) {
      const Wrench local{held.force * device.axes, held.torque * device.axes};
      for (int k = 0; k < kCoordinates; ++k) {
        const double with = local[k] != 0 ? std::copysign(1.0, local[k]) : random.uniform(-1, 1);
        // Now and then it moves off again, to be able to come back with a run.
        const double way = random.one_in(4) ? -with : with;
        step[k] = std::clamp(step[k] + way * a[k] * 1e-6, -300 * a[k] * 1e-6, 300 * a[k] * 1e-6);
      }
      const Twist moved{device.axes * step.linear, device.axes * step.angular};
      for (int k = 0; k < kCoordinates; ++k) delivered += static_cast<long double>(held[k]) * moved[k];
      passivity.observe(held, moved, 1e-3);
      ASSERT_GE(passivity.energy(), -1e-9) << session << " " << n;
      ASSERT_LE(delivered, s.reserve + 1e-9L) << session << " " << n;
      held = passivity.control(
          renderable(device, {random.uniform(0, 10) * random.direction(), random.uniform(0, 300) * random.direction()}),
          device);
    }
  }
}

struct Scene {
  const char* name;
  stress::WallDevice device;
  Column normal;
  double bound;
  Bounds acceleration;
};

std::vector<Scene> scenes() {
  const stress::CoupledScene five = stress::coupled_scene(3);
  return {{"one coordinate", stress::wall_device(1.5e-4, 2e-3), {1.0}, 4, {9.5e4, 0}},
          {"five coordinates", five.device, five.normal, 2 * five.damping / 1e-3, {3e5, 1.5e4}}};
}

TEST(Passivity, WallsFarBeyondThePassiveBoundGiveNoEnergy) {
  for (const Scene& scene : scenes())
    for (const double times : {0.5, 1.5, 5.0, 30.0, 100.0}) {
      if (test::kSanitized && times > 1 && times < 100) continue;
      const stress::SimulatedWall wall{scene.normal, times * scene.bound, 0, true, 10};
      const stress::Session session{100'000, 2, static_cast<std::uint64_t>(10 * times)};
      const PassivitySettings settings = strict(scene.acceleration);
      const stress::SessionResult on = press(scene.device, wall, session, settings);
      EXPECT_EQ(on.unforeseen, 0) << scene.name << ", " << times;
      EXPECT_LE(on.delivered, settings.reserve + 1e-9) << scene.name << ", " << times;
      EXPECT_GE(on.least_energy, -1e-9) << scene.name << ", " << times;
      // Without it the same session does.
      EXPECT_GT(press(scene.device, wall, {10'000, 2, session.seed}, {}).delivered, 10 * settings.reserve)
          << scene.name << ", " << times;
    }
}

TEST(Passivity, QuantisationHidesNoMoreThanItsStepTimesTheChangeOfForce) {
  for (const double step : {0.005, 0.02, 0.1}) {
    const stress::WallDevice device = stress::wall_device(1.5e-4, 2e-3, 0.2, step);
    PassivitySettings settings = strict({9e4, 0});
    settings.resolution = {step, 0};
    for (const double times : {1.0, 10.0}) {
      const stress::SessionResult r =
          press(device, {{1.0}, 4 * times, 0, true, 10}, {test::cases(100'000, 20), 2, 5}, settings);
      EXPECT_EQ(r.unforeseen, 0);
      EXPECT_LE(r.measured_delivered, settings.reserve + 1e-9);
      EXPECT_LE(r.delivered, settings.reserve + r.variation + 1e-9);
    }
  }
}

TEST(Passivity, WallsWithinThePassiveBoundStayUnchanged) {
  // The device's own damping, credited, is what makes them passive: (2.13) is when the account never falls.
  PassivitySettings settings = strict({9e4, 0});
  settings.device_damping = {2e-3, 0};
  for (const double times : {0.1, 0.5, 0.9, 0.99}) {
    const stress::SimulatedWall wall{{1.0}, 4 * times, 0, true, 10};
    const stress::WallDevice device = stress::wall_device(1.5e-4, 2e-3);
    const stress::Session session{50'000, 2, 3, false};
    const stress::SessionResult on = press(device, wall, session, settings), off = press(device, wall, session, {});
    EXPECT_EQ(on.depth, off.depth) << times;
    EXPECT_EQ(on.delivered, off.delivered) << times;
    EXPECT_GT(on.least_energy, 0.98 * settings.reserve) << times;
  }
}

TEST(Passivity, DefaultsDoNotChangeACouplingOnAnOrdinaryDevice) {
  // Damping, friction and encoder as docs/stability.md takes them for the pen; half of them credited.
  const CouplingSettings coupling;
  PassivitySettings settings;
  settings.device_damping.linear = 1e-3, settings.device_friction.linear = 0.1;
  const stress::SimulatedWall wall{{1.0}, coupling.stiffness, coupling.damping, true, 10};
  const auto r = press(stress::wall_device(1.5e-4, 2e-3, 0.2, 0.0236), wall, {100'000, 2, 3}, settings);
  EXPECT_EQ(r.touched, 0);
  EXPECT_EQ(r.unforeseen, 0);
}

TEST(Passivity, CreditsTheDeviceNoMoreThanItTakesAndNotMuchLess) {
  stress::Random random(6);
  PassivitySettings settings = strict({1e6, 1e3});
  settings.resolution = {0.01, 0}, settings.device_friction = {0.2, 0}, settings.device_damping = {1e-3, 0};
  settings.storage = 1e9;
  for (const double speed : {2.0, 20.0, 200.0}) {
    Passivity passivity(settings);
    long double taken = 0;
    double x = 0, measured = 0, v = 0;
    for (int n = 0; n < 50'000; ++n) {
      if (n % 400 == 0) v = random.uniform(-speed, speed);
      x += v * 1e-3;
      taken += static_cast<long double>(0.2 * std::abs(v) + 1e-3 * v * v) * 1e-3L;
      const double now = 0.01 * std::floor(x / 0.01 + 0.5);
      // A wrench so small that it moves no energy, so that nothing is forgotten.
      passivity.observe({{1e-300, 0, 0}, {}}, {{now - measured, 0, 0}, {}}, 1e-3);
      measured = now;
    }
    const double credit = passivity.energy() - settings.reserve;
    EXPECT_LE(credit, static_cast<double>(taken));
    EXPECT_GT(credit, 0.7 * static_cast<double>(taken)) << speed;
  }
}

TEST(Passivity, CoordinatesOfAPassiveObjectMayGiveForEverTheEnergyThatOthersTake) {
  // A spring whose principal axes are not the coordinates, and a damper, on an elliptic path.
  PassivitySettings settings = strict({1e5, 1e3});
  settings.reserve = 5;  // the path begins on the stretched spring
  Passivity passivity(settings);
  const double k11 = 1, k22 = 3, k12 = 0.8, b = 1e-4;
  Twist last{{1, 0, 0}, {}};
  Wrench held;
  std::array<double, 2> given{};  // N·mm by the hand, along x and y
  for (int n = 0; n < 100'000; ++n) {
    const double angle = 2 * 3.141592653589793 * n / 1000;
    const Twist now{{std::cos(angle), 0.5 * std::sin(angle), 0}, {}};
    passivity.observe(held, now - last, 1e-3);
    for (int k = 0; k < 2; ++k) given[static_cast<std::size_t>(k)] -= held[k] * (now - last)[k];
    const Vec3 v = 1e3 * (now - last).linear;
    held = {{-k11 * now[0] - k12 * now[1] - b * v.x, -k12 * now[0] - k22 * now[1] - b * v.y, 0}, {}};
    held = passivity.control(held, {});
    ASSERT_EQ(passivity.kept(), 1);
    ASSERT_EQ(passivity.damped(), 0);
    last = now;
  }
  // Per turn: k12 times the area π · 1 · ½, and the damper's share.
  EXPECT_NEAR(given[0], -100 * 0.8 * 1.5708, 2);
  EXPECT_GT(given[1], 100);
}

TEST(Passivity, ADebtIsPaidBeforeAnythingIsDelivered) {
  const PassivitySettings s = strict({1e4, 1e2});
  Passivity passivity(s);
  passivity.observe({{5, 0, 0}, {}}, {{10, 0, 0}, {}}, 40e-3);  // a late tick: the grip was carried off
  EXPECT_DOUBLE_EQ(passivity.energy(), s.reserve - 50);
  // Moving with the force: nothing of it, and damping against the motion.
  passivity.observe({}, {{0.2, 0, 0}, {}}, 1e-3);
  const Wrench w = passivity.control({{5, 0, 0}, {}}, {});
  EXPECT_EQ(passivity.kept(), 0);
  EXPECT_EQ(passivity.damped(), 1);
  EXPECT_DOUBLE_EQ(w.force.x, -s.max_damping.linear * 200);
  // A wall that stops the hand takes energy, and is let through.
  passivity.observe({}, {{-0.2, 0, 0}, {}}, 1e-3);
  passivity.observe({}, {{-0.2, 0, 0}, {}}, 1e-3);
  EXPECT_GT(passivity.control({{5, 0, 0}, {}}, {}).force.x, 5 - 1e-12);
  // Rest, and free motion, forgive nothing.
  for (int k = 0; k < 1000; ++k) passivity.observe({}, {{0.1, 0, 0}, {}}, 1e-3);
  EXPECT_DOUBLE_EQ(passivity.energy(), s.reserve - 50);
  passivity.reset();
  EXPECT_EQ(passivity.energy(), s.reserve);
}

/// Least account while a hand goes into a wall of 10 N/mm and out again, 2 mm deep and ten times a second, with a
/// device that changes its force by 100 N/s only. `known`: to the controller.
double least_account_of_a_slow_device(bool known) {
  constexpr double kRate = 100;  // N/s
  PassivitySettings s;
  s.latency = 2e-3;
  if (known) s.device_rate = {kRate, 0};
  Passivity passivity(s);
  Wrench applied, on_cable;
  double last = 0, least = kInfinity;
  for (int n = 0; n < 5000; ++n) {
    const double depth = 1 - std::cos(20 * kPi * 1e-3 * n);
    passivity.observe(applied, {{0, 0, last - depth}, Vec3(0)}, 1e-3);
    least = std::min(least, passivity.energy());
    last = depth;
    const Wrench passed = passivity.control({{0, 0, 10 * depth}, Vec3(0)}, {});
    applied.force.z += std::clamp(on_cable.force.z - applied.force.z, -1e-3 * kRate, 1e-3 * kRate);
    on_cable = passed;
  }
  return least;
}

/// A force that the device lets fall slowly still gives energy after zero was passed. The controller estimates it by
/// the rate of the moment, and this hand turns back faster than that: the debt is half as large, not none.
TEST(Passivity, AForceThatTheDeviceLetsFallSlowlyCountsUntilItIsGone) {
  EXPECT_GT(least_account_of_a_slow_device(true), -0.9);
  EXPECT_LT(least_account_of_a_slow_device(false), -1.4);
}

TEST(Passivity, CreditIsForgottenWhereNothingCanHoldIt) {
  const PassivitySettings s = strict({1e5, 1e3});
  Passivity passivity(s);
  for (int k = 0; k < 1000; ++k) passivity.observe({{-5, 0, 0}, {}}, {{0.1, 0, 0}, {}}, 1e-3);
  EXPECT_EQ(passivity.energy(), s.storage);
  passivity.observe({}, {{0.1, 0, 0}, {}}, 1e-3);
  EXPECT_EQ(passivity.energy(), s.reserve);
}

TEST(Passivity, DampsOnlyWhatTheDevicePushesAndWhereTheDirectionIsSure) {
  PassivitySettings s;  // steps of 0.03 mm, 100 m/s²
  Passivity passivity(s);
  Capability pen;
  pen.push[5] = false;
  passivity.observe({{100, 0, 0}, {}}, {{1, 0, 0}, {}}, 1e-3);  // a debt
  passivity.observe({}, {{0.05, 0.3, 0}, {0, 0.004, 0.02}}, 1e-3);
  const Wrench w = passivity.control({{3, 1, 1}, {100, 0, 0}}, pen);
  EXPECT_EQ(w.force.x, 0) << "0.05 mm in a tick may be noise";
  EXPECT_LT(w.force.y, 0);
  EXPECT_EQ(w.torque, Vec3(0)) << "0.004 rad may be noise, and about z nothing pushes";
  for (int k = 0; k < kCoordinates; ++k) EXPECT_LE(std::abs(w[k]), s.max_damping[k] * 300 + 1e-12);
}

TEST(Passivity, SurvivesTicksOfNoTimeAndNan) {
  Passivity passivity{PassivitySettings{}};
  passivity.observe({}, {{0.1, 0, 0}, {}}, 0);
  passivity.observe({{NAN, 0, 0}, {}}, {}, 1e-3);
  passivity.observe({}, {{NAN, 0, 0}, {}}, 1e-3);
  passivity.observe({}, {}, NAN);
  EXPECT_EQ(passivity.energy(), PassivitySettings{}.reserve);
  EXPECT_TRUE(finite(passivity.control({{1, 0, 0}, {}}, {})));
  EXPECT_EQ(passivity.control({}, {}), Wrench{});
  EXPECT_FALSE(finite(passivity.control({{NAN, 0, 0}, {}}, {}))) << "is the gate's to refuse";
}

TEST(Passivity, SettingsNameTheFieldThatIsWrong) {
  const auto message = [](auto change) {
    PassivitySettings s;
    change(s);
    return test::error_of([&] { Passivity passivity(s); });
  };
  EXPECT_EQ(message([](auto& s) { s.period = 0; }), "period must be positive");
  EXPECT_EQ(message([](auto& s) { s.acceleration.angular = NAN; }), "acceleration.angular must not be negative");
  EXPECT_EQ(message([](auto& s) { s.storage = 0.5; }), "storage must be at least reserve");
}

TEST(PassiveBound, IsTheSmallerOfTheBoundsOfSamplingAndQuantisation) {
  const PassiveStiffness k = passive_stiffness({1e-3, 2e-3, 0.2, 0.02});
  EXPECT_DOUBLE_EQ(k.sampling, 4);
  EXPECT_DOUBLE_EQ(k.quantisation, 20);
  EXPECT_DOUBLE_EQ(k.least(), 4);
  EXPECT_DOUBLE_EQ(passive_stiffness({1e-3, 2e-3, 0.2, 0.02}, -1.5e-3).sampling, 1);
  EXPECT_EQ(passive_stiffness({1e-3, 2e-3, 0.2, 0.02}, 3e-3).sampling, 0);
  EXPECT_EQ(passive_stiffness({1e-3, 2e-3, 0, 0.02}).least(), 0);
  EXPECT_EQ(passive_stiffness({1e-3, 2e-3, 0, 0}).quantisation, INFINITY);
  EXPECT_EQ(test::error_of([] { passive_stiffness({0, 1, 1, 1}); }), "period must be positive");
  EXPECT_EQ(test::error_of([] { passive_stiffness({1e-3, 1, -1, 1}); }), "friction must not be negative");
}

TEST(Passivity, LossesOfTheDeviceAreCreditedUpToTheStoredEnergy) {
  PassivitySettings settings;
  settings.device_damping = settings.device_friction = {0, 0};
  Passivity passivity(settings);
  const Wrench pull{{-1, 0, 0}, {}};
  passivity.observe(pull, {{0, 0, 0}, {}}, 1e-3, 3);
  EXPECT_DOUBLE_EQ(passivity.energy(), settings.reserve + 3);
  passivity.observe(pull, {{0, 0, 0}, {}}, 1e-3, -5);
  passivity.observe(pull, {{0, 0, 0}, {}}, 1e-3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_DOUBLE_EQ(passivity.energy(), settings.reserve + 3) << "a device never gives by friction";
  passivity.observe(pull, {{0, 0, 0}, {}}, 1e-3, 1e6);
  EXPECT_EQ(passivity.energy(), settings.storage);
  passivity.observe({}, {{0, 0, 0}, {}}, 1e-3, 1);
  EXPECT_EQ(passivity.energy(), settings.reserve) << "without contact nothing is stored";
}

}  // namespace
}  // namespace riffler::haptics::passivity_test
