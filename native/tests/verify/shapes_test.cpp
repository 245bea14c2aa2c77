#include "verify/shapes.hpp"

#include <gtest/gtest.h>

#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"
#include "verify/moves.hpp"

namespace riffler::verify::shapes_test {
namespace {

Pose random_pose(stress::Random& random) {
  return {{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)}, random.direction()};
}

TEST(Rod, ASweptBoxHoldsEveryPointOfTheMotion) {
  stress::Random random(11);
  for (int round = 0; round < 3000; ++round) {
    const Pose from = random_pose(random);
    Pose to = random_pose(random);
    if (random.one_in(3)) to.axis = from.axis;
    if (random.one_in(4)) to.tip = from.tip;
    const double low = random.uniform(-5, 20);
    const Rod rod{low, low + random.uniform(0.1, 30), random.uniform(0.1, 20)};
    const double top = random.one_in(2) ? 1e9 : random.uniform(-20, 20);
    const Box3 box = rod.swept(from, to, top);
    const Motion motion(from, to);
    for (int k = 0; k < 40; ++k) {
      const Pose pose = motion.at(random.uniform());
      const Vec3 out = random.square_to(pose.axis);
      const Vec3 p = pose.tip + random.uniform(rod.low, rod.high) * pose.axis + random.uniform(0, rod.radius) * out;
      if (p.z > top) continue;
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(box.lower[i] <= p[i] && p[i] <= box.upper[i]) << round;
    }
  }
}

TEST(Rod, AMotionAboveEverythingHasNoBox) {
  const Rod holder{20, 60, 20};
  EXPECT_TRUE(holder.swept({{0, 0, -5}, {0, 0, 1}}, {{9, 0, -5}, {0, 0, 1}}, -10).empty());
  const Vec3 tilted = glm::normalize(Vec3(1, 0, 1));
  EXPECT_FALSE(holder.swept({{0, 0, -5}, tilted}, {{9, 0, -5}, tilted}, 0).empty());  // its rim dips below
}

TEST(ToolShapes, ProbesAreSmallerByTheToleranceAndNeverNothing) {
  const Tool tool =
      cutters::ball(6, 20).with_shank({{20, 3, 30, 5}}).with_holder({{30, 20, 30.004, 20}, {31, 0, 40, 9}});
  const ToolShapes shapes(tool, 0.01, 100, 0.25);
  ASSERT_EQ(shapes.probes.size(), 3U);
  for (const Probe& probe : shapes.probes) {
    ASSERT_EQ(probe.real.size(), probe.small.size());
    for (std::size_t k = 0; k < probe.real.size(); ++k) {
      const tool::Piece &real = probe.real[k].pieces[0], &small = probe.small[k].pieces[0];
      EXPECT_LT(bottom(real), bottom(small));
      EXPECT_LT(bottom(small), top(small));
      EXPECT_LT(top(small), top(real));
      EXPECT_LT(max_radius(small), max_radius(real));
      EXPECT_LT(max_radius(real) - max_radius(small), 0.025);
    }
  }
  // Beyond the holder the tool continues, a pitch wider than its widest part.
  EXPECT_EQ(shapes.probes[2].member, Member::Beyond);
  EXPECT_EQ(bottom(shapes.probes[2].real[0].pieces[0]), 40);
  EXPECT_EQ(max_radius(shapes.probes[2].real[0].pieces[0]), 20.25);
}

TEST(Moves, BlocksOfBoxesLeaveNoMoveOut) {
  stress::Random random(3);
  std::vector<Pose> poses;
  for (int k = 0; k < 500; ++k) poses.push_back({{k * 0.1, random.uniform(-1, 1), 0}, {0, 0, 1}});
  const std::vector<ToolShapes> shapes{ToolShapes(cutters::ball(2, 5), 0.01, 10, 0.5)};
  Moves moves(poses, 1, shapes, 100);
  for (int k = 1; k < 500; ++k) moves.add(k, k % 7 == 0 ? kNoTool : 0, false);
  moves.finish();
  for (const std::size_t first : {0U, 5U, 64U, 100U}) {
    const Box3 box{{20, -1, 0}, {21, 1, 1}};
    std::vector<std::size_t> found;
    moves.for_each(first, box, [&](std::size_t i, Moves::Touch) { found.push_back(i); });
    std::vector<std::size_t> wanted;
    for (std::size_t i = first; i < moves.size(); ++i)
      if (moves.touch(i, box) != Moves::None) wanted.push_back(i);
    EXPECT_EQ(found, wanted);
    EXPECT_FALSE(found.empty());
  }
}

}  // namespace
}  // namespace riffler::verify::shapes_test
