// The force of fixtures compared with volumes in closed form and integrated point by point.
#include "collide/fixture.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <map>

#include "collide/tools.hpp"
#include "riffler/collide/collider.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"
#include "sweep/kernels.hpp"

namespace riffler::collide::fixture_test {
namespace {

using stress::Random;

constexpr double kStiffness = 10;
const Box3 kBlock{{0, 0, 0}, {30, 20, 10}};

using Push = Collider::FixturePush;

Collider beside(const Box3& box, double pitch, double spacing, const char* directions = "z", Push push = Push::Centre) {
  Mesh far_away;
  far_away.vertices = {{1e4, 0, 0}, {1e4 + 1, 0, 0}, {1e4, 1, 0}}, far_away.triangles = {{0, 1, 2}};
  return Collider(far_away, {Volume::block({box, pitch, directions})},
                  {.spacing = spacing, .fixture_stiffness = kStiffness, .fixture_push = push});
}

Pose leaning(Random& random, const Vec3& tip, double most) {
  const double tilt = random.uniform(0, most), turn = random.uniform(0, 2 * kPi);
  return {tip, {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)}};
}

/// Force and torque about the tip, and what the parts of each add up to where they do not cancel each other.
struct Dense {
  Vec3 force{0}, torque{0};
  double size = 0, turning = 0;
};

/// k times the volume in the tool, each point h apart towards the middle of the cutter or the holder.
Dense dense_force(const Assembly& assembly, const Pose& pose, const Box3& box, double h) {
  Dense sum;
  const Vec3 n = glm::round(box.size() / h);
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        const Vec3 p = box.lower + h * Vec3(i + 0.5, j + 0.5, k + 0.5), d = p - pose.tip;
        const double z = glm::dot(d, pose.axis);
        if (!assembly.outline().inside(glm::length(d - z * pose.axis), z)) continue;
        const Assembly::HeightBand* in = nullptr;
        for (const Assembly::HeightBand& s : assembly.stretches())
          if (!in || z > s.low) in = &s;
        const Vec3 way = pose.tip + 0.5 * (in->low + in->high) * pose.axis - p;
        const Vec3 force = kStiffness * h * h * h / glm::length(way) * way, torque = glm::cross(d, force);
        sum.force += force, sum.size += glm::length(force);
        sum.torque += torque, sum.turning += glm::length(torque);
      }
  return sum;
}

TEST(Fixture, ForceAndTorqueAreThoseOfTheVolumeInTheToolForAnyPitch) {
  const std::vector<Assembly> tools{Assembly(cutters::ball(6, 20)), Assembly(held(cutters::fillet(8, 1, 12))),
                                    Assembly(cutters::flat(5, 20).with_holder({{20, 15, 40, 15}}))};
  std::map<int, Dense> dense;  // by number: the poses are the same for every pitch
  for (const double pitch : {0.5, 0.2, 0.1}) {
    const Collider collider = beside(kBlock, pitch, 0.3);
    Random random(3);
    double worst = 0, sum = 0, worst_torque = 0;
    int count = 0;
    for (int n = 0; n < 60; ++n) {
      const Assembly& assembly = tools[n % 3];
      const Pose pose =
          leaning(random, {random.uniform(-12, 40), random.uniform(-12, 30), random.uniform(-12, 10)}, 0.5);
      const Contact c = collider.query(assembly, pose);
      if (c.depth < 0.2) continue;
      if (!dense.contains(n)) dense[n] = dense_force(assembly, pose, kBlock, 0.1);
      const Dense& exact = dense[n];
      const double error = glm::length(c.force - exact.force) / exact.size;
      worst = std::max(worst, error), sum += error, ++count;
      worst_torque = std::max(worst_torque, glm::length(c.torque - exact.torque) / exact.turning);
    }
    EXPECT_GT(count, 20);
    EXPECT_LT(worst, 0.06) << pitch;
    EXPECT_LT(sum / count, 0.015) << pitch;
    EXPECT_LT(worst_torque, 0.06) << pitch;
    RecordProperty("worst_at_" + std::to_string(pitch), std::to_string(worst));
  }
}

/// The normal nearest to a place inside a long tool, in closed form.
using NormalOf = Vec3 (*)(const Vec3& from_tip, const Vec3& axis);

Vec3 normal_of_ball(const Vec3& d, const Vec3& axis) {
  const double z = glm::dot(d, axis);
  return glm::normalize(d - std::max(z, 3.0) * axis);
}

Vec3 normal_of_flat(const Vec3& d, const Vec3& axis) {
  const double z = glm::dot(d, axis);
  const Vec3 out = d - z * axis;
  return z < 4 - glm::length(out) ? -axis : glm::normalize(out);
}

/// Force and torque about the tip: k times the volume in the tool, each point h apart against the tool's normal there.
Contact dense_wrench(const Assembly& assembly, NormalOf normal, const Pose& pose, const Box3& box, double h) {
  Contact sum;
  const Vec3 n = glm::round(box.size() / h);
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        const Vec3 d = box.lower + h * Vec3(i + 0.5, j + 0.5, k + 0.5) - pose.tip;
        const double z = glm::dot(d, pose.axis);
        if (!assembly.outline().inside(glm::length(d - z * pose.axis), z)) continue;
        const Vec3 force = -kStiffness * h * h * h * normal(d, pose.axis);
        sum.force += force, sum.torque += glm::cross(d, force), sum.depth += glm::length(force);
      }
  return sum;
}

TEST(Fixture, PushesAgainstTheToolsNormalsWithForceAndTorqueOfItsVolume) {
  struct Case {
    Assembly tool;
    NormalOf normal;
  };
  const std::vector<Case> cases{{Assembly(cutters::ball(6, 4000)), normal_of_ball},
                                {Assembly(cutters::flat(8, 4000)), normal_of_flat}};
  std::map<int, Contact> dense;  // by number: the poses are the same for every pitch
  for (const double pitch : {0.5, 0.2}) {
    if (test::kSanitized && pitch < 0.5) continue;
    const Collider collider = beside(kBlock, pitch, 0.3, "z", Push::Normal);
    Random random(5);
    double worst = 0, worst_torque = 0;
    int count = 0;
    for (int n = 0; n < test::cases(60); ++n) {
      const Case& c = cases[n % 2];
      const Pose pose =
          leaning(random, {random.uniform(-12, 40), random.uniform(-12, 30), random.uniform(-12, 10)}, 0.5);
      const Contact found = collider.query(c.tool, pose);
      if (found.depth < 0.2) continue;
      if (!dense.contains(n)) dense[n] = dense_wrench(c.tool, c.normal, pose, kBlock, 0.1);
      const Contact& exact = dense[n];
      // Relative to what the parts push with where they do not cancel each other, and to that at their distance.
      const double lever = glm::length(0.5 * (kBlock.lower + kBlock.upper) - pose.tip) + 10;
      worst = std::max(worst, glm::length(found.force - exact.force) / exact.depth);
      worst_torque = std::max(worst_torque, glm::length(found.torque - exact.torque) / (exact.depth * lever));
      ++count;
    }
    EXPECT_GT(count, test::kSanitized ? 3 : 20);
    EXPECT_LT(worst, 0.06) << pitch;
    EXPECT_LT(worst_torque, 0.06) << pitch;
    RecordProperty("worst_at_" + std::to_string(pitch), std::to_string(worst));
  }
}

TEST(Fixture, AWallPushesAToolOffItselfAndNotAlongItself) {
  const Assembly tool(held(cutters::flat(6, 20)));
  const Pose beside_wall{{-2.6, 10, -6}, {0, 0, 1}};
  const Contact normal = beside(kBlock, 0.25, 0.3, "z", Push::Normal).query(tool, beside_wall);
  const Contact centre = beside(kBlock, 0.25, 0.3, "z", Push::Centre).query(tool, beside_wall);
  EXPECT_LT(normal.force.x, -60);
  EXPECT_LT(std::abs(normal.force.z), 0.02 * std::abs(normal.force.x));
  EXPECT_GT(std::abs(centre.force.z), 0.2 * std::abs(centre.force.x));  // the law of the source
}

TEST(Fixture, AFlatEndIsPushedByItsAreaTimesItsDepthFromTheFirstTouch) {
  // Where dexels came in as wholes, half a pitch of a wall was missing, and a shallow end had no force at all.
  const Assembly flat(cutters::flat(6, 4000));  // whose middle is so far up that all of it pushes in one direction
  for (const double pitch : {0.5, 0.13}) {
    if (test::kSanitized && pitch < 0.2) continue;
    const Collider collider = beside(kBlock, pitch, 0.3);
    // Boxes at the rim, which is a corner, take its one or the other side for a plane: a quarter of their width.
    // And round it where it has not come yet.
    const double early = kStiffness * 2 * kPi * 3 * 0.01 * 0.5 * 0.5, top = 10, rim = 2 * kPi * 3 * 0.3 * 0.5;
    for (const double depth : {1e-3, 0.1, 0.37, 1.1}) {
      const Contact c = collider.query(flat, {{14.1, 9.7, top - depth}, {0, 0, 1}});
      EXPECT_NEAR(c.force.z, kStiffness * 9 * kPi * depth, early + kStiffness * rim * depth) << pitch << ' ' << depth;
      EXPECT_GT(c.stiffness[2][2], 2 * 0.985 * kStiffness * 9 * kPi) << pitch << ' ' << depth;
      EXPECT_LT(c.stiffness[2][2], kStiffness * (2 * (9 * kPi + rim) + 1.1 * 6 * kPi * depth)) << pitch << ' ' << depth;
    }
  }
}

TEST(Fixture, ForceAndItsDerivativeHaveNoStepsAsASideMovesOverDexels) {
  // The dexels stand along the side that comes over them, so each would come in as a whole.
  const Assembly assembly(cutters::flat(6, 20).with_holder({{20, 15, 40, 15}}));
  const double step = 2e-3;
  for (const double pitch : {0.5, 0.2}) {
    if (test::kSanitized && pitch < 0.5) continue;
    const Collider collider = beside(kBlock, pitch, 0.3);
    const auto force = [&](double x) { return collider.query(assembly, {{x, 10, -25}, {0, 0, 1}}).force.x; };
    // A cylinder's side in a wall: the volume's derivative is as wide as the chord, times the height.
    double last = force(-15), before = 0, largest = 0;
    for (double x = -15 + step; x < -13; x += step) {
      const double now = force(x), slope = (last - now) / step, depth = x + 15 - 0.5 * step;
      const double chord = 2 * std::sqrt(30 * depth - depth * depth);
      if (depth > 0.05) {
        EXPECT_NEAR(slope, kStiffness * 10 * chord, 0.08 * kStiffness * 10 * chord + 40) << pitch << ' ' << depth;
        largest = std::max(largest, std::abs(slope - before) / slope);
      }
      last = now, before = slope;
    }
    EXPECT_LT(largest, 0.05) << pitch;
  }
}

TEST(Fixture, StiffnessIsTwiceTheDerivativeWhereForceAndNormalAgreeAndNowhereLess) {
  const Assembly assembly(cutters::flat(6, 20).with_holder({{20, 15, 40, 15}}));
  const auto slope = [&](const Collider& collider, const Pose& pose, const Vec3& way) {
    const double e = 1e-3;
    const Contact ahead = collider.query(assembly, {pose.tip + e * way, pose.axis}),
                  behind = collider.query(assembly, {pose.tip - e * way, pose.axis});
    return glm::dot(behind.force - ahead.force, way) / (2 * e);
  };
  // A ledge at the height of the holder's middle.
  const Collider ledge = beside({{0, 0, 4}, {30, 20, 6}}, 0.5, 0.3);
  const Pose at{{-14.7, 10, -25}, {0, 0, 1}};
  const double exact = slope(ledge, at, {1, 0, 0});
  EXPECT_NEAR(ledge.query(assembly, at).stiffness[0][0], 2 * exact, 0.1 * exact);

  const Collider block = beside(kBlock, 0.25, 0.3);
  Random random(8);
  for (int n = 0; n < 40; ++n) {
    const Pose pose = leaning(random, {random.uniform(-16, -10), random.uniform(0, 20), random.uniform(-30, -10)}, 0.2);
    const Contact c = block.query(assembly, pose);
    if (c.depth < 0.1) continue;
    const Vec3 way = random.direction();
    double resists = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) resists += way[i] * c.stiffness[i][j] * way[j];
    EXPECT_GT(resists, slope(block, pose, way)) << n;
  }
}

TEST(Fixture, WorkGoesWithTheSurfaceInTheToolNotWithTheDexels) {
  const Assembly assembly(cutters::ball(6, 20).with_holder({{20, 15, 40, 15}}));
  std::vector<std::size_t> boxes;
  for (const double pitch : {0.4, 0.1, 0.05}) {
    const Collider collider = beside(kBlock, pitch, 0.27);
    Counts counts;
    collider.query(assembly, {{-13, 10, -25}, {0, 0, 1}}, {}, counts);
    boxes.push_back(counts.boxes);
    Counts none;
    collider.query(assembly, {{-16, 10, -25}, {0, 0, 1}}, {}, none);
    EXPECT_EQ(none.boxes, 0U);
  }
  for (const std::size_t n : boxes) EXPECT_NEAR(double(n), double(boxes[0]), 0.01 * double(boxes[0]));
  // 15 mm of wall 10 mm high, in groups of eight.
  EXPECT_LT(boxes[0], 8 * 15 * 10 / (0.4 * 0.4));
}

TEST(Fixture, IsTheSameForAllInstructionSetsAndFiniteForNeedlesFarAway) {
  const Vec3 far(1e5, -1e5, 1e5);
  const Collider collider = beside({kBlock.lower + far, kBlock.upper + far}, 0.25, 0.3, "xyz");
  const Assembly needle(cutters::taper(0.01, 0.2, 4, 40)), held_ball(held(cutters::ball(6, 8)));
  std::vector<Contact> first;
  for (const std::string& name : sweep::instruction_sets()) {
    SCOPED_TRACE(name);
    sweep::use_instruction_set(name);
    Random random(4);
    std::vector<Contact> found;
    for (int n = 0; n < 40; ++n) {
      const Pose pose =
          leaning(random, far + Vec3(random.uniform(0, 30), random.uniform(0, 20), random.uniform(0, 10)), 1);
      found.push_back(collider.query(n % 2 ? needle : held_ball, pose));
      EXPECT_TRUE(geom::finite(found.back().force) && geom::finite(found.back().torque));
      EXPECT_GT(glm::length(found.back().force), 0);
    }
    if (first.empty()) first = found;
    for (std::size_t n = 0; n < found.size(); ++n) {
      ASSERT_EQ(found[n].force, first[n].force);
      ASSERT_EQ(found[n].stiffness, first[n].stiffness);
    }
  }
  sweep::use_instruction_set("");
}

}  // namespace
}  // namespace riffler::collide::fixture_test
