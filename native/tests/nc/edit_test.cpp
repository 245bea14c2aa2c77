#include "riffler/nc/edit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "riffler/nc/cutter_path.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/error_of.hpp"

namespace riffler::nc::edit_test {
namespace {

using test::error_of;

Program two_cuts() {
  Program p;
  for (int k = 0; k < 6; ++k)
    p.append({{{1.0 * k, 2, 3}, glm::normalize(Vec3(0.1 * k, 0, 1))}, 100.0 + k, 9000, k < 3 ? 1 : 2, 10 + k, k == 3});
  p.tools.emplace(1, cutters::ball(6, 30)), p.tools.emplace(2, cutters::flat(4, 20));
  p.provenance = {{"part", "a"}};
  return p;
}

TEST(Edit, TrimmedKeepsTheRowsAndReachesTheFirstByARapid) {
  const Program p = two_cuts(), t = trimmed(p, 1, 5);
  ASSERT_EQ(t.size(), 4U);
  EXPECT_TRUE(t[0].rapid);
  for (std::size_t row = 0; row < 4; ++row) {
    EXPECT_EQ(t[row].pose.tip, p[row + 1].pose.tip);
    EXPECT_EQ(t[row].line, p[row + 1].line);
    EXPECT_EQ(t[row].tool, p[row + 1].tool);
  }
  EXPECT_EQ(t.tools.size(), 2U);
  EXPECT_EQ(error_of([&] { trimmed(p, 3, 3); }), "rows 3 to 3 of 6");
  EXPECT_EQ(error_of([&] { trimmed(p, 0, 7); }), "rows 0 to 7 of 6");
}

TEST(Edit, TransformedTurnsTipsAndAxes) {
  const Mat3 quarter(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));  // about z
  const Program p = two_cuts(), t = transformed(p, quarter, {10, 0, -1});
  for (std::size_t row = 0; row < p.size(); ++row) {
    const Pose &was = p[row].pose, &is = t[row].pose;
    EXPECT_EQ(is.tip, Vec3(-was.tip.y + 10, was.tip.x, was.tip.z - 1));
    EXPECT_LT(glm::length(is.axis - Vec3(-was.axis.y, was.axis.x, was.axis.z)), 1e-15);
    EXPECT_EQ(t[row].feed, p[row].feed);
  }
  const char* what = "matrix must be a rotation and a translation: no scale, no mirror, finite";
  EXPECT_EQ(error_of([&] { transformed(p, Mat3(2.0), {0, 0, 0}); }), what);
  EXPECT_EQ(error_of([&] { transformed(p, Mat3(-1.0), {0, 0, 0}); }), what);
  EXPECT_EQ(error_of([&] { transformed(p, Mat3(1.0), {0, NAN, 0}); }), what);
}

TEST(Edit, RetimedLeavesRapidsUnchanged) {
  const Program p = two_cuts(), t = scale_feeds(p, 0.5);
  for (std::size_t row = 0; row < p.size(); ++row) EXPECT_EQ(t[row].feed, 0.5 * p[row].feed);
  EXPECT_TRUE(t[3].rapid);
  EXPECT_EQ(error_of([&] { scale_feeds(p, 0); }), "factor must be positive and finite");
  EXPECT_EQ(error_of([&] { scale_feeds(p, 1e9); }), "feed, row 0: must be positive and finite");
}

TEST(Edit, JoinedHasTheRowsOfAllAndOneShapeForEveryNumber) {
  const Program p = two_cuts(), q = scale_feeds(trimmed(p, 0, 3), 2);
  const Program* both[] = {&p, &q};
  const Program all = joined(both);
  ASSERT_EQ(all.size(), 9U);
  EXPECT_EQ(all[8].feed, q[2].feed);
  EXPECT_EQ(all.provenance.size(), 1U);
  Program other = p;
  other.tools.clear(), other.tools.emplace(1, cutters::ball(8, 30));
  const Program* wrong[] = {&p, &other};
  EXPECT_EQ(error_of([&] { joined(wrong); }), "tool 1 would be ball 6 and ball 8");
  EXPECT_TRUE(joined({}).empty());
}

TEST(Edit, RetooledRenamesRowsAndTools) {
  const Program p = two_cuts(), t = renumber_tools(p, {{1, 2}, {2, 7}});
  for (std::size_t row = 0; row < p.size(); ++row) EXPECT_EQ(t[row].tool, p[row].tool == 1 ? 2 : 7);
  EXPECT_EQ(t.tools.at(2).name(), "ball 6");
  EXPECT_EQ(t.tools.at(7).name(), "flat 4");
  EXPECT_EQ(error_of([&] { renumber_tools(p, {{1, 2}}); }), "tool 2 would be ball 6 and flat 4");
  EXPECT_EQ(error_of([&] { renumber_tools(p, {{1, 0}}); }), "tool 1: 0 is not a tool number");
}

}  // namespace
}  // namespace riffler::nc::edit_test
