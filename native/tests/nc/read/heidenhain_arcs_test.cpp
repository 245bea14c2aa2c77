// Arcs, helices and corners of Heidenhain's conversational programs, against their circles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geom/math.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::heidenhain_arcs_test {
namespace {

Program read(const std::string& blocks, Options options = {}) {
  return test::read_nc_text("BEGIN PGM T MM\n" + blocks + "\nEND PGM T MM\n", "heidenhain", std::move(options));
}

std::string error(const std::string& blocks) {
  return test::nc_error("BEGIN PGM T MM\n" + blocks + "\nEND PGM T MM\n", "heidenhain");
}

/// Every chord from row `first` on keeps to the circle within the chord tolerance.
void expect_circle(const Program& p, std::size_t first, const Vec3& centre, double radius, int u, int v,
                   const std::string& what) {
  for (std::size_t row = first; row < p.size(); ++row) {
    const Vec3 a = p.poses()[row - 1].tip - centre, b = p.poses()[row].tip - centre, m = (a + b) / 2.0;
    EXPECT_NEAR(std::hypot(b[u], b[v]), radius, 1e-6) << what << ", row " << row;
    EXPECT_GE(std::hypot(m[u], m[v]), radius - 0.0021) << what << ", row " << row;
  }
}

double way(const Program& p, std::size_t first) {
  double out = 0;
  for (std::size_t row = first; row < p.size(); ++row) out += glm::length(p.poses()[row].tip - p.poses()[row - 1].tip);
  return out;
}

/// Sum of the turns about `centre` from row to row, rad, counter-clockwise from u to v.
double turned(const Program& p, std::size_t first, const Vec3& centre, int u, int v) {
  double out = 0;
  for (std::size_t row = first; row < p.size(); ++row) {
    const Vec3 a = p.poses()[row - 1].tip - centre, b = p.poses()[row].tip - centre;
    out += std::atan2(a[u] * b[v] - a[v] * b[u], a[u] * b[u] + a[v] * b[v]);
  }
  return out;
}

TEST(HeidenhainArcs, CirclesAboutTheirCentreInEveryPlane) {
  const char* axes[3][2] = {{"X", "Y"}, {"Y", "Z"}, {"Z", "X"}};
  for (int plane = 0; plane < 3; ++plane) {
    const int u = plane, v = (plane + 1) % 3;
    const std::string a = axes[plane][0], b = axes[plane][1];
    for (const bool clockwise : {false, true}) {
      const std::string what = a + b + (clockwise ? " DR-" : " DR+"), dr = clockwise ? " DR-" : " DR+";
      Vec3 centre(1, 2, 3);
      const std::string start = "L X1 Y2 Z3 FMAX\nL I" + a + "+10 F100\nCC " + a + std::to_string(u + 1) + " " + b +
                                std::to_string(v + 1) + "\n";
      const Program quarter = read(start + "C " + a + std::to_string(u + 1) + " " + b + std::to_string(v + 11) + dr);
      expect_circle(quarter, 2, centre, 10, u, v, what);
      EXPECT_NEAR(turned(quarter, 2, centre, u, v), clockwise ? -1.5 * kPi : 0.5 * kPi, 1e-9) << what;
      const Program full = read(start + "C" + dr);
      EXPECT_NEAR(turned(full, 2, centre, u, v), clockwise ? -2 * kPi : 2 * kPi, 1e-9) << what;
      EXPECT_EQ(full.poses().back().tip, full.poses()[1].tip) << what;
      const Program polar = read(start + "CP IPA" + (clockwise ? "-" : "+") + "270" + dr + "\n");
      EXPECT_NEAR(turned(polar, 2, centre, u, v), (clockwise ? -1.5 : 1.5) * kPi, 1e-9) << what;
    }
  }
}

TEST(HeidenhainArcs, AreReadByRadius) {
  for (const auto& [block, sweep] : std::vector<std::pair<std::string, double>>{{"CR X0 Y10 R+10 DR+", 0.5},
                                                                                {"CR X0 Y10 R-10 DR-", -1.5},
                                                                                {"CR IX-20 R10 DR+", 1},
                                                                                {"CR X-10 Y0 R+10 DR-", -1}}) {
    const Program p = read("L X10 Y0 Z0 FMAX\n" + block + " F100");
    EXPECT_NEAR(turned(p, 1, {0, 0, 0}, 0, 1), sweep * kPi, 1e-9) << block;
    expect_circle(p, 1, {0, 0, 0}, 10, 0, 1, block);
  }
  const Program other = read("L X10 Y0 Z0 FMAX\nCR X0 Y10 R+10 DR- F100");
  expect_circle(other, 1, {10, 10, 0}, 10, 0, 1, "the other centre");
  EXPECT_EQ(error("L X10 Y0 Z0 FMAX\nCR X10 Y0 R+10 DR- F100").substr(0, 44),
            "line 3: a full circle by R has no centre [CR");
}

TEST(HeidenhainArcs, HelicesMayTurnSeveralTimes) {
  const Program p = read("L X10 Y0 Z0 FMAX\nCC X0 Y0\nCP IPA-1170 IZ-6.5 DR- F100");
  expect_circle(p, 1, {0, 0, 0}, 10, 0, 1, "helix");
  EXPECT_NEAR(turned(p, 1, {0, 0, 0}, 0, 1), -6.5 * kPi, 1e-9);
  EXPECT_NEAR(way(p, 1), std::hypot(65 * kPi, 6.5), 0.02);
  EXPECT_LT(glm::length(p.poses().back().tip - Vec3(0, -10, -6.5)), 1e-9);
  for (std::size_t row = 1; row < p.size(); ++row) {
    const double t = static_cast<double>(row) / static_cast<double>(p.size() - 1);
    EXPECT_NEAR(p.poses()[row].tip.z, -6.5 * t, 1e-9);
  }
  const Program third = read("L X10 Y0 Z0 FMAX\nCC X0 Y0\nC X0 Y10 Z2 DR+ F100");
  EXPECT_EQ(third.poses().back().tip, Vec3(0, 10, 2));
  const Program absolute = read("L X10 Y0 Z0 FMAX\nCC\nL X20 F100\nCP PA+90 Z-1 DR-\nCP PA+90 DR+");
  EXPECT_NEAR(turned(absolute, 2, {10, 0, 0}, 0, 1), (-1.5 + 2) * kPi, 1e-9) << "to its own angle: a full turn";
  EXPECT_EQ(error("L X10 Y0 Z0 FMAX\nCC X0 Y0\nCP IPA+90 DR- F100"),
            "line 4: IPA and DR have different signs [CP IPA+90 DR- F100]");
}

TEST(HeidenhainArcs, PolarLinesAreRead) {
  const Program p = read("CC X+50 Y+50\nL X50 Y50 Z0 FMAX\nLP PR+30 PA+0 FMAX\nLP IPA+90 F100\nLP IPR-10 Z2\nLP PA180");
  const std::vector<Vec3> wanted{{50, 50, 0}, {80, 50, 0}, {50, 80, 0}, {50, 70, 2}, {30, 50, 2}};
  ASSERT_EQ(p.size(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_LT(glm::length(p.poses()[k].tip - wanted[k]), 1e-12) << k;
}

TEST(HeidenhainArcs, TangentCirclesAreRead) {
  const Program p = read("L X0 Y0 Z0 FMAX\nL X10 F100\nCT X20 Y10\nCT X10 Y20");
  expect_circle(p, 2, {10, 10, 0}, 10, 0, 1, "one circle of both");
  EXPECT_NEAR(turned(p, 2, {10, 10, 0}, 0, 1), kPi, 1e-9);
  const Program right = read("L X0 Y0 Z0 FMAX\nL X10 F100\nCT X20 Y-10");
  EXPECT_NEAR(turned(right, 2, {10, -10, 0}, 0, 1), -0.5 * kPi, 1e-9);
  EXPECT_EQ(error("L X0 Y0 Z0 FMAX\nL X10 F100\nCT X20").substr(0, 44), "line 4: CT to a point straight ahead or behi");
  EXPECT_EQ(error("CT X20 Y1 F100").substr(0, 40), "line 2: CT without an element before it ");
}

TEST(HeidenhainArcs, CornersAreRoundedAndChamfered) {
  const Program p = read("L X0 Y0 Z0 FMAX\nL X20 F100\nRND R5 F50\nL Y20\nCHF 3\nL X0\nL Z9");
  // To the arc, along it, to the chamfer, across, and on.
  EXPECT_EQ(p.poses()[1].tip, Vec3(15, 0, 0));
  std::size_t end = 2;
  while (p.feed()[end] == 50) ++end;
  for (std::size_t row = 2; row < end; ++row) {
    const Vec3 from_centre = p.poses()[row].tip - Vec3(15, 5, 0);
    EXPECT_NEAR(glm::length(from_centre), 5, 1e-9);
  }
  EXPECT_LT(glm::length(p.poses()[end - 1].tip - Vec3(20, 5, 0)), 1e-12);
  EXPECT_EQ(p.poses()[end].tip, Vec3(20, 17, 0));
  EXPECT_EQ(p.poses()[end + 1].tip, Vec3(17, 20, 0));
  EXPECT_EQ(p.poses()[end + 2].tip, Vec3(0, 20, 0));
  EXPECT_EQ(p.poses().back().tip, Vec3(0, 20, 9));
  EXPECT_EQ(p.line()[1], 3);
  EXPECT_EQ(p.line()[end], 5);
  // Straight on there is no corner.
  EXPECT_EQ(read("L X0 Y0 Z0 FMAX\nL X20 F100\nRND R5\nL X30").poses()[1].tip, Vec3(20, 0, 0));
  EXPECT_EQ(error("L X0 Y0 Z0 FMAX\nL X20 F100\nRND R25\nL Y20"),
            "line 5: RND or CHF is larger than its lines [L Y20]");
  for (const std::string blocks :
       {"L X20 F100\nRND R5\nCC X0 Y0\nC X0 Y20 DR+", "RND R5\nL X5 F9", "L X20 F100\nRND R5\nL Z5",
        "L X20 F100\nRND R5", "L X20 F100\nCHF 5\nL X5", "L X20 F100\nRND R0\nL Y5"})
    EXPECT_NE(error("L X0 Y0 Z0 FMAX\n" + blocks), "no error") << blocks;
}

TEST(HeidenhainArcs, AreReadInTiltedPlanes) {
  const Program p =
      read("PLANE SPATIAL SPA+90 SPB+0 SPC+0 TURN FMAX\nL X10 Y0 Z5 FMAX\nCC X0 Y0\nCP IPA+360 IZ-2 DR+ F100");
  // The plane's y is the part's z, its z the part's −y.
  expect_circle(p, 1, {0, 0, 0}, 10, 0, 2, "in the part");
  EXPECT_NEAR(turned(p, 1, {0, 0, 0}, 0, 2), 2 * kPi, 1e-9);
  EXPECT_LT(glm::length(p.poses().back().tip - Vec3(10, -3, 0)), 1e-12);
  EXPECT_LT(glm::length(p.poses().back().axis - Vec3(0, -1, 0)), 1e-12);
}

TEST(HeidenhainArcs, InvalidOnesAreRefused) {
  EXPECT_EQ(error("L X1 Y0 Z0 FMAX\nC X0 Y1 DR+ F9"), "line 3: C without a centre: CC before it [C X0 Y1 DR+ F9]");
  EXPECT_EQ(error("L X1 Y0 Z0 FMAX\nCC X0 Y0\nC X0 Y1 F9"),
            "line 4: an arc without its sense, DR+ or DR- [C X0 Y1 F9]");
  EXPECT_EQ(error("L X1 Y0 Z0 FMAX\nCC X0 Y0\nC X0 Y2 DR+ F9").substr(0, 52),
            "line 4: the arc's end misses its circle by 1.0000 mm");
  EXPECT_EQ(error("L X1 Y0 Z0 FMAX\nCC X0\nC X0 Y2 DR+ F9"), "line 3: CC needs two coordinates: write both [CC X0]");
  EXPECT_EQ(error("L X1 Y0 Z0 FMAX\nCC X1 Y0\nCP IPA+90 F9"), "line 4: an arc of radius 0 [CP IPA+90 F9]");
  EXPECT_EQ(error("L X1 Y0 Z0 FMAX\nCC X0 Y0\nCP IPA+0 DR+ F9"), "line 4: CP by an angle of 0 [CP IPA+0 DR+ F9]");
  EXPECT_EQ(error("L X1 Y0 Z0 FMAX\nL Z0 FMAX M91\nCC X0 Y0\nC DR+ F9").substr(0, 40),
            "line 5: an arc while Z is at a machine p");
  // Ends within 0.016 mm are taken, as the control does, and more where the option says so.
  EXPECT_EQ(error("L X10 Y0 Z0 FMAX\nCC X0 Y0\nC X0 Y10.015 DR+ F9"), "no error");
  EXPECT_EQ(read("L X10 Y0 Z0 FMAX\nCC X0 Y0\nC X0 Y10.1 DR+ F9", {{"arc_tolerance", 0.2}}).poses().back().tip,
            Vec3(0, 10.1, 0));
}

}  // namespace
}  // namespace riffler::nc::heidenhain_arcs_test
