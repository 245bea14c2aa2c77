// How a tool leaves the material: no part of it may come down into what it leaves.
#include "nc/retract_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "riffler/tool/cutters.hpp"
#include "support/tilted.hpp"

namespace riffler::nc::retract_path_test {
namespace {

using test::tilted;

ClearanceZone space() {
  ClearanceZone out;
  out.box.add({-50, -40, -30}), out.box.add({50, 40, 20});
  out.top = 60;
  return out;
}

/// Whether the tool's centre line, of this length, is in the box with its tip here.
bool inside(const Box3& box, const Pose& pose, double length) {
  for (double h = 0; h <= length; h += 0.5) {
    const Vec3 p = pose.tip + h * pose.axis;
    if (p.x > box.lower.x && p.x < box.upper.x && p.y > box.lower.y && p.y < box.upper.y && p.z > box.lower.z &&
        p.z < box.upper.z)
      return true;
  }
  return false;
}

TEST(WayOut, LiftsTheWholeToolOutAtAnyTilt) {
  const Tool tool = cutters::ball(6, 80);
  const ToolEnvelope reach(&tool);
  for (double tilt = 0; tilt <= 180; tilt += 7.5)
    for (double around = 0; around < 360; around += 22.5) {
      const Pose pose{{3, -4, -5}, tilted(tilt, around)};
      const std::vector<Pose> way = retract_path(pose, reach, space());
      EXPECT_DOUBLE_EQ(way.back().tip.z, 60) << tilt << ' ' << around;
      // The first stretch is along the axis, where the tool has been; after it nothing of the tool is in the space.
      EXPECT_LT(glm::length(glm::cross(way[0].tip - pose.tip, pose.axis)), 1e-9);
      Box3 box = space().box;
      box.lower += Vec3(1e-9), box.upper -= Vec3(1e-9);
      for (std::size_t k = 1; k < way.size(); ++k)
        for (double s = 0; s <= 1; s += 1.0 / 64)
          EXPECT_FALSE(inside(box, Motion(way[k - 1], way[k]).at(s), tool.length()))
              << "tilt " << tilt << " around " << around << " stretch " << k << " at " << s;
    }
}

TEST(WayOut, GivesHowFarATiltedToolHangsBelowItsTip) {
  const Tool tool = cutters::flat(10, 60);
  const ToolEnvelope reach(&tool);
  EXPECT_EQ(reach.below_tip(1), 0);
  EXPECT_NEAR(reach.below_tip(0), 5, 1e-12);
  EXPECT_NEAR(reach.below_tip(-1), 60, 1e-12);
  EXPECT_NEAR(reach.below_tip(-0.6), 0.6 * 60 + 0.8 * 5, 1e-12);
}

TEST(WayOut, SweptBoxHoldsTheWholeToolAlongThePath) {
  const Tool tool = cutters::ball(6, 25).with_holder({{25, 14, 60, 16}});
  const ToolEnvelope reach(&tool);
  EXPECT_EQ(reach.length, 60);
  EXPECT_EQ(reach.radius, 16);
  for (double tilt = 0; tilt <= 160; tilt += 20)
    for (double around = 0; around < 360; around += 45) {
      const Pose from{{3, -4, -5}, tilted(10, 30)}, to{{-20, 9, 14}, tilted(tilt, around)};
      const Motion motion(from, to);
      const Box3 box = reach.swept_box(from, to);
      double least = 1e9;
      for (int k = 0; k <= 32; ++k)
        for (double h = 0; h <= 60; h += 10)
          for (int side = 0; side < 16; ++side) {
            const Pose pose = motion.at(k / 32.0);
            const Vec3 u = glm::normalize(glm::cross(pose.axis, Vec3(0.3, 0.5, 0.81))), v = glm::cross(pose.axis, u);
            const Vec3 p = pose.tip + h * pose.axis + 16.0 * (std::cos(0.4 * side) * u + std::sin(0.4 * side) * v);
            for (int i = 0; i < 3; ++i) least = std::min({least, p[i] - box.lower[i], box.upper[i] - p[i]});
          }
      EXPECT_GE(least, 0) << tilt << ' ' << around;
      EXPECT_LT(least, 20 + 60 * motion.angle() * motion.angle() / 8) << "and is no larger than it must be";
    }
}

}  // namespace
}  // namespace riffler::nc::retract_path_test
