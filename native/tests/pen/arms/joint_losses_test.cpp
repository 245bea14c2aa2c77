// What friction of an identified pen's joints is credited, against the account of the simulated arms, and the damping
// matrix of a posture against the motion that costs least.
#include "pen/arms/joint_losses.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/io.hpp"
#include "geom/math.hpp"
#include "pen/simulated/simulated_bench.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"
#include "support/pens.hpp"

namespace riffler::pen::joint_losses_test {
namespace {

/// The pen with uncertainties of that share of each value.
PenGeometry identified(PenGeometry pen, double share) {
  PenUncertainty u;
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = pen.channels[k];
    u.coulomb[k] = share * c.coulomb, u.viscous[k] = share * c.viscous;
    u.torque_constant[k] = share * c.torque_constant, u.gravity[k] = share * c.gravity;
  }
  pen.uncertainty = u;
  return pen;
}

TEST(CertainFriction, IsTheLowerEndOfTheIntervalAndNothingWithoutOne) {
  const PenGeometry pen = load_pen("riffler");
  EXPECT_EQ(certain_friction(pen, 0).coulomb, 0);
  EXPECT_EQ(certain_share(pen, 0), 0);
  EXPECT_NEAR(certain_friction(identified(pen, 0.1), 0).coulomb, 0.804 * pen.channels[0].coulomb, 1e-12);
  EXPECT_NEAR(certain_share(identified(pen, 0.1), 3), 0.804, 1e-12);
  EXPECT_EQ(certain_friction(identified(pen, 0.6), 0).viscous, 0) << "an interval that contains zero";
}

struct Credit {
  double credited = 0, lost = 0, ahead = 0;  // N·mm; ahead: the largest credit beyond what was lost
};

/// A hand that strays about with a tremor, on a cable with jitter.
Credit stray(const PenGeometry& believed, unsigned seed) {
  SimulatedPenSettings settings;
  settings.cable.jitter_us = 400;
  settings.hand.tremor = 0.1;
  const Pose home = SimulatedPen(settings).arms().posture().pose;
  test::SimulatedBench b(settings, [home, seed](double t) {
    HandWish wish{.pose = home};
    const double s = std::max(0.0, t - 1);
    wish.pose.tip +=
        20.0 * Vec3(std::sin((1.1 + 0.1 * seed) * s), std::sin(1.7 * s), std::sin(2.3 * s + seed) - std::sin(seed));
    wish.pose.axis = glm::normalize(home.axis + 0.3 * std::sin(1.3 * s) * Vec3(1, 0.5, 0));
    wish.grip = std::fmod(s, 3) < 2.5 ? 1 : 0.1;
    return wish;
  });
  JointLosses losses(believed, {});
  Credit out;
  b.step.law = [&](const PenSample& sample, double now, double) {
    out.credited += losses.add(sample.counts, now);
    out.ahead = std::max(out.ahead, out.credited - b.pen->arms().energy().lost);
    return Wrench{};
  };
  b.run(10);
  out.lost = b.pen->arms().energy().lost;
  return out;
}

TEST(JointLosses, NeverCreditMoreThanFrictionTookAndNotMuchLess) {
  const PenGeometry pen = identified(load_pen("riffler"), 1e-6);
  for (const unsigned seed : {1U, 2U, 3U}) {
    if (test::kSanitized && seed > 1) break;
    const Credit credit = stray(pen, seed);
    EXPECT_GT(credit.lost, 50);
    EXPECT_LE(credit.ahead, 1e-9) << seed;
    EXPECT_GT(credit.credited, 0.75 * credit.lost) << seed;
  }
  EXPECT_EQ(stray(load_pen("riffler"), 1).credited, 0) << "a pen that was not identified";
}

/// By hand: a steady turn of one joint.
TEST(JointLosses, OfASteadyTurnAreItsFrictionTimesItsAngle) {
  PenGeometry pen = identified(load_pen("riffler"), 0);
  const PenChannel& c = pen.channels[0];
  JointLosses losses(pen, {0, 0.25});
  double sum = 0;
  EncoderCounts raw{};
  raw[0] = 2'147'483'600;  // the counter wraps
  const double rate = 8;   // counts per ms
  for (int k = 0; k <= 1000; ++k) {
    EncoderCounts now = raw;
    now[0] = static_cast<std::int32_t>(static_cast<std::uint32_t>(raw[0]) + static_cast<std::uint32_t>(rate * k));
    sum += losses.add(now, 1e-3 * k);
  }
  const double turn = kTwoPi * c.ratio / c.steps, seen = 1000 * (rate - 1) * turn;
  EXPECT_NEAR(sum, 0.75 * (c.coulomb * seen + c.viscous * (rate - 1) * turn / 1e-3 * seen), 1e-9);
  losses.clear();
  EXPECT_EQ(losses.add({}, 2), 0) << "a gap is not motion";
}

/// The damping along n with everything else free, by minimising over joint rates that lead the pivot along n.
TEST(PivotDamping, IsThatOfTheMotionWithTheLeastLoss) {
  const PenGeometry pen = identified(test::turned_pen(), 0.05);
  const PenKinematics kinematics(pen);
  stress::Random random(3);
  for (int round = 0; round < 200; ++round) {
    const PenInverse found = kinematics.inverse(test::random_pose(random, pen));
    if (!found.reached()) continue;
    const PenPosture posture = kinematics.posture(found.angles);
    const Mat3 damping = pivot_damping(kinematics, posture);
    const auto power = [&](const Vec3& v, const Vec3& w) {
      double sum = 0;
      for (std::size_t k = 0; k < kPenChannels; ++k) {
        const PenChannel& c = pen.channels[k];
        const Vec3 end = kinematics.to_base(c.arm == Arm::R ? v - w : v + w);
        const double rate = (glm::inverse(posture.arms[index(c.arm)].jacobian) * end)[c.joint] * c.ratio;
        sum += certain_friction(pen, k).viscous * rate * rate;
      }
      return sum;
    };
    const Vec3 v = random.direction();
    const double claimed = glm::dot(v, damping * v);
    // Quadratic in w, which is square to the grip: its minimum by sampling three points along each of many lines.
    const Vec3 a = glm::normalize(glm::cross(posture.pose.axis, Vec3(0.3, 1, 0.2))),
               b = glm::cross(posture.pose.axis, a);
    double s = 0, t = 0;
    for (int k = 0; k < 60; ++k) {
      const auto along = [&](double& x, const Vec3& d) {
        const Vec3 w = s * a + t * b;
        const double low = power(v, w - d), middle = power(v, w), high = power(v, w + d);
        x += 0.5 * (low - high) / (low - 2 * middle + high);
      };
      along(s, a), along(t, b);
    }
    EXPECT_NEAR(claimed / power(v, s * a + t * b), 1, 1e-4);
    EXPECT_LE(claimed, power(v, Vec3(0)) * (1 + 1e-9));
  }
  EXPECT_EQ(pivot_damping(PenKinematics(test::turned_pen()),
                          PenKinematics(test::turned_pen()).posture(kinematics.home_angles())),
            Mat3(0));
}

/// The file GEOMETRY-SERIAL of the user takes the place of the geometry that the pen names, and is used: by the account
/// of what friction took, by compensation, by the passivity settings.
TEST(IdentifiedPen, OpensWithItsOwnFile) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("riffler-own-pens-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  base::write_file(folder / "riffler-0.toml",
                   pen_text("riffler") +
                       "[uncertainty]\ntorque_constant = [0.1, 0.1, 0.1, 0.1, 0.1, 0.1]\n"
                       "coulomb = [0.01, 0.01, 0.01, 0.01, 0.01, 0.01]\nviscous = [0, 0, 0, 0, 0, 0]\n"
                       "gravity = [1, 1, 0, 1, 1, 0]\n");
  setenv("RIFFLER_PENS", folder.c_str(), 1);
  EXPECT_TRUE(is_own_pen("riffler-0"));
  EXPECT_FALSE(is_own_pen("riffler-1"));
  {
    const Pose home = SimulatedPen(SimulatedPenSettings()).arms().posture().pose;
    const HandPath moves = [home](double t) {
      HandWish wish{.pose = home};
      wish.pose.tip.x += 10 * std::sin(std::max(0.0, t - 1));
      return wish;
    };
    const auto pen = std::make_shared<SimulatedPen>(SimulatedPenSettings(), moves);
    const auto clock = std::make_shared<SimulatedClock>();
    SimulatedTransport transport(pen, clock);
    RifflerModel model(transport);
    model.home();
    EXPECT_EQ(model.geometry()->name, "riffler-0");
    ASSERT_TRUE(model.geometry()->uncertainty);
    EXPECT_EQ(model.passivity().device_friction.linear, 0);
    std::vector<std::uint8_t> bytes(MessageSizes().read);
    while (clock->now() < 3)
      if (const int n = transport.read(bytes, 0.01); n > 0)
        model.take(std::span(bytes).first(static_cast<std::size_t>(n)), clock->now());
    const double credited = model.sample(clock->now()).dissipated, lost = pen->arms().energy().lost;
    // Half of the friction is compensated by default, and slow turns of some counts are not credited.
    EXPECT_GT(credited, 0.3 * lost);
    EXPECT_LT(credited, 0.5 * lost);
  }
  unsetenv("RIFFLER_PENS");
  std::filesystem::remove_all(folder);
  EXPECT_EQ(test::SimulatedBench().model.geometry()->name, "riffler");
}

}  // namespace
}  // namespace riffler::pen::joint_losses_test
