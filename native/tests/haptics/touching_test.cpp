// The haptic step of a tool that touches its stock without cutting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "riffler/haptics/passivity.hpp"
#include "riffler/haptics/sculpt_step.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"
#include "support/allocations.hpp"
#include "support/effort.hpp"

namespace riffler::haptics::touching_test {
namespace {

constexpr double kTick = 1e-3;
const Vec3 kUp(0, 0, 1);

/// A stock, its carver, and a tool that touches it between two cuts.
struct Bench {
  explicit Bench(const Tool& tool, double pitch = 0.2, const char* directions = "z", SculptSettings settings = {},
                 const collide::Collider* obstacles = nullptr)
      : volume(Volume::block({{{0, 0, -12}, {40, 30, 0}}, pitch, directions})),
        carver(volume, tool, {.tolerance = 0.005, .removal_constant = 0.01, .deferred = true}),
        step(settings, tool, &carver, obstacles, nullptr, &volume) {}

  SculptStep::Result go(const Pose& to, bool cutting = false) {
    if (!cutting) carver.publish();
    const Twist twist{1 / kTick * (to.tip - at.tip), {}};
    at = to;
    return step.step(to, twist, kTick, cutting);
  }
  void place(const Pose& pose) { at = pose, step.place(pose); }

  Volume volume;
  sweep::MoveCarver carver;
  SculptStep step;
  Pose at;
};

TEST(Touching, TheToolRestsOnAFaceAndTheHandFeelsTheCouplingsStretchEvenlyWhileItSlides) {
  for (const char* directions : {"z", "xyz"})
    for (const double tilt : {0.0, 0.5}) {
      if (test::kSanitized && (*directions == 'z') != (tilt == 0)) continue;
      const Vec3 axis(std::sin(tilt) * 0.6, std::sin(tilt) * 0.8, std::cos(tilt));
      Bench bench(cutters::ball(6, 20), 0.2, directions);
      const Vec3 from = Vec3(10, 10, 3) - 3.0 * axis;
      bench.place({from + Vec3(0, 0, 1), axis});
      double least = 1e9, most = 0, aside = 0;
      for (int k = 1; k <= 1500; ++k) {
        const double t = k * kTick;
        const Vec3 tip = from + Vec3(10 * std::max(0.0, t - 0.5), 3.7 * std::max(0.0, t - 0.5), 0) +
                         Vec3(0, 0, std::max(-1.0, 1 - 10 * t));
        const SculptStep::Result r = bench.go({tip, axis});
        if (k < 700) continue;
        EXPECT_TRUE(r.touching && r.cuts == 0);
        least = std::min(least, r.on_grip.force.z), most = std::max(most, r.on_grip.force.z);
        aside = std::max(aside, std::hypot(r.on_grip.force.x, r.on_grip.force.y));
      }
      // π R d² k = (1 − d) N: 0.07 mm deep.
      EXPECT_NEAR(most, 0.93, 0.03) << directions << ' ' << tilt;
      EXPECT_LT(most - least, 0.01) << directions << ' ' << tilt;
      EXPECT_LT(aside, 0.05) << directions << ' ' << tilt;
    }
}

TEST(Touching, AWallAlongTheRaysHoldsAFlankAndAGrooveJustCutHoldsTheBallInIt) {
  for (const char* directions : {"z", "xyz"}) {
    Bench bench(cutters::ball(6, 20), 0.2, directions);
    // The wall at x = 0, from outside.
    bench.place({{-5, 15, -8}, kUp});
    SculptStep::Result r;
    for (int k = 1; k <= 600; ++k) r = bench.go({{std::min(-2.0, -5 + 0.01 * k), 15, -8}, kUp});
    EXPECT_NEAR(r.tool.tip.x, -3, 0.06);
    EXPECT_NEAR(r.on_grip.force.x, -1, 0.07);
    // A groove along y, 2 mm deep; then to its side without the button.
    bench.place({{20, -4, -2}, kUp});
    for (int k = 1; k <= 1000; ++k) r = bench.go({{20, -4 + 0.02 * k, -2}, kUp}, true);
    ASSERT_GT(r.removed, 0);
    const double before = glm::length(r.on_grip.force);
    double jump = 0, last = before;
    for (int k = 1; k <= 1500; ++k) {
      r = bench.go({{20 + std::min(1.5, 0.002 * k), 16 - std::min(4.0, 0.01 * k), -2}, kUp});
      const double force = glm::length(r.on_grip.force);
      jump = std::max(jump, std::abs(force - last)), last = force;
    }
    // The ball rises out of the groove along its side.
    EXPECT_GT(r.on_grip.force.z, 0.3) << directions;
    EXPECT_LT(r.on_grip.force.x, -0.3) << directions;
    EXPECT_LT(jump, 0.25) << directions;  // as slow as a force that is let go
    EXPECT_EQ(r.cuts, 0);
  }
}

TEST(Touching, TheButtonCutsWithoutAJumpAndTheStockHoldsAgainSmoothlyAfterIt) {
  for (const char* directions : {"z", "xyz"}) {
    if (test::kSanitized && *directions == 'z') continue;
    Bench bench(cutters::ball(6, 20), 0.2, directions);
    bench.place({{20, 15, 1}, kUp});
    double last = 0, jump = 0;
    SculptStep::Result r;
    for (int k = 1; k <= 3000; ++k) {
      const bool cutting = k > 1000 && k <= 1600;
      r = bench.go({{20 + 0.002 * std::max(0, k - 1000), 15, std::max(-1.0, 1 - 0.01 * k)}, kUp}, cutting);
      jump = std::max(jump, std::abs(glm::length(r.on_grip.force) - last)), last = glm::length(r.on_grip.force);
      if (k == 1000) {
        EXPECT_NEAR(r.tool.tip.z, 0, 0.12);
      } else if (k == 1600) {
        EXPECT_LT(r.tool.tip.z, -0.8);
      }
    }
    EXPECT_LT(jump, 0.12) << "N in a millisecond, of a stretch of 1 mm";
    EXPECT_GT(last, 0.5) << "it is pressed against the end of what it has cut";
  }
}

TEST(Touching, AToolThatBeginsInTheStockPassesUntilItIsOut) {
  Bench bench(cutters::flat(6, 20), 0.5, "xyz");
  bench.place({{20, 15, -6}, kUp});
  SculptStep::Result r;
  for (int k = 1; k <= 800; ++k) {
    r = bench.go({{20, 15, -6 + 0.01 * k}, kUp});
    if (k < 550) {
      ASSERT_LT(glm::length(r.on_grip.force), 0.02) << k;
    }
  }
  for (int k = 1; k <= 800; ++k) r = bench.go({{20, 15, 2 - 0.01 * k + 0.0}, kUp});
  EXPECT_NEAR(r.tool.tip.z, 0, 0.05);
  EXPECT_TRUE(r.touching);
  // An undo fills the place where the tool stands: no blow.
  bench.place({{20, 15, 1}, kUp});
  for (int k = 1; k <= 600; ++k) bench.go({{20, 15, 1 - 0.01 * k}, kUp}, true);
  bench.carver.publish();
  Volume whole = Volume::block(bench.volume.frame());
  bench.carver.forget();
  bench.volume.restore(whole);
  bench.step.refilled();
  double last = 5;
  for (int k = 1; k <= 100; ++k) {
    const double force = glm::length(bench.go({{20, 15, -5}, kUp}).on_grip.force);
    EXPECT_LE(force, last + 1e-9) << k << ": only what the cut has stretched, and that goes";
    last = force;
  }
  EXPECT_LT(last, 0.01);
}

TEST(Touching, StockAndObstaclesHoldTheToolTogether) {
  Mesh plate;
  plate.vertices = {{-50, -50, 1}, {90, -50, 1}, {90, 80, 1}, {-50, 80, 1}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  const collide::Collider part(plate, {}, {.spacing = 0.3, .stiffness = 100});
  Bench bench(cutters::ball(6, 20), 0.2, "z", {}, &part);
  bench.place({{20, 15, 3}, kUp});
  SculptStep::Result r;
  for (int k = 1; k <= 500; ++k) r = bench.go({{20, 15, 3 - 0.01 * k}, kUp});
  EXPECT_NEAR(r.tool.tip.z, 1, 0.1);
  EXPECT_FALSE(r.touching);
}

TEST(Touching, GivesNoEnergyToAnyHandWithThePassivityController) {
  // As without touching: a light grip without damping that the hand shakes; the button is held now and then.
  for (const char* directions : {"z", "xyz"}) {
    SculptSettings settings;
    settings.coupling.stiffness = 20;
    Bench bench(cutters::fillet(6, 1, 20), 0.4, directions, settings);
    Passivity passivity{PassivitySettings{}};
    stress::Random random(4);
    Vec3 x(38, 15, 0.5), v(0), hand(0);
    bench.place({x, kUp});
    long double delivered = 0;
    Wrench held;
    double stiffest = 0;
    int touched = 0;
    for (int k = 0; k < test::cases(60'000); ++k) {
      if (k % 64 == 0) hand = random.uniform(0, 1.5) * random.direction();
      const Vec3 push = hand - 1e-3 * v - 0.05 * (x - Vec3(39, 15, -1));
      const Vec3 a = (held.force + push) / 1.5e-4, way = kTick * v + 0.5 * kTick * kTick * a;
      for (int i = 0; i < 3; ++i) delivered += static_cast<long double>(held.force[i]) * way[i];
      x += way, v += kTick * a;
      passivity.observe(held, {way, {}}, kTick);
      const bool cutting = k % 4000 > 3600;
      if (!cutting) bench.carver.publish();
      const SculptStep::Result r = bench.step.step({x, kUp}, {v, {}}, kTick, cutting);
      held = passivity.control(r.on_grip, {});
      stiffest = std::max(stiffest, glm::length(held.force)), touched += r.touching;
      ASSERT_LE(delivered, PassivitySettings{}.reserve + 1e-9L) << directions << ", " << k;
    }
    EXPECT_GT(stiffest, 0.5);
    EXPECT_GT(touched, test::cases(2000));
  }
}

TEST(Touching, AllocatesNothingWhileItTouches) {
  Bench bench(cutters::ball(6, 20), 0.2, "xyz");
  bench.place({{20, 15, 1}, kUp});
  std::uint64_t before = 0;
  for (int k = 1; k <= 1000; ++k) {
    if (k == 300) before = test::allocations();
    bench.step.step({{20 + 3 * std::sin(0.01 * k), 15, 1 - 0.002 * k}, kUp}, {}, kTick, false);
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace riffler::haptics::touching_test
