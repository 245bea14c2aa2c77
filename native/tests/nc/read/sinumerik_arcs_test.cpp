// Circles and drilling cycles of Sinumerik programs, and the same paths in RS-274.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "geom/math.hpp"
#include "riffler/nc/read/reader.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::sinumerik_arcs_test {
namespace {

const Options kMetric{{"units", std::string("mm")}};

Program read(const std::string& text) {
  return test::read_nc_text(text, "sinumerik", kMetric);
}

std::string error(const std::string& text) {
  return test::nc_error(text, "sinumerik", kMetric);
}

/// A program whose path begins in (10, 0, 0).
Program from_ten(const std::string& text) {
  return read("G0 X10 Y0 Z0 F100\n" + text);
}

/// How far the tips, from the second row on, are from the circle about `centre`, mm; and the turn they make, rad.
void expect_circle(const Program& p, const Vec2& centre, double radius, double sweep, double rise = 0) {
  double turn = 0;
  for (std::size_t row = 1; row < p.size(); ++row) {
    const Vec3 a = p.poses()[row - 1].tip, b = p.poses()[row].tip;
    const Vec2 from(a.x - centre.x, a.y - centre.y), to(b.x - centre.x, b.y - centre.y);
    EXPECT_NEAR(glm::length(to), radius, 1e-6);
    turn += std::atan2(from.x * to.y - from.y * to.x, glm::dot(from, to));
    EXPECT_NEAR(b.z, rise * turn / sweep, 1e-6);
  }
  EXPECT_NEAR(turn, sweep, 1e-6);
}

TEST(SinumerikArcs, AreReadInAllForms) {
  expect_circle(from_ten("G3 X0 Y10 I-10 J0"), {0, 0}, 10, kPi / 2);
  expect_circle(from_ten("G2 X0 Y10 I=AC(0) J=AC(0)"), {0, 0}, 10, -1.5 * kPi);
  expect_circle(from_ten("G3 X0 Y10 CR=10"), {0, 0}, 10, kPi / 2);
  expect_circle(from_ten("G3 X0 Y10 CR=-10"), {10, 10}, 10, 1.5 * kPi);
  expect_circle(from_ten("G3 X0 Y10 AR=90"), {0, 0}, 10, kPi / 2);
  expect_circle(from_ten("G2 X0 Y10 AR=270"), {0, 0}, 10, -1.5 * kPi);
  expect_circle(from_ten("G3 I-10 AR=120"), {0, 0}, 10, 2 * kPi / 3);
  expect_circle(from_ten("G3 I-10"), {0, 0}, 10, kTwoPi);
  expect_circle(from_ten("G3 X=IC(-10) Y=IC(10) CR=10"), {0, 0}, 10, kPi / 2);
  expect_circle(from_ten("G3 X0 Y10 Z6 I-10 J0 TURN=2"), {0, 0}, 10, 4.5 * kPi, 6);
  expect_circle(from_ten("CIP X0 Y10 I1=10*SIN(45) J1=10*COS(45)"), {0, 0}, 10, kPi / 2);
  expect_circle(from_ten("CIP X0 Y10 I1=-10 J1=0"), {0, 0}, 10, -1.5 * kPi);
  EXPECT_EQ(from_ten("G3 I-10 Z5 TURN=1").notes.size(), 1U);
  expect_circle(from_ten("G3 I-10 Z5 TURN=1"), {0, 0}, 10, 2 * kTwoPi, 5);
  const Program tangent = read("G0 X0 Y0 Z0\nG1 X10 F100\nCT X20 Y10");
  EXPECT_NEAR(glm::length(tangent.poses()[5].tip - Vec3(10, 10, 0)), 10, 1e-6);
  const Vec3 end = tangent.poses().back().tip - tangent.poses()[tangent.size() - 2].tip;
  EXPECT_GT(end.y, 5 * std::abs(end.x)) << "a quarter about (10, 10)";
}

TEST(SinumerikArcs, LieInTheirPlaneAndFrame) {
  const Program zx = read("G0 X10 Y0 Z0\nG18 G3 X0 Z10 I-10 K0 F9");
  for (const Pose& p : zx.poses()) EXPECT_NEAR(std::hypot(p.tip.x, p.tip.z), 10, 1e-6);
  EXPECT_GT(zx.size(), 40U) << "against the clock seen from +Y, X turns away from Z: three quarters";
  const Program tilted = read("G0 X10 Y0 Z0\nROT X90\nG1 X10 Y0 F9\nG3 X0 Y10 CR=10");
  EXPECT_NEAR(tilted.poses().back().tip.z, 10, 1e-9);
  const Program space = read("G0 X10 Y0 Z0\nCIP X0 Y0 Z10 I1=0 J1=10 K1=0 F9");
  for (const Pose& p : space.poses()) EXPECT_NEAR(glm::length(p.tip), 10, 1e-6) << "a circle on the sphere";
}

TEST(SinumerikArcs, ErrorsNameTheFault) {
  EXPECT_EQ(error("G0 X10 Y0 Z0\nG3 X0 Y10 F9").substr(0, 58),
            "line 2: an arc without a centre (I, J, K), CR or AR [G3 X0");
  EXPECT_EQ(error("G0 X10 Y0 Z0\nG3 X0 Y12 I-10 F9").substr(0, 45), "line 2: the arc's end misses its circle by 2.");
  EXPECT_EQ(error("G0 X10 Y0 Z0\nG3 X0 Y10 CR=10 TURN=.5 F9").substr(0, 34), "line 2: TURN takes a whole number ");
  EXPECT_EQ(error("G0 X10 Y0 Z0\nG3 X10 CR=10 F9").substr(0, 40), "line 2: a full circle by R has no centre");
  EXPECT_EQ(error("G0 X10 Y0 Z0\nG3 X0 Y10 I-10 K5 F9").substr(0, 40), "line 2: K does not lie in the arc's plan");
  EXPECT_EQ(error("G0 X10 Y0 Z0\nCIP X0 I1=5 J1=0 F9").substr(0, 40), "line 2: CIP through a point on the line ");
  EXPECT_EQ(error("G0 X10 Y0 Z0\nCT X20 F9").substr(0, 50), "line 2: CT to a point straight ahead or behind: wr");
  EXPECT_EQ(error("G0 X10 Y0 Z0\nG3 X0 Y10 CR=1e7 F9").substr(0, 7), "line 2:");
}

/// (x, y, z, rapid) of the rows behind the first.
std::vector<std::array<double, 4>> strokes(const std::string& text) {
  std::vector<std::array<double, 4>> out;
  const Program p = read("G0 X0 Y0 Z50 S1000 M3 F100\n" + text);
  for (std::size_t row = 1; row < p.size(); ++row)
    out.push_back({p.poses()[row].tip.x, p.poses()[row].tip.y, p.poses()[row].tip.z, double(p.rapid()[row])});
  return out;
}

std::vector<double> heights(const std::string& text) {
  std::vector<double> out;
  for (const auto& row : strokes(text)) out.push_back(row[2]);
  return out;
}

TEST(SinumerikCycles, DrillToTheirDepths) {
  EXPECT_EQ(strokes("CYCLE81(20,5,3,-10)"),
            (std::vector<std::array<double, 4>>{{0, 0, 8, 1}, {0, 0, -10, 0}, {0, 0, 20, 1}}));
  EXPECT_EQ(heights("CYCLE82(20,5,3,,15,2)"), (std::vector<double>{8, -10, 20}));
  EXPECT_EQ(heights("CYCLE81(20,0,5,,2,0,0,1,11)"), (std::vector<double>{5, -2, 20}));
  std::vector<double> lows;  // pecks of 5, 4, 3, 2 and then of 1
  for (const auto& row : strokes("CYCLE83(20,0,3,-17,0,-5,,1,0,0,1,1)"))
    if (row[3] == 0) lows.push_back(row[2]);
  EXPECT_EQ(lows, (std::vector<double>{-5, -9, -12, -14, -15, -16, -17}));
  EXPECT_EQ(heights("CYCLE83(20,0,2,-10,,,4,0,,,1,1)"), (std::vector<double>{2, -4, 2, -3.4, -8, 2, -7.4, -10, 20}));
  EXPECT_EQ(heights("CYCLE83(20,0,2,-10,,,6,,,,1,0,,,0.5)"), (std::vector<double>{2, -6, -5.5, -10, 20}));
  EXPECT_EQ(heights("CYCLE85(20,0,2,-10,,0,50,200)"), (std::vector<double>{2, -10, 2, 20}));
  EXPECT_EQ(heights("CYCLE89(20,0,2,-10)"), (std::vector<double>{2, -10, 2, 20}));
  EXPECT_EQ(heights("CYCLE87(20,0,2,-10,,3)"), (std::vector<double>{2, -10, 20}));
  EXPECT_EQ(strokes("CYCLE86(20,0,2,-10,,0,3,-0.2,0.1,0.5,45)"),
            (std::vector<std::array<double, 4>>{
                {0, 0, 2, 1}, {0, 0, -10, 0}, {-0.2, 0.1, -9.5, 1}, {-0.2, 0.1, 20, 1}, {0, 0, 20, 1}}));
  EXPECT_EQ(read("G700 F10 S9 M3 G0 X0 Y0 Z2\nCYCLE81(1,0,0.1,-1)").poses()[2].tip.z, -25.4);
}

TEST(SinumerikCycles, TapByTheirPitch) {
  const Program rigid = read("G0 X0 Y0 Z50 S1000 M3\nCYCLE84(20,0,3,-10,,,3,8,,0,500,1000)");
  EXPECT_EQ(rigid.feed(), (std::vector<double>{0, 0, 625, 1250, 0}));
  EXPECT_EQ(rigid.spindle(), (std::vector<double>{1000, 1000, 500, -1000, 500}));
  const Program left = read("G0 X0 Y0 Z50 S1000 M3\nCYCLE84(20,0,3,-10,,,5,,-2,0,100)");
  EXPECT_EQ(left.feed()[2], 200);
  EXPECT_EQ(left.spindle(), (std::vector<double>{1000, 1000, -100, 100, 0}));
  EXPECT_EQ(read("G0 X0 Y0 Z50 S100 M3\nCYCLE840(20,0,3,-10,,,4,3,0,,1.5)").feed()[2], 150);
  EXPECT_EQ(error("G0 X0 Y0 Z50 S1000\nCYCLE84(20,0,3,-10)").substr(0, 54),
            "line 2: CYCLE84: neither MPIT nor PIT, the thread's pi");
}

TEST(SinumerikCycles, AreCalledAfterEachMove) {
  const auto rows = strokes("MCALL CYCLE81(20,0,2,-5)\nX1\nY2 Z30\nMCALL\nX9");
  ASSERT_EQ(rows.size(), 9U);
  EXPECT_EQ(rows[0], (std::array<double, 4>{1, 0, 50, 1}));
  EXPECT_EQ(rows[2], (std::array<double, 4>{1, 0, -5, 0}));
  EXPECT_EQ(rows[6], (std::array<double, 4>{1, 2, -5, 0}));
  EXPECT_EQ(rows[8], (std::array<double, 4>{9, 2, 20, 1}));
  const auto bottoms = [](const std::string& text) {
    std::vector<std::array<double, 2>> out;
    for (const auto& row : strokes("MCALL CYCLE81(20,0,2,-5)\n" + text))
      if (row[2] == -5) out.push_back({std::round(row[0] * 1e6) / 1e6 + 0.0, std::round(row[1] * 1e6) / 1e6 + 0.0});
    return out;
  };
  EXPECT_EQ(bottoms("HOLES1(10,0,90,5,10,3)"), (std::vector<std::array<double, 2>>{{10, 5}, {10, 15}, {10, 25}}));
  EXPECT_EQ(bottoms("G0 X10 Y30\nHOLES1(10,0,90,5,10,2)"),
            (std::vector<std::array<double, 2>>{{10, 30}, {10, 15}, {10, 5}}))
      << "from the nearer end";
  EXPECT_EQ(bottoms("HOLES2(0,0,10,0,0,4)"),
            (std::vector<std::array<double, 2>>{{10, 0}, {0, 10}, {-10, 0}, {0, -10}}));
  EXPECT_EQ(bottoms("HOLES2(5,0,10,90,30,2)"), (std::vector<std::array<double, 2>>{{5, 10}, {0, 8.660254}}));
}

TEST(SinumerikCycles, ErrorsNameTheFault) {
  const std::string start = "G0 X0 Y0 Z50 F9\n";
  EXPECT_EQ(error(start + "CYCLE81(20,0,2)").substr(0, 52), "line 2: CYCLE81: neither DP nor DPR, its depth, is g");
  EXPECT_EQ(error(start + "CYCLE81(20,0,2,-5,7)").substr(0, 48), "line 2: CYCLE81: DP and DPR name different depth");
  EXPECT_EQ(error(start + "CYCLE81(-20,0,2,-5)").substr(0, 43), "line 2: CYCLE81: holes upwards are not read");
  EXPECT_EQ(error("G0 X0 Y0 Z50\nCYCLE81(20,0,2,-5)").substr(0, 48),
            "line 2: CYCLE81: a drilling cycle without F [CYC");
  EXPECT_EQ(error(start + "HOLES1(0,0,0,1,1,3)").substr(0, 40), "line 2: HOLES1 without a modal cycle: MC");
  EXPECT_EQ(error(start + "MCALL HOLE(1)").substr(0, 30), "line 2: MCALL HOLE is not read");
  EXPECT_EQ(error(start + "CYCLE83(20,0,2,-1000,,,0.0001,,,,1,1)").substr(0, 31), "line 2: CYCLE83: too many pecks");
  EXPECT_EQ(error("G0 X0 Y0 Z0\nSUPA X0\nCYCLE81(20,0,2,-5)").substr(0, 28), "line 3: a cycle while X is a");
}

/// Lines and arcs at random, in both languages: the rows are equal.
TEST(SinumerikReader, ReadsThePathOfRs274) {
  std::mt19937 random(30);
  const auto number = [&](double most) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", std::uniform_real_distribution<double>(-most, most)(random));
    return std::string(text);
  };
  for (int round = 0; round < 60; ++round) {
    std::string iso = "G21 G90 G94 T1 M6\nS500 M3 G0 X0 Y0 Z5\nF600\nG43.4 H1\n";
    std::string sinumerik = "G710 G90 G94 T1 M6 D1\nS500 M3 G0 X0 Y0 Z5\nF600\nTRAORI\n";
    for (int k = 0; k < 30; ++k) {
      const std::string x = number(50), y = number(50), z = number(5);
      switch (random() % 5) {
        case 0:
          iso += "G1 X" + x + " Y" + y + " Z" + z + "\n", sinumerik += "G1 X=" + x + " Y=" + y + " Z" + z + "\n";
          break;
        case 1:
          iso += "G91 G0 X" + x + "\nG90\n", sinumerik += "G0 X=IC(" + x + ")\n;\n";
          break;
        case 2:
          iso += "G1 A" + y + " C" + x + "\n", sinumerik += "G1 A" + y + " C=" + x + "\n";
          break;
        case 3: {
          const std::string i = number(20), j = number(20);
          iso += "G2 I" + i + " J" + j + " Z" + z + "\n", sinumerik += "G2 I" + i + " J" + j + " Z" + z + "\n";
          break;
        }
        default:
          iso += "G3 G91 X1.5 Y2 R" + std::to_string(2 + random() % 9) + "\nG90\n";
          sinumerik +=
              "G3 X=IC(1.5) Y=IC(2) CR=" + iso.substr(iso.rfind('R') + 1, iso.rfind("\nG90") - iso.rfind('R') - 1) +
              "\n\n";
      }
    }
    const Program a = test::read_nc_text(iso, "tcp", {{"rapids", std::string("straight")}});
    const Program b = read(sinumerik);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a.line(), b.line());
    EXPECT_EQ(a.feed(), b.feed());
    EXPECT_EQ(a.rapid(), b.rapid());
    EXPECT_EQ(a.spindle(), b.spindle());
    for (std::size_t row = 0; row < a.size(); ++row) {
      EXPECT_LT(glm::length(a.poses()[row].tip - b.poses()[row].tip), 1e-9);
      EXPECT_LT(glm::length(a.poses()[row].axis - b.poses()[row].axis), 1e-12);
    }
    EXPECT_EQ(a.via().size(), b.via().size());
  }
}

}  // namespace
}  // namespace riffler::nc::sinumerik_arcs_test
