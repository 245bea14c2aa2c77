// The haptic step against closed forms and against the same balance integrated in very small steps.
#include "riffler/haptics/sculpt_step.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include "riffler/haptics/passivity.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"
#include "support/allocations.hpp"
#include "support/box_mesh.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::haptics::sculpt_step_test {
namespace {

constexpr auto box = test::box_mesh;

constexpr double kTick = 1e-3;
const Vec3 kUp(0, 0, 1);

SculptSettings springs_only() {
  SculptSettings s;
  s.coupling.damping = s.coupling.turn_damping = 0;
  return s;
}

Volume block(double pitch, const char* directions = "z") {
  return Volume::block({{{0, 0, -20}, {40, 40, 0}}, pitch, directions});
}

/// Steps along a path of the grip, and says what the hand felt.
template <class Path, class Visit>
void follow(SculptStep& step, int ticks, const Path& path, const Visit& visit) {
  for (int k = 1; k <= ticks; ++k) {
    const double t = k * kTick;
    const Pose now = path(t), before = path(t - kTick);
    visit(k, step.step(now, {1 / kTick * (now.tip - before.tip), {}}, kTick));
  }
}

TEST(SculptStep, AFlatCutterFedDownwardsIsResistedByConstantTimesAreaTimesSpeed) {
  for (const double speed : {5.0, 20.0}) {
    Volume volume = block(0.1);
    sweep::MoveCarver carver(volume, cutters::flat(10, 40), {.tolerance = 0.01, .removal_constant = 1e-3});
    SculptStep step(springs_only(), cutters::flat(10, 40), &carver, nullptr);
    const auto grip = [&](double t) { return Pose{{20, 20, -speed * t}, kUp}; };
    step.place(grip(0));
    const double area = kPi * 25, lag = 1e-3 * area;  // s, as the stiffness is 1 N/mm
    Wrench last;
    double worst = 0;
    follow(step, 600, grip, [&](int k, const SculptStep::Result& r) {
      last = r.on_grip;
      // From rest the stretch follows (1 − e^(−t K/c)) c u/K.
      const double exact = lag * speed * -std::expm1(-k * kTick / lag);
      if (k > 20) worst = std::max(worst, std::abs(r.on_grip.force.z - exact));
    });
    EXPECT_NEAR(last.force.z, lag * speed, 3e-3 * lag * speed) << speed;
    // It meets the surface unwarned, and is that far ahead until the area is known.
    EXPECT_LT(worst, 3 * speed * kTick) << speed;
    EXPECT_LT(std::hypot(last.force.x, last.force.y), 1e-9);
    EXPECT_LT(glm::length(last.torque), 1e-3);
  }
}

TEST(SculptStep, ASlotIsResistedEvenlyThoughItsWallMovesByWholeRays) {
  Volume volume = block(0.2);
  const Tool flat = cutters::flat(6, 40);
  sweep::MoveCarver carver(volume, flat, {.tolerance = 0.01, .removal_constant = 2e-3});
  SculptSettings settings = springs_only();
  settings.coupling.turn_stiffness = 1e6;
  SculptStep step(settings, flat, &carver, nullptr);
  const auto grip = [](double t) { return Pose{{-4 + 20 * t, 20, -3}, kUp}; };
  step.place(grip(0));
  double sum = 0, least = 1e9, most = 0;
  int count = 0;
  follow(step, 1500, grip, [&](int k, const SculptStep::Result& r) {
    if (k < 700) return;
    sum += -r.on_grip.force.x, ++count;
    least = std::min(least, -r.on_grip.force.x), most = std::max(most, -r.on_grip.force.x);
  });
  const double expected = 2e-3 * 6 * 3 * 20;
  EXPECT_NEAR(sum / count, expected, 0.03 * expected);
  EXPECT_LT(most - least, 0.05 * expected);
}

/// An upright flat end that goes sideways through full material: stiffness · stretch = constant · what it takes in a
/// second, which is its diameter times its depth for what it goes sideways, and its end's area for what it goes down.
class Slot {
 public:
  Slot(double radius, double constant, const Vec3& at) : r_(radius), k_(constant), x_(at) {}

  /// The force at the end, of 1 N/mm.
  template <class Grip>
  Vec3 advance(double from, double dt, const Grip& grip) {
    const int n = 50;
    for (int i = 1; i <= n; ++i) {
      const Vec3 ahead = grip(from + i * dt / n).tip - x_;
      const double stretch = glm::length(ahead);
      if (stretch == 0) continue;
      const Vec3 d = ahead / stretch;
      const double area = 2 * r_ * std::max(0.0, -x_.z) * std::abs(d.x) + kPi * r_ * r_ * std::max(0.0, -d.z);
      x_ += (area > 0 ? std::min(stretch, stretch * dt / (n * k_ * area)) : stretch) * d;
    }
    return x_ - grip(from + dt).tip;
  }

 private:
  double r_, k_;
  Vec3 x_;
};

TEST(SculptStep, ASlotOfChangingDepthIsFeltAsItsClosedFormAtAnyPitchAndSpeed) {
  const Tool flat = cutters::flat(6, 40);
  for (const auto& [pitch, most] : {std::pair(0.4, 0.04), {0.2, 0.016}, {0.1, 0.012}}) {
    if (test::kSanitized && pitch < 0.4) continue;
    for (const double speed : {1.0, 0.1}) {
      const double constant = 1e-3 / speed;
      Volume volume = Volume::block({{{0, 12, -6}, {40, 28, 0}}, pitch, "z"});
      sweep::MoveCarver carver(volume, flat, {.tolerance = 0.01, .removal_constant = constant});
      SculptSettings settings = springs_only();
      settings.coupling.turn_stiffness = 1e6;
      SculptStep step(settings, flat, &carver, nullptr);
      const auto grip = [&](double s) {
        const double t = speed * s;
        return Pose{{10 + 20 * t, 20, -6 * t + 0.5 * std::sin(11 * t)}, kUp};
      };
      step.place(grip(0));
      // It starts upwards, and meets the block where it comes down again.
      double start = 0;
      while (grip(start + kTick).tip.z >= 0) start += kTick;
      Slot exact(3, constant, grip(start).tip);
      double square = 0, largest = 0;
      const int ticks = static_cast<int>(500 / speed);
      follow(step, ticks, grip, [&](int k, const SculptStep::Result& r) {
        const double t = (k - 1) * kTick;
        const Vec3 force = t < start - 0.5 * kTick ? Vec3(0) : exact.advance(t, kTick, grip);
        square += glm::dot(r.on_grip.force - force, r.on_grip.force - force);
        largest = std::max(largest, glm::length(force));
      });
      EXPECT_LT(std::sqrt(square / ticks), most * largest) << pitch << ' ' << speed;
    }
  }
}

/// A ball that is plunged: stiffness · (grip − z) dt = constant · the volume that it goes deeper by; free while it does
/// not.
class Plunge {
 public:
  Plunge(double radius, double constant, double stiffness) : r_(radius), k_(constant), s_(stiffness) {}

  /// The force at the end.
  template <class Grip>
  double advance(double from, double dt, const Grip& grip) {
    const int n = 500;
    for (int i = 1; i <= n; ++i) {
      const double g = grip(from + i * dt / n);
      if (g < -deepest_) deepest_ = next(g, dt / n);
    }
    const double g = grip(from + dt);
    return s_ * (std::max(g, -deepest_) - g);
  }

 private:
  double volume(double depth) const { return kPi * depth * depth * (r_ - depth / 3); }
  double next(double g, double dt) const {
    double low = deepest_, high = -g;
    for (int i = 0; i < 50; ++i) {
      const double d = 0.5 * (low + high);
      (s_ * (-g - d) * dt > k_ * (volume(d) - volume(deepest_)) ? low : high) = d;
    }
    return 0.5 * (low + high);
  }

  double r_, k_, s_, deepest_ = 0;
};

TEST(SculptStep, ConvergesToTheBalanceThatIsSolvedDenselyAsItsPartsGetSmaller) {
  // In and out again and deeper; the error is that of the area's lag, which is the first order of a part.
  const auto height = [](double t) { return 0.3 - 12 * t - 0.8 * std::sin(40 * t); };
  double last = 1;
  for (const int parts : {1, 2, 4, 8}) {
    Volume volume = block(0.1);
    const Tool ball = cutters::ball(8, 40);
    sweep::MoveCarver carver(volume, ball, {.tolerance = 1e-3, .removal_constant = 2e-4});
    SculptSettings settings = springs_only();
    settings.parts = parts, settings.memory = 2e-4;  // a grid gives depths exactly
    SculptStep step(settings, ball, &carver, nullptr);
    Plunge exact(4, 2e-4, 1);
    step.place({{20, 20, height(0)}, kUp});
    double square = 0, largest = 0;
    follow(
        step, 400, [&](double t) { return Pose{{20, 20, height(t)}, kUp}; },
        [&](int k, const SculptStep::Result& r) {
          const double force = exact.advance((k - 1) * kTick, kTick, height);
          square += (r.on_grip.force.z - force) * (r.on_grip.force.z - force);
          largest = std::max(largest, std::abs(force));
        });
    const double rms = std::sqrt(square / 400) / largest;
    EXPECT_LT(rms, 0.8 * last) << parts;
    last = rms;
  }
  EXPECT_LT(last, 4e-3);
}

TEST(SculptStep, APlungedBallIsFeltAsItsClosedFormAtAnyPitch) {
  const auto height = [](double t) { return 0.3 - 12 * t - 0.8 * std::sin(40 * t); };
  const Tool ball = cutters::ball(8, 40);
  for (const auto& [pitch, most] : {std::pair(0.4, 0.06), {0.2, 0.04}, {0.1, 0.03}}) {
    Volume volume = block(pitch);
    sweep::MoveCarver carver(volume, ball, {.tolerance = 1e-3, .removal_constant = 2e-4});
    SculptStep step(springs_only(), ball, &carver, nullptr);
    Plunge exact(4, 2e-4, 1);
    step.place({{20, 20, height(0)}, kUp});
    double square = 0, largest = 0;
    follow(
        step, 400, [&](double t) { return Pose{{20, 20, height(t)}, kUp}; },
        [&](int k, const SculptStep::Result& r) {
          const double force = exact.advance((k - 1) * kTick, kTick, height);
          square += (r.on_grip.force.z - force) * (r.on_grip.force.z - force);
          largest = std::max(largest, std::abs(force));
        });
    EXPECT_LT(std::sqrt(square / 400), most * largest) << pitch;
  }
}

TEST(SculptStep, TheCouplingsEnergyFallsInEveryStepUnderAnyResistance) {
  // With the grip where it is at the step's end: what drives the tool can only lose by the tool's own motion.
  stress::Random random(5);
  const Tool ball = cutters::ball(6, 30);
  for (const double constant : {1e-6, 1e-2, 1.0, 1e4}) {
    Volume volume = block(0.4);
    sweep::MoveCarver carver(volume, ball, {.tolerance = 0.02, .removal_constant = constant});
    const SculptSettings settings = springs_only();
    SculptStep step(settings, ball, &carver, nullptr);
    Pose grip{{20, 20, 1}, kUp};
    step.place(grip);
    Vec3 speed(0), spin(0);
    for (int k = 0; k < test::cases(10'000); ++k) {
      speed = 0.99 * speed + random.uniform(0, 20) * random.direction() - 0.2 * (grip.tip - Vec3(20, 20, -2));
      spin = 0.99 * spin + random.uniform(0, 0.2) * random.direction() - 0.5 * glm::cross(kUp, grip.axis);
      grip.tip += kTick * speed;
      grip.axis = glm::normalize(grip.axis + kTick * glm::cross(spin, grip.axis));
      const double before = couple(settings.coupling, pose_error(grip, step.tool()), {}, {}).energy;
      const SculptStep::Result r = step.step(grip, {speed, spin}, kTick);
      ASSERT_TRUE(finite(r.on_grip));
      const double after = couple(settings.coupling, pose_error(grip, r.tool), {}, {}).energy;
      ASSERT_LE(after, before + 1e-9 + 1e-6 * before) << constant << ", " << k;
    }
  }
}

/// k ∫ depth over the disc in which a ball that is d deep meets a plane.
double cap_force(double radius, double d, double k) {
  const double wide = std::sqrt(2 * radius * d - d * d), up = radius - d;
  return k * kPi * (radius * wide * wide - 2.0 / 3 * (radius * radius * radius - up * up * up));
}

TEST(SculptStep, ATracedPlaneHoldsTheToolWhereCouplingAndSurfaceBalance) {
  const Tool ball = cutters::ball(6, 30);
  for (const double stiffness : {0.3, 3.0, 300.0}) {
    const collide::Collider part(box({-12, -12, -5}, {12, 12, 0}), {}, {.spacing = 0.1, .stiffness = stiffness});
    SculptStep step(springs_only(), ball, nullptr, &part);
    step.place({{0, 0, 1}, kUp});
    // Down to −1, then aside: nothing holds it back there.
    const auto grip = [](double t) { return Pose{{30 * std::max(0.0, t - 0.2), 0, std::max(-1.0, 1 - 20 * t)}, kUp}; };
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
      const double d = 0.5 * (low + high);
      (cap_force(3, d, stiffness) < 1 - d ? low : high) = d;
    }
    double largest = 0, aside = 0;
    Wrench still;
    follow(step, 400, grip, [&](int k, const SculptStep::Result& r) {
      largest = std::max(largest, glm::length(r.on_grip.force));
      if (k == 200) still = r.on_grip;
      if (k > 200) aside = std::max(aside, std::abs(r.on_grip.force.x));
      EXPECT_LE(-part.clearance(collide::Assembly(ball), r.tool), r.depth_bound + 1e-9) << k;
      EXPECT_LE(r.queries, 2);
    });
    EXPECT_NEAR(still.force.z, 1 - low, 5e-3) << stiffness;
    EXPECT_LT(largest, 1.01 * (1 - low) + 0.005) << "no blow before it rests";
    EXPECT_LT(aside, 0.02) << stiffness;
    EXPECT_LT(glm::length(still.torque), 0.05);
  }
}

TEST(SculptStep, ALiftedToolLeavesWhatItTouchedAtOnce) {
  const Tool ball = cutters::ball(6, 30);
  const collide::Collider part(box({-12, -12, -5}, {12, 12, 0}), {}, {.spacing = 0.1, .stiffness = 10});
  SculptStep step(springs_only(), ball, nullptr, &part);
  step.place({{0, 0, 1}, kUp});
  follow(
      step, 100, [](double t) { return Pose{{0, 0, 1 - 20 * t}, kUp}; },
      [](int, const SculptStep::Result& r) { EXPECT_GE(r.on_grip.force.z, 0); });
  EXPECT_TRUE(step.contact().depth > 0);
  for (int k = 0; k < 3; ++k) {
    const SculptStep::Result r = step.step({{0, 0, 1}, kUp}, {}, kTick);
    EXPECT_GE(r.on_grip.force.z, -1e-9);
    if (k > 0) {
      EXPECT_NEAR(r.tool.tip.z, 1, 1e-9);
    }
  }
}

/// The largest change of force in a tick that the hand's own motion does not explain, N, and how many ticks touched.
struct Shaken {
  double blow = 0;
  int touched = 0;
};

Shaken shake(const Tool& tool, const collide::Collider& part) {
  SculptStep step(springs_only(), tool, nullptr, &part);
  stress::Random random(9);
  Pose grip{{0, 0, 1}, kUp};
  step.place(grip);
  Vec3 speed(0);
  double last = 0;
  Shaken out;
  for (int k = 0; k < 4000; ++k) {
    speed = 0.98 * speed + random.uniform(0, 6) * random.direction() - 0.3 * (grip.tip - Vec3(0, 0, -0.3));
    grip.tip += kTick * speed;
    const SculptStep::Result r = step.step(grip, {speed, {}}, kTick);
    EXPECT_TRUE(finite(r.on_grip));
    const double force = glm::length(r.on_grip.force);
    // The hand moves by |speed| in a tick: a coupling of 1 N/mm cannot change by much more where nothing jumps.
    if (k > 10) out.blow = std::max(out.blow, force - last - 4 * kTick * glm::length(speed));
    last = force, out.touched += step.contact().depth > 0;
  }
  return out;
}

TEST(SculptStep, PartsAndFixturesOfAnyStiffnessAndPitchStayQuietUnderAnyHand) {
  // A ball on a floor, and its holder at the wall of a fixture, whose dexels stand along that wall and across it.
  const Tool tool = cutters::ball(6, 20).with_holder({{20, 15, 40, 15}});
  for (const double stiffness : {0.1, 10.0, 1e3})
    for (const double pitch : {0.1, 0.25, 0.5})
      for (const char* directions : {"z", "x"}) {
        const collide::Collider part(
            box({-20, -20, -5}, {20, 20, 0}), {Volume::block({{{-10, -20, 10}, {10, -14.8, 30}}, pitch, directions})},
            {.spacing = 0.3, .stiffness = stiffness, .holder_stiffness = stiffness, .fixture_stiffness = stiffness});
        const Shaken shaken = shake(tool, part);
        EXPECT_GT(shaken.touched, 500) << stiffness << ", " << pitch << directions;
        // Where a few nanometres are a newton, the last query is too old now and then.
        EXPECT_LT(shaken.blow, stiffness < 100 ? 0.15 : 0.45) << stiffness << ", " << pitch << directions;
      }
}

TEST(SculptStep, AQueryThatRunsOutOfTimeLeavesTheToolAndTheHandIsPulledBack) {
  const Tool ball = cutters::ball(6, 30);
  const collide::Collider part(box({-12, -12, -5}, {12, 12, 0}), {}, {.spacing = 0.1});
  SculptSettings settings = springs_only();
  settings.budget = 0, settings.missed = 1e-6;
  SculptStep step(settings, ball, nullptr, &part);
  step.place({{0, 0, 0.01}, kUp});
  int held = 0;
  follow(
      step, 50, [](double t) { return Pose{{0, 0, 0.01 - 20 * t}, kUp}; },
      [&](int k, const SculptStep::Result& r) {
        if (!r.held) return;
        ++held;
        EXPECT_LE(-part.clearance(collide::Assembly(ball), r.tool), r.depth_bound + 1e-9) << k;
      });
  EXPECT_GT(held, 0);
}

/// The cuts of a large ball are far over the budget; the time that they leave to queries is none.
TEST(SculptStep, AToolThatIsHeldAfterASlowCutIsReleased) {
  const Tool ball = cutters::ball(30, 60);
  Volume volume = block(0.1, "xyz");
  sweep::MoveCarver carver(volume, ball, {});
  const collide::Collider part(box({0, 0, -18}, {40, 40, -15.02}), {}, {.spacing = 0.1});
  SculptSettings settings = springs_only();
  settings.budget = 4e-4, settings.missed = 1e-3;
  SculptStep step(settings, ball, &carver, &part);
  const auto grip = [](double t) { return Pose{{10 + 20 * t, 20, -15}, kUp}; };
  step.place(grip(0));
  int all = 0, in_a_row = 0, longest = 0;
  follow(step, 200, grip, [&](int, const SculptStep::Result& r) {
    all += r.held, in_a_row = r.held ? in_a_row + 1 : 0;
    longest = std::max(longest, in_a_row);
  });
  EXPECT_GT(all, 0);
  EXPECT_LT(longest, 100) << "of 200 steps";
}

TEST(SculptStep, AllocatesNothingOnceItIsWarm) {
  const Tool tool = cutters::ball(6, 20).with_holder({{24, 12, 40, 12}});
  Volume volume = block(0.2);
  std::vector<Volume> fixtures;
  fixtures.push_back(Volume::block({{{0, 0, 14}, {40, 9, 30}}, 0.5, "z"}));
  const collide::Collider part(box({8, 8, -6}, {32, 32, -3}), std::move(fixtures), {.spacing = 0.1});
  sweep::MoveCarver carver(volume, tool, {});
  SculptStep step(springs_only(), tool, &carver, &part);
  const auto grip = [](double t) {
    const double a = 5 * t, tilt = 0.2 * std::sin(3 * t);
    return Pose{{20 + 6 * std::cos(a), 20 + 6 * std::sin(a), -3.2 + 0.5 * std::sin(7 * t)},
                {std::sin(tilt), 0, std::cos(tilt)}};
  };
  step.place(grip(0));
  base::BlockReserve reserve;  // as a session has it, for tiles of sizes that were not there before
  reserve.fill(1 << 15, 64);
  long start = 0;
  int touched = 0;
  double removed = 0;
  follow(step, 4000, grip, [&](int k, const SculptStep::Result& r) {
    if (k == 2000) start = test::allocations();
    touched += step.contact().points.size() > 1, removed += r.removed;
  });
  EXPECT_EQ(test::allocations(), start);
  EXPECT_GT(touched, 1000);
  EXPECT_GT(removed, 100);
}

TEST(SculptStep, NothingMovesWithoutTimeOrNumbers) {
  Volume volume = block(0.5);
  const Tool ball = cutters::ball(6, 30);
  sweep::MoveCarver carver(volume, ball, {});
  SculptStep step(SculptSettings{}, ball, &carver, nullptr);
  const Pose start{{20, 20, 1}, kUp};
  step.place(start);
  const double before = volume.volume();
  for (const double dt : {0.0, -1.0, std::nan("")}) EXPECT_EQ(step.step({{20, 20, -3}, kUp}, {}, dt).on_grip, Wrench{});
  EXPECT_EQ(step.step({{std::nan(""), 0, 0}, kUp}, {}, kTick).on_grip, Wrench{});
  EXPECT_EQ(step.step({{0, 0, 0}, {0, 0, 2}}, {}, kTick).on_grip, Wrench{});
  EXPECT_EQ(step.step(start, {{INFINITY, 0, 0}, {}}, kTick).on_grip, Wrench{});
  EXPECT_EQ(step.tool().tip, start.tip);
  EXPECT_EQ(volume.volume(), before);
  // At rest, and with the grip turned over: no direction is the shortest, and nothing breaks.
  EXPECT_EQ(step.step(start, {}, kTick).on_grip, Wrench{});
  for (int k = 0; k < 20; ++k) {
    const SculptStep::Result r = step.step({{20, 20, 1}, -kUp}, {}, kTick);
    ASSERT_TRUE(finite(r.on_grip));
    ASSERT_NEAR(glm::length(r.tool.axis), 1, 1e-12);
  }
}

TEST(SculptStep, MaterialAroundAPlacedToolIsRemovedUnfelt) {
  Volume volume = block(0.2);
  const Tool ball = cutters::ball(6, 30);
  sweep::MoveCarver carver(volume, ball, {});
  SculptStep step(springs_only(), ball, &carver, nullptr);
  step.place({{20, 20, -5}, kUp});
  const SculptStep::Result r = step.step({{20, 20, -4.99}, kUp}, {}, kTick);
  EXPECT_GT(r.removed, 100);
  EXPECT_EQ(step.resistance().linear, 0);
}

TEST(SculptStep, SettingsNameTheFieldThatIsWrong) {
  const auto message = [](auto change) {
    SculptSettings s;
    change(s);
    return test::error_of([&] { SculptStep(s, cutters::ball(6, 30), nullptr, nullptr); });
  };
  EXPECT_EQ(message([](auto& s) { s.memory = 0; }), "memory must be positive");
  EXPECT_EQ(message([](auto& s) { s.coupling.stiffness = 0; }), "coupling.stiffness must be positive");
  EXPECT_EQ(message([](auto& s) { s.budget = NAN; }), "budget must not be negative");
  EXPECT_NE(message([](auto& s) { s.parts = 0; }).find("parts must be a number between"), std::string::npos);
}

TEST(SculptStep, GivesNoEnergyToAnyHandWithThePassivityController) {
  // A grip without damping that the hand shakes, over stock and part.
  for (const double constant : {1e-3, 1.0}) {
    Volume volume = block(0.4);
    const Tool ball = cutters::ball(6, 30);
    const collide::Collider part(box({8, 8, -6}, {32, 32, -2}), {}, {.spacing = 0.2, .stiffness = 100});
    sweep::MoveCarver carver(volume, ball, {.tolerance = 0.02, .removal_constant = constant});
    SculptSettings settings;
    settings.coupling.stiffness = 20;
    SculptStep step(settings, ball, &carver, &part);
    Passivity passivity{PassivitySettings{}};
    stress::Random random(4);
    Vec3 x(20, 20, 0.5), v(0), hand(0);
    step.place({x, kUp});
    long double delivered = 0;
    Wrench held;
    double stiffest = 0;
    for (int k = 0; k < test::cases(10'000); ++k) {
      if (k % 64 == 0) hand = random.uniform(0, 1.5) * random.direction();
      const Vec3 push = hand - 1e-3 * v - 0.05 * (x - Vec3(20, 20, -2));
      const Vec3 a = (held.force + push) / 1.5e-4, way = kTick * v + 0.5 * kTick * kTick * a;
      for (int i = 0; i < 3; ++i) delivered += static_cast<long double>(held.force[i]) * way[i];
      x += way, v += kTick * a;
      passivity.observe(held, {way, {}}, kTick);
      held = passivity.control(step.step({x, kUp}, {v, {}}, kTick).on_grip, {});
      stiffest = std::max(stiffest, glm::length(held.force));
      ASSERT_LE(delivered, PassivitySettings{}.reserve + 1e-9L) << constant << ", " << k;
    }
    EXPECT_GT(stiffest, 0.5) << constant;
  }
}

}  // namespace
}  // namespace riffler::haptics::sculpt_step_test
