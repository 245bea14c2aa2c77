// The whole stack against the simulated pen: what comes back, how late, and the same every time.
#include "pen/simulated/simulated_pen.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "pen/arms/pens.hpp"
#include "pen/arms/wrench_split.hpp"
#include "pen/simulated/simulated_bench.hpp"
#include "stress/matrix.hpp"
#include "support/error_of.hpp"

namespace riffler::pen::simulated_pen_test {
namespace {

using test::SimulatedBench;

SimulatedPenSettings frictionless() {
  SimulatedPenSettings out;
  for (PenChannel& c : out.geometry.channels) c.coulomb = c.viscous = c.gravity = 0;
  out.hand.tremor = 0;
  return out;
}

Wrench upward(double newtons) {
  return {{0, 0, newtons}, {0, 0, 0}};
}

TEST(SimulatedPen, AThousandReportsASecondAreAnsweredAndPush) {
  SimulatedBench b;
  b.step.law = [](const PenSample&, double, double) { return upward(1); };
  b.run(2);
  const LinkCounts counts = b.loop.status().counts;
  EXPECT_NEAR(static_cast<double>(counts.reports), 2000, 3);
  EXPECT_EQ(counts.lost + counts.old + counts.malformed + counts.superseded, 0U);
  EXPECT_EQ(counts.writes, counts.reports + 1);
  EXPECT_EQ(b.pen->firmware().state, RIFFLER_PEN_ACTIVE);
  EXPECT_EQ(b.pen->firmware().link.refused_count, 0);
  EXPECT_EQ(b.step.safety.state(), haptics::ForceState::Active);
  // The hand is a spring: it yields by force over stiffness, less what friction keeps.
  const double way = b.pen->arms().posture().pose.tip.z - b.home.tip.z;
  EXPECT_GT(way, 1.0);
  EXPECT_LT(way, 2.1);
}

TEST(SimulatedPen, TheSameSeedGivesTheSameBytesAndAnotherDoesNot) {
  const auto play = [](std::uint64_t seed) {
    SimulatedPenSettings settings;
    settings.cable = {.jitter_us = 1500, .lost = 0.02, .doubled = 0.02, .merged = 0.05, .lost_out = 0.02, .seed = seed};
    const Pose home = SimulatedPen(settings).arms().posture().pose;
    SimulatedBench b(settings, hand_on_a_curve(home));
    b.step.law = [](const PenSample& s, double, double) { return Wrench{-0.01 * s.velocity, {}}; };
    std::vector<double> out;
    b.step.after = [&](const Wrench& w) {
      out.insert(out.end(), {w.force.x, w.force.y, w.force.z, b.step.last.pose.tip.x, b.step.last.time});
    };
    b.run(3);
    const Vec3 tip = b.pen->arms().posture().pose.tip;
    out.insert(out.end(), {tip.x, tip.y, tip.z, static_cast<double>(b.loop.status().counts.lost)});
    return out;
  };
  const auto first = play(5);
  EXPECT_GT(first.size(), 10000U);
  EXPECT_EQ(first, play(5));
  EXPECT_NE(first, play(6));
}

TEST(SimulatedPen, TheHostReadsTheGripToWithinACount) {
  const Pose home = SimulatedPen(SimulatedPenSettings()).arms().posture().pose;
  SimulatedPenSettings settings;
  settings.cable.latency_us = 0;
  SimulatedBench b(settings, hand_on_a_curve(home));
  double worst = 0, worst_turn = 0;
  bool moved = false;
  const auto truth = [&] { return b.pen->arms().posture().pose; };
  b.step.after = [&](const Wrench&) {
    worst = std::max(worst, glm::distance(b.step.last.pose.tip, truth().tip));
    worst_turn = std::max(worst_turn, glm::length(turn_between(b.step.last.pose.axis, truth().axis)));
    moved |= glm::distance(truth().tip, home.tip) > 10;
    EXPECT_LT(std::abs(b.step.last.stretch), 0.06);
  };
  b.run(6);
  // A count is 2π / 48 000 or 2π / 70 000; half of one, at levers of up to 200 mm, of six joints.
  EXPECT_TRUE(moved);
  EXPECT_LT(worst, 0.03);
  EXPECT_GT(worst, 0.003);
  EXPECT_LT(worst_turn, 0.003);
}

/// From the host's word to the motors: up to the frame's end, and one turn of the firmware.
TEST(SimulatedPen, LatencyFromHostToMotorAndBackIsThatOfTheCable) {
  for (const std::int64_t latency : {125, 400, 2000, 7300}) {
    SimulatedPenSettings settings = frictionless();
    settings.cable.latency_us = latency;
    // Fresh by the driver's clock, which counts from reading.
    SimulatedBench b(settings);
    bool up = true;
    b.step.law = [&](const PenSample&, double, double) { return upward(up ? 0.5 : -0.5); };
    b.run(1.5);
    ASSERT_EQ(b.pen->firmware().state, RIFFLER_PEN_ACTIVE);
    std::int64_t asked = -1, came = -1, sensed_late = -1;
    const std::int16_t before = b.pen->drive().current_ma[1];
    b.pen->on_turn = [&] {
      if (asked >= 0 && came < 0 && b.pen->drive().current_ma[1] != before) came = b.pen->time_us();
    };
    b.step.after = [&](const Wrench&) {
      if (asked >= 0) return;
      asked = std::llround(1e6 * b.now());
      sensed_late = asked % SimulatedPen::kFrame;
    };
    up = false;
    b.run(0.02);
    // Reports are read `latency` after their frame, so that is how old they are, modulo frames …
    EXPECT_EQ(sensed_late, latency % SimulatedPen::kFrame);
    // … and an answer goes with the next frame, and is taken in the turn after it.
    const std::int64_t frame = (asked / SimulatedPen::kFrame + 1) * SimulatedPen::kFrame;
    EXPECT_EQ(came, frame + 250) << latency;
  }
}

/// Age of what the host reads: the grip moves at a known speed, and the host sees where it was.
TEST(SimulatedPen, TheHostSeesTheGripAsItWasALatencyAgo) {
  SimulatedPenSettings settings = frictionless();
  settings.cable.latency_us = 3000;
  const Pose home = SimulatedPen(settings).arms().posture().pose;
  SimulatedBench b(settings, [home](double t) {
    HandWish wish{.pose = home};
    wish.pose.tip.y += 100 * std::max(0.0, t - 0.2);
    return wish;
  });
  b.run(0.5);
  double lag = 0;
  int n = 0;
  b.step.after = [&](const Wrench&) {
    b.catch_up();
    lag += (b.pen->arms().posture().pose.tip.y - b.step.last.pose.tip.y) / b.pen->arms().speed().twist.linear.y;
    ++n;
  };
  b.run(0.1);
  EXPECT_NEAR(lag / n, 3e-3, 1e-4);
}

/// A servo in the host: acceleration −ω² y − 2 ζ ω v of the point along x alone. With the mass that the pen has there,
/// w = M x̂ · acceleration moves nothing else, and the response is that of a double integrator with a force that is held
/// for a frame and comes one frame late: a recursion that is exact.
TEST(SimulatedPen, AServoInTheHostStepsAsTheSampledClosedFormDoes) {
  SimulatedPenSettings settings = frictionless();
  const Pose home = SimulatedPen(settings).arms().posture().pose;
  SimulatedBench b(settings, hand_at(home, 0));  // no hand holds it
  // Wrench per acceleration along x: kinetic energy's derivative, measured by pushing from rest with each coordinate.
  PenDynamics arms(settings.geometry);
  constexpr double kTime = 1e-6;
  const auto answer = [&](const Wrench& w) {
    PenDynamics probe(settings.geometry);
    probe.step({.wrench = w}, kTime);
    const Twist t = probe.speed().twist;
    return std::array<double, 5>{t.linear.x / kTime, t.linear.y / kTime, t.linear.z / kTime, t.angular.x / kTime,
                                 t.angular.y / kTime};
  };
  // Mobility's columns; at home the grip stands upright to 1e-3, so turns square to it are those about x and y.
  stress::Matrix mobility(5, 5);
  for (int k = 0; k < 5; ++k) {
    Wrench unit;
    unit[k] = 1;
    const auto a = answer(unit);
    for (int i = 0; i < 5; ++i) mobility(i, k) = a[static_cast<std::size_t>(i)];
  }
  const stress::Matrix mass = stress::inverse(mobility);
  constexpr double kOmega = 25, kZeta = 0.8, kWay = 4;
  double aim = 0, start = 1e300, speed = 0, last = 0;
  std::vector<double> measured;
  std::vector<std::int64_t> at;
  double held = 0;
  b.step.law = [&](const PenSample& s, double now, double dt) {
    const double x = s.pose.tip.x - home.tip.x;
    if (now > 1.0 && aim == 0) aim = kWay, start = now;
    // Velocity by differences over the tick, as the recursion below has it.
    speed = dt > 0 ? (x - last) / dt : 0;
    last = x;
    if (now >= start) measured.push_back(b.pen->arms().posture().pose.tip.x - home.tip.x);
    held = kOmega * kOmega * (aim - x) - 2 * kZeta * kOmega * speed;
    Wrench w;
    for (int k = 0; k < 5; ++k) w[k] = mass(k, 0) * held;
    if (now < 1.0) w.force.x += 1e-3;  // something, for the pen to be switched on
    return w;
  };
  b.run(1.6);
  ASSERT_GT(measured.size(), 400U);
  // Read at frame + 125 µs, answered at the next frame + 250 µs: the force of tick n holds from then for a frame.
  double x = measured[0], v = 0, a_now = 0, a_next = 0, seen = measured[0];
  double worst = 0, most = 0;
  for (std::size_t n = 0; n < 400; ++n) {
    worst = std::max(worst, std::abs(measured[n] - x));
    most = std::max(most, x);
    const double a_wanted = kOmega * kOmega * (kWay - x) - 2 * kZeta * kOmega * (x - seen) / 1e-3;
    seen = x;
    // From frame n to n + 1: 250 µs more of the older force, and 750 µs of the newer one.
    for (const auto& [force, time] : {std::pair{a_now, 250e-6}, std::pair{a_next, 750e-6}})
      x += v * time + 0.5 * force * time * time, v += force * time;
    a_now = a_next, a_next = a_wanted;
  }
  EXPECT_GT(most, kWay);  // a little over
  EXPECT_NEAR(measured.back(), kWay, 0.2);
  EXPECT_LT(worst, 0.05);  // mm: encoder steps and mA are whole
}

TEST(SimulatedPen, GravityCompensationInTheHostHoldsThePenStill) {
  SimulatedPenSettings settings;
  const Pose home = SimulatedPen(settings).arms().posture().pose;
  SimulatedBench b(settings, hand_at(home, 0));
  const PenKinematics host(load_pen("riffler"));
  std::vector<double> heights;
  // The weight as a wrench: what the arms' ends bear, taken together.
  b.step.law = [&](const PenSample& s, double, double) {
    const PenPosture posture = host.posture(host.inverse(s.pose).angles);
    const JointAngles weight = gravity_torques(host.geometry(), posture.angles);
    ArmForces forces;
    for (std::size_t arm = 0; arm < 2; ++arm)
      forces[arm] = glm::inverse(glm::transpose(posture.arms[arm].jacobian)) * weight[arm];
    const Wrench bears = wrench_of(forces, posture.apart);
    return Wrench{host.from_base(bears.force), host.from_base(bears.torque)};
  };
  // A hand holds it until the force has come up.
  b.pen->hand().follow([home](double t) { return HandWish{.pose = home, .grip = t < 1.5 ? 1.0 : 0.0}; });
  b.run(1.6);
  const Vec3 start = b.pen->arms().posture().pose.tip;
  b.run(3);
  EXPECT_LT(glm::distance(b.pen->arms().posture().pose.tip, start), 0.05);
  // Without it, it falls.
  b.step.law = [](const PenSample&, double, double) { return upward(0.01); };
  b.run(0.5);
  EXPECT_LT(b.pen->arms().posture().pose.tip.z, start.z - 10);
}

TEST(SimulatedPen, ImpossibleSettingsAreRefusedByName) {
  const auto refused = [](auto&& change) {
    SimulatedPenSettings settings;
    change(settings);
    return test::error_of([&] { SimulatedPen pen(settings); });
  };
  EXPECT_EQ(refused([](auto& s) { s.turn_us = 300; }), "turn_us must divide 1000 and be at least 25");
  EXPECT_EQ(refused([](auto& s) { s.parts = 0; }), "parts must be within 1 and 100");
  EXPECT_EQ(refused([](auto& s) { s.cable.lost = 2; }), "lost must be a number between 0.000000 and 1.000000");
  EXPECT_EQ(refused([](auto& s) { s.hand.haste.linear = 0; }), "haste.linear must be positive");
  EXPECT_EQ(refused([](auto& s) { s.config.late_us = 0; }).substr(0, 8), "config: ");
}

TEST(SimulatedPen, RunsFasterThanRealTime) {
  const Pose home = SimulatedPen(SimulatedPenSettings()).arms().posture().pose;
  SimulatedBench b({}, hand_on_a_curve(home));
  b.step.law = [](const PenSample& s, double, double) { return Wrench{-0.005 * s.velocity, {}}; };
  const std::clock_t start = std::clock();  // of the processor: others may have it meanwhile
  b.run(5);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 5);
}

}  // namespace
}  // namespace riffler::pen::simulated_pen_test
