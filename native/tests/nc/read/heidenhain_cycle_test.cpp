// Drilling cycles of Heidenhain controls: the heights at one hole, as the manual has them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "geom/math.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::heidenhain_cycle_test {
namespace {

Program read(const std::string& blocks) {
  return test::read_nc_text(
      "BEGIN PGM T MM\nTOOL CALL 1 Z S1000 F80\nL X1 Y2 Z30 FMAX M3\n" + blocks + "\nEND PGM T MM\n", "heidenhain");
}

std::string error(const std::string& blocks) {
  return test::nc_error("BEGIN PGM T MM\nTOOL CALL 1 Z S1000 F80\nL X1 Y2 Z30 FMAX M3\n" + blocks + "\nEND PGM T MM\n",
                        "heidenhain");
}

/// Heights after the first row; feeds are negative spindles where `spindles`.
void expect_strokes(const Program& p, const std::vector<std::pair<double, double>>& wanted, const std::string& what) {
  ASSERT_EQ(p.size(), wanted.size() + 1) << what;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_NEAR(p.poses()[k + 1].tip.z, wanted[k].first, 1e-9) << what << ", stroke " << k;
    EXPECT_EQ(p.feed()[k + 1], wanted[k].second) << what << ", stroke " << k;
    EXPECT_EQ(Vec2(p.poses()[k + 1].tip.x, p.poses()[k + 1].tip.y), Vec2(1, 2)) << what;
  }
}

const std::string kHole = " ~\n Q200=2 ;SET-UP ~\n Q201=-10 ;DEPTH ~\n Q203=+1 ;SURFACE ~\n Q204=5 ~\n Q206=150 ~\n ";

TEST(HeidenhainCycle, Drills) {
  expect_strokes(read("CYCL DEF 200 DRILLING" + kHole + "Q202=20\nCYCL CALL"), {{3, 0}, {-9, 150}, {6, 0}}, "at once");
  expect_strokes(read("CYCL DEF 200 DRILLING" + kHole + "Q202=4 ~\n Q210=0 ~\n Q211=0,5\nL M99"),
                 {{3, 0}, {-3, 150}, {3, 0}, {-1, 0}, {-7, 150}, {3, 0}, {-5, 0}, {-9, 150}, {6, 0}}, "in pecks");
  expect_strokes(read("CYCL DEF 200 DRILLING" + kHole + "Q202=5\nFN 0: Q206 = 20\nCYCL CALL"),
                 {{3, 0}, {-4, 20}, {3, 0}, {-2, 0}, {-9, 20}, {6, 0}}, "parameters are those of the call");
  expect_strokes(read("CYCL DEF 200 D" + kHole + "Q202=5\nQ201=0\nCYCL CALL"), {}, "no depth");
}

TEST(HeidenhainCycle, ReamsAndPecks) {
  expect_strokes(read("CYCL DEF 201 REAMING" + kHole + "Q208=500\nCYCL CALL"), {{3, 0}, {-9, 150}, {3, 500}, {6, 0}},
                 "201");
  expect_strokes(read("CYCL DEF 201 REAMING" + kHole + "Q208=0\nCYCL CALL"), {{3, 0}, {-9, 150}, {3, 150}, {6, 0}},
                 "in F");
  expect_strokes(
      read("CYCL DEF 203 UNIVERSAL" + kHole +
           "Q202=4 ~\n Q213=1 ~\n Q212=1 ~\n Q205=1 ~\n Q256=0.5 ~\n Q208=MAX\nCYCL CALL"),
      {{3, 0}, {-3, 150}, {-2.5, 0}, {-6, 150}, {3, 0}, {-4, 0}, {-8, 150}, {-7.5, 0}, {-9, 150}, {3, 0}, {6, 0}},
      "203: breaks and full retractions by turns, in smaller and smaller steps");
  expect_strokes(read("CYCL DEF 205 PECKING" + kHole +
                      "Q202=4 ~\n Q258=0.6 ~\n Q259=0.2 ~\n Q257=3 ~\n Q256=0.5 ~\n Q379=1 ~\n "
                      "Q253=900\nCYCL CALL"),
                 {{3, 0},
                  {2, 900},
                  {-3, 150},
                  {-2.5, 0},
                  {-4, 150},
                  {3, 0},
                  {-3.4, 0},
                  {-7, 150},
                  {-6.5, 0},
                  {-8, 150},
                  {3, 0},
                  {-7.8, 0},
                  {-9, 150},
                  {3, 0},
                  {6, 0}},
                 "205");
  expect_strokes(
      read("CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 DIST25.000\nCYCL DEF 1.2 DEPTH -5,0\nCYCL DEF 1.3 PLNGNG3.0\nCYCL "
           "DEF 1.4 DWELL0\nCYCL DEF 1.5 F90\nCYCL CALL"),
      {{2, 90}, {30, 0}, {2.6, 0}, {0, 90}, {30, 0}}, "1");
}

TEST(HeidenhainCycle, TurnsTheSpindleBackWhenItTaps) {
  const Program rigid = read("CYCL DEF 207 RIGID TAPPING" + kHole + "Q239=-1.5\nCYCL CALL");
  expect_strokes(rigid, {{3, 0}, {-9, 1500}, {3, 1500}, {6, 0}}, "207");
  EXPECT_EQ(rigid.spindle(), (std::vector<double>{1000, 1000, -1000, 1000, -1000}));
  expect_strokes(read("CYCL DEF 206 TAPPING" + kHole + "Q211=0\nCYCL CALL"), {{3, 0}, {-9, 150}, {3, 150}, {6, 0}},
                 "206");
  expect_strokes(read("CYCL DEF 209 TAPPING" + kHole + "Q239=1 ~\n Q257=6 ~\n Q256=1\nCYCL CALL"),
                 {{3, 0}, {-5, 1000}, {-4, 1000}, {-9, 1000}, {3, 1000}, {6, 0}}, "209");
  const Program lip = read("CYCL DEF 241 SINGLE-LIP DEEP-HOLE DRILLING" + kHole +
                           "Q379=4 ~\n Q253=700 ~\n Q208=300 ~\n Q426=4 ~\n Q427=50 ~\n Q428=1790\nCYCL CALL");
  expect_strokes(lip, {{3, 0}, {-3, 700}, {-9, 150}, {3, 300}, {6, 0}}, "241");
  EXPECT_EQ(lip.spindle(), (std::vector<double>{1000, 1000, -50, 1790, -50, -50}));
}

TEST(HeidenhainCycle, BoresAndKeepsOffTheWall) {
  expect_strokes(read("CYCL DEF 202 BORING" + kHole + "Q208=400 ~\n Q214=0\nCYCL CALL"),
                 {{3, 0}, {-9, 150}, {3, 400}, {6, 0}}, "where it stays on the wall");
  const Program p = read("CYCL DEF 202 BORING" + kHole + "Q208=400 ~\n Q214=4\nCYCL CALL");
  std::vector<Vec3> tips;
  for (const Pose& pose : p.poses()) tips.push_back(pose.tip);
  EXPECT_EQ(tips,
            (std::vector<Vec3>{{1, 2, 30}, {1, 2, 3}, {1, 2, -9}, {1, 2.2, -9}, {1, 2.2, 3}, {1, 2.2, 6}, {1, 2, 6}}));
  EXPECT_EQ(p.spindle(), (std::vector<double>{1000, 1000, 1000, 0, 0, 0, 1000}));
  const Program old = read(
      "CYCL DEF 2.0 TAPPING\nCYCL DEF 2.1 AVST 10\nCYCL DEF 2.2 DEPTH -20\nCYCL DEF 2.3 DWELL 1\nCYCL DEF 2.4 "
      "F100\nCYCL CALL");
  expect_strokes(old, {{0, 100}, {30, 100}}, "2");
  EXPECT_EQ(old.spindle(), (std::vector<double>{1000, 1000, -1000}));
}

TEST(HeidenhainCycle, IsCalledAtItsPositions) {
  const Program p =
      read("CYCL DEF 200 D" + kHole +
           "Q202=20 ~\n Q206= AUTO\nL X10 FMAX M99\nL X20 FMAX\nL X30 FMAX M89\nL Y5 FMAX\nCC X0 Y0\nLP PR+40 PA+0 "
           "FMAX M99\nL X0 FMAX");
  std::vector<double> x;
  for (const Pose& pose : p.poses())
    if (pose.tip.z == -9) x.push_back(pose.tip.x);
  EXPECT_EQ(x, (std::vector<double>{10, 30, 30, 40}));
  EXPECT_EQ(
      read("CYCL DEF 200 D" + kHole + "Q202=20\nL X5 FMAX M89\nCYCL DEF 201 D" + kHole + "Q208=9\nL X6 FMAX").size(),
      6U)
      << "another cycle ends M89";
  EXPECT_EQ(p.feed()[3], 80) << "AUTO is the feed of TOOL CALL";
  // In a tilted plane along its normal, and from a position of the machine.
  const Program tilted =
      read("L Z0 FMAX M91\nPLANE SPATIAL SPA+90 SPB+0 SPC+0 TURN FMAX\nL X3 Y4 FMAX\nCYCL DEF 200 D" + kHole +
           "Q202=20\nCYCL CALL");
  EXPECT_LT(glm::length(tilted.poses()[tilted.size() - 2].tip - Vec3(3, 9, 4)), 1e-12);
}

TEST(HeidenhainCycle, BoresByAHelix) {
  const std::string bore = "CYCL DEF 208 BORE MILLING" + kHole + "Q334=3 ~\n Q335=20 ~\n Q342=0\nCYCL CALL";
  for (const std::string tool :
       {"TOOL DEF 2 L+0 R+4\nTOOL CALL 2 Z S1000", "; T: END MILL / DM=8 CR=0\nTOOL CALL 2 Z S1000"}) {
    const Program p = read(tool + "\nM3\n" + bore);
    double lowest = 30, turns = 0;
    for (std::size_t row = 2; row + 1 < p.size(); ++row) {
      const Vec3 a = p.poses()[row - 1].tip - Vec3(1, 2, 0), b = p.poses()[row].tip - Vec3(1, 2, 0);
      EXPECT_LE(std::hypot(b.x, b.y), 6 + 1e-9);
      lowest = std::min(lowest, b.z);
      turns += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y) / (2 * kPi);
    }
    EXPECT_EQ(lowest, -9);
    EXPECT_NEAR(turns, 5, 1e-9) << "four of 3 mm from above the ground, and one at it";
    EXPECT_EQ(p.poses().back().tip, Vec3(1, 2, 6));
    EXPECT_EQ(p.notes.back().kind, "bore milling");
  }
  EXPECT_EQ(error(bore).substr(0, 48), "line 13: cycle 208 (bore milling) needs the tool");
}

TEST(HeidenhainCycle, RefusesInvalidValues) {
  const std::pair<std::string, std::string> cases[] = {
      {"CYCL DEF 200 D" + kHole + "Q202=0\nCYCL CALL", "Q202, the depth of a peck, must be positive"},
      {"CYCL DEF 200 D" + kHole + "Q202=1 ~\n Q201=5\nCYCL CALL", "Q201, the depth of cycle 200, must be negative"},
      {"CYCL DEF 200 D ~\n Q200=1\nCYCL CALL", "Q201, its depth, is missing"},
      {"CYCL DEF 200 D" + kHole + "Q202=0.00001\nCYCL CALL", "Q202 is too small: too many pecks"},
      {"CYCL DEF 251 POCKET ~\n Q215=0\nCYCL CALL", "cycle 251 is not read"},
      {"CYCL DEF 200 D" + kHole + "Q202=1\nCYCL CALL POS X1", "CYCL CALL POS and PAT are not read"},
      {"CYCL DEF 200 D" + kHole + "Q202=5\nCYCL DEF 201 D ~\n Q201=-3\nCYCL CALL",
       "Q203, the coordinate of the surface, is missing"},
      {"CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 DIST 2\nL M99", "cycle 1 without its part 1.2"},
      {"CYCL DEF 200 D" + kHole + "Q202=5\nL X5 FMAX M91\nCYCL CALL", "a cycle while X is at a machine position"},
      {"CYCL DEF 200 D" + kHole + "Q202=5\nM128\nL A30 FMAX\nCYCL CALL", "a feed move with the rotary axes at A30 C0"},
  };
  for (const auto& [blocks, wanted] : cases) {
    const std::string is = error(blocks);
    EXPECT_NE(is.find(": " + wanted), is.npos) << blocks << ": " << is;
  }
}

}  // namespace
}  // namespace riffler::nc::heidenhain_cycle_test
