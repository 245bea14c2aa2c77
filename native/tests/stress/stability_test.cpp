#include "stress/stability.hpp"

#include <gtest/gtest.h>

#include "stress/passive_bound.hpp"
#include "support/effort.hpp"

namespace riffler::stress::stability_test {
namespace {

TEST(WallSimulation, MovesAFreeDeviceAsInClosedForm) {
  // m ẍ + b ẋ = 0 and m ẍ + k x = 0.
  WallSimulation coasts(wall_device(2e-4, 1e-3), {}, {{1.0}});
  coasts.place({0.0}, {100.0});
  WallSimulation swings(wall_device(2e-4, 0), {Matrix::diagonal({3.0}), {}}, {{1.0}});
  swings.place({1.0}, {0.0});
  for (int k = 1; k <= 1000; ++k) {
    coasts.tick({0.0}), swings.tick({0.0});
    const double t = k * 1e-3;
    ASSERT_NEAR(coasts.velocity()[0], 100 * std::exp(-5 * t), 1e-9);
    ASSERT_NEAR(coasts.position()[0], 20 * (1 - std::exp(-5 * t)), 1e-9);
    ASSERT_NEAR(swings.position()[0], std::cos(std::sqrt(3 / 2e-4) * t), 1e-8);
  }
}

TEST(WallSimulation, FrictionSlowsEvenlyAndHolds) {
  // 0.2 N on 0.2 kg: 1000 mm/s² from 100 mm/s is 5 mm in 0.1 s; then less than the friction moves nothing.
  WallSimulation rubs(wall_device(2e-4, 0, 0.2), {}, {{1.0}});
  rubs.place({0.0}, {100.0});
  for (int k = 0; k < 200; ++k) rubs.tick({0.0});
  EXPECT_NEAR(rubs.position()[0], 5, 1e-3);
  const double rest = rubs.position()[0];
  for (int k = 0; k < 200; ++k) rubs.tick({0.19});
  EXPECT_NEAR(rubs.position()[0], rest, 1e-6);
  for (int k = 0; k < 200; ++k) rubs.tick({0.25});
  EXPECT_GT(rubs.position()[0], rest + 1);
}

TEST(Stability, OneCoordinateSwingsUpAtTheBoundOfColgateAndSchenkel) {
  for (const double b : {5e-4, 2e-3})
    EXPECT_NEAR(swing_boundary(wall_device(1.5e-4, b), {}, {1.0}) / (2 * b / 1e-3), 1, 0.01) << b;
}

TEST(Stability, ACunningHandGainsFromTheBoundOn) {
  for (const double wall : {-1.5e-3, -5e-4, 0.0, 5e-4, 1.5e-3}) {
    const double bound = haptics::passive_stiffness({1e-3, 2e-3, 0, 0}, wall).least();
    EXPECT_NEAR(cunning_boundary(wall_device(1.5e-4, 2e-3), wall, {1.0}, {{1.0}}) / bound, 1, 0.03) << wall;
  }
  // With encoder steps, Abbott and Okamura's, from well below to well above the step at which it takes over.
  for (const double step : {0.01, 0.05, 0.2, 0.3}) {
    const double bound = haptics::passive_stiffness({1e-3, 2e-3, 0.2, step}).least();
    const WallDevice device = wall_device(1.5e-4, 2e-3, 0.2, step);
    EXPECT_NEAR(cunning_boundary(device, 0, {1.0}, {{step}}) / bound, 1, 0.012) << step;
  }
}

TEST(Stability, FiveCoupledCoordinatesAreBoundByTheDampingAlongTheNormal) {
  for (const std::uint64_t seed : {1, 3, 9}) {
    if (test::kSanitized && seed > 1) continue;
    const CoupledScene scene = coupled_scene(seed);
    const double bound = 2 * scene.damping / 1e-3;
    EXPECT_NEAR(swing_boundary(scene.device, guide(scene.device, scene.easiest), scene.normal) / bound, 1, 0.01);
    EXPECT_NEAR(cunning_boundary(scene.device, 0, scene.normal, {scene.easiest}) / bound, 1, 0.01);
    // No other hand gains earlier.
    Random random(seed);
    std::vector<Column> others;
    for (int k = 0; k < 50; ++k) {
      Column d(5);
      for (double& x : d) x = random.uniform(-1, 1);
      others.push_back(d);
    }
    EXPECT_GE(cunning_boundary(scene.device, 0, scene.normal, others), bound * 0.999);
    EXPECT_GE(swing_boundary(scene.device, {}, scene.normal), bound * 0.999);
  }
}

TEST(Stability, EncoderStepsOfFiveCoordinatesAddUp) {
  // A hand that trembles across the edge between two steps in every coordinate at once flips the force by
  // stiffness · Σ |n_i| Δ_i, and gains where friction is least for its share of the normal.
  for (const std::uint64_t seed : {2, 5, 8}) {
    CoupledScene scene = coupled_scene(seed);
    Random random(seed);
    double flips = 0, bound = INFINITY;
    for (std::size_t i = 0; i < 5; ++i) {
      const double unit = i < 3 ? 1 : 1.0 / 20;
      scene.device.resolution[i] = random.uniform(0.5, 1) * 0.3 * unit;
      scene.device.friction[i] = random.uniform(0.02, 0.04) / unit;
      flips += std::abs(scene.normal[i]) * scene.device.resolution[i];
    }
    std::vector<Column> hands;
    for (std::size_t j = 0; j < 5; ++j) {
      bound = std::min(bound, 2 * scene.device.friction[j] / (std::abs(scene.normal[j]) * flips));
      Column d(5);
      for (std::size_t i = 0; i < 5; ++i)
        d[i] = std::copysign((i == j ? 1e-2 : 1e-6) * scene.device.resolution[i], scene.normal[i]);
      hands.push_back(d);
    }
    ASSERT_LT(bound, 2 * scene.damping / scene.device.period) << "quantisation is to be what limits";
    EXPECT_NEAR(cunning_boundary(scene.device, 0, scene.normal, hands) / bound, 1, 0.02) << seed;
  }
}

/// A soft spring's force rises by K v; damping of the wall adds its whole force in one period, B/T. A heavy device
/// keeps its speed.
TEST(PerceptualHardness, IsTheStiffnessOfASpringAndGrowsWithTheDampingOfTheWall) {
  const WallDevice heavy = wall_device(10, 1e-3);
  EXPECT_NEAR(perceptual_hardness(heavy, {{1.0}, 3, 0, true}, {}, 20, {}), 3, 0.03);
  EXPECT_NEAR(perceptual_hardness(heavy, {{1.0}, 3, 0, true}, {}, 100, {}), 3, 0.03) << "at any speed";
  // The first sample in contact has K times its depth, half a period's on average, and B v all at once.
  EXPECT_NEAR(perceptual_hardness(heavy, {{1.0}, 0.1, 1e-3, true}, {}, 20, {}), 1 + 0.05, 0.02);
  // A light device is stopped within a period, and a wall that may push no further is no harder.
  const WallDevice light = wall_device(1.5e-4, 2e-3);
  EXPECT_LT(perceptual_hardness(light, {{1.0}, 400, 0, true}, {}, 20, {}), 400);
  EXPECT_NEAR(perceptual_hardness(heavy, {{1.0}, 1e4, 0, true, 0.1}, {}, 20, {}), 0.1 / 1e-3 / 20, 0.02);
}

/// The controller does not change a wall within its bound, and takes hardness from one far above it where the reserve
/// does not pay for the first contact: with a hand that may accelerate twice as much, and no damping credited.
TEST(PerceptualHardness, OfAWallWithinItsBoundIsUntouchedByTheController) {
  const WallDevice device = wall_device(1.5e-4, 2e-3);
  haptics::PassivitySettings settings;
  settings.jitter = 0, settings.acceleration = {2e5, 0}, settings.resolution = {0, 0};
  const auto hardness = [&](double stiffness, bool on) {
    const SimulatedWall wall{{1.0}, stiffness, 0, true, 10};
    return perceptual_hardness(device, wall, {}, 50, on ? std::optional(settings) : std::nullopt);
  };
  EXPECT_EQ(hardness(2, true), hardness(2, false));
  EXPECT_LT(hardness(400, true), 0.9 * hardness(400, false));
}

}  // namespace
}  // namespace riffler::stress::stability_test
