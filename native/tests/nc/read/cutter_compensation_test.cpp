// The path of the tool's centre along a contour. tests/python compares it with LinuxCNC's interpreter and with the
// contour itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "nc/read/cutter_compensation.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::cutter_compensation_test {
namespace {

using test::nc_error;
using test::read_nc_text;

const Options kOffset{{"cutter_compensation", std::string("offset")}};

Options with(Options options, const std::string& name, OptionValue value) {
  options[name] = std::move(value);
  return options;
}

Program read(const std::string& text, double diameter = 2) {
  return read_nc_text("G21 G90 F100\n" + text, "3-axis", with(kOffset, "tool_diameters", diameter));
}

std::string error(const std::string& text, double diameter = 2) {
  return nc_error("G21 G90 F100\n" + text, "3-axis", with(kOffset, "tool_diameters", diameter));
}

/// The tips of all rows.
std::vector<Vec3> tips(const Program& program) {
  std::vector<Vec3> out;
  for (const Pose& pose : program.poses()) out.push_back(pose.tip);
  return out;
}

void expect_tips(const Program& program, const std::vector<Vec3>& wanted, double tolerance = 1e-9) {
  const std::vector<Vec3> is = tips(program);
  ASSERT_EQ(is.size(), wanted.size());
  for (std::size_t k = 0; k < is.size(); ++k) EXPECT_LT(glm::length(is[k] - wanted[k]), tolerance) << k;
}

/// mm by which the tool of radius 1 comes nearest to a point.
double nearest(const Program& program, const Vec2& point) {
  double out = 1e9;
  for (std::size_t k = 1; k < program.size(); ++k) {
    const Vec3 &a = program.poses()[k - 1].tip, &b = program.poses()[k].tip;
    for (int i = 0; i <= 50; ++i) {
      const Vec3 at = a + (i / 50.0) * (b - a);
      out = std::min(out, glm::length(Vec2(at.x, at.y) - point));
    }
  }
  return out;
}

constexpr const char* kStart = "G0 X-5 Y0 Z0\nG41 D1\n";

// --- Degenerate limits ---

TEST(CutterCompensation, WithoutMotionInThePlaneStaysBesideTheSamePoint) {
  expect_tips(read(std::string(kStart) + "G1 X0\nZ-1\nX0 Y0\nX10\nG40\nG1 X15"),
              {{-5, 0, 0}, {0, 1, 0}, {0, 1, -1}, {0, 1, -1}, {10, 1, -1}, {15, 0, -1}});
  // Before the first move in the plane there is no side to be on.
  expect_tips(read(std::string(kStart) + "G1 Z-1\nX0\nG40"), {{-5, 0, 0}, {-5, 0, -1}, {0, 1, -1}});
}

TEST(CutterCompensation, StraightOnHasNoCorner) {
  expect_tips(read(std::string(kStart) + "G1 X0\nX5\nX10\nX10.0000001\nX20"),
              {{-5, 0, 0}, {0, 1, 0}, {5, 1, 0}, {10, 1, 0}, {10, 1, 0}, {20, 1, 0}}, 1e-6);
  for (const char* y : {"1e-9", "-1e-9", "1e-12", "-1e-12"}) {
    const std::string to = std::string("[") + (y[0] == '-' ? "0 - " : "") + "1 / " +
                           (std::string(y).find("12") != std::string::npos ? "1000000000000" : "1000000000") + "]";
    const Program p = read(std::string(kStart) + "G1 X0\nX5\nX10 Y" + to + "\nX20 Y0");
    EXPECT_EQ(p.size(), 5U) << y;
    for (std::size_t k = 1; k < p.size(); ++k) EXPECT_NEAR(p.poses()[k].tip.y, 1, 1e-8) << y;
  }
}

TEST(CutterCompensation, GoesRoundTheEndOfALineThatIsRetraced) {
  const Program p = read(std::string(kStart) + "G1 X0\nX10\nX0\nG40");
  EXPECT_LT(glm::length(p.poses().back().tip - Vec3(0, -1, 0)), 1e-9);
  EXPECT_NEAR(nearest(p, {10, 0}), 1, 0.002);
  const auto far = tips(p);
  const double most = std::ranges::max(far, {}, &Vec3::x).x;
  EXPECT_NEAR(most, 11, 0.01);
}

TEST(CutterCompensation, GoesRoundWholeCircles) {
  for (const bool inside : {true, false}) {
    const Program p =
        read("G0 X0 Y5 Z0\nG4" + std::string(inside ? "2" : "1") + " D1\nG1 X5 Y5\nX10\nG2 J-10\nG1 X15\nG40");
    const double radius = inside ? 9 : 11;
    int on = 0;
    for (const Vec3& tip : tips(p)) on += std::abs(glm::length(Vec2(tip.x - 10, tip.y + 5)) - radius) < 1e-9;
    EXPECT_GT(on, 100);
    EXPECT_LT(glm::length(p.poses().back().tip - Vec3(15, inside ? 4 : 6, 0)), 1e-9);
  }
}

TEST(CutterCompensation, JoinsTangentArcs) {
  // Half circles in an S, the tool inside of the first and outside of the second.
  const Program p = read("G0 X0 Y-5 Z0\nG41 D1\nG1 Y0\nG3 X-10 I-5\nG2 X-20 I-5\nG1 Y-5\nG40");
  for (std::size_t k = 1; k + 1 < p.size(); ++k) {
    const Vec3 tip = p.poses()[k].tip;
    const bool first = tip.x > -9, second = tip.x < -9;
    if (first && tip.y > 1e-9) {
      EXPECT_NEAR(glm::length(Vec2(tip.x + 5, tip.y)), 4, 1e-9);
    }
    if (second && tip.y < -1e-9 && tip.x > -20.5) {
      EXPECT_NEAR(glm::length(Vec2(tip.x + 15, tip.y)), 6, 1e-9);
    }
  }
  EXPECT_NEAR(p.poses().back().tip.y, -5, 1e-9);
}

TEST(CutterCompensation, IsAsExactFarFromTheOrigin) {
  const Program p = read("G0 X99995 Y100000 Z0\nG41 D1\nG1 X100000\nX100010\nY100010\nG3 X100000 I-5\nG1 Y100000\nG40");
  EXPECT_LT(glm::length(p.poses()[2].tip - Vec3(100009, 100001, 0)), 1e-9);
  EXPECT_LT(glm::length(p.poses()[3].tip - Vec3(100009, 100010, 0)), 1e-9);
}

// --- Corners ---

TEST(CutterCompensation, MeetsAtInsideCorners) {
  expect_tips(read(std::string(kStart) + "G1 X0\nX10\nY10\nX5\nG40"),
              {{-5, 0, 0}, {0, 1, 0}, {9, 1, 0}, {9, 9, 0}, {5, 9, 0}});
  // A line and an arc that meet at 90°: the centre is 4 from the arc's centre and 1 above the line.
  const Program p = read(std::string(kStart) + "G1 X0\nX10\nG3 Y10 J5\nG40");
  EXPECT_LT(glm::length(p.poses()[2].tip - Vec3(10, 1, 0)), 1e-9);
  const Program q = read(std::string(kStart) + "G1 X0\nX10\nG2 X20 I5\nG40");  // from below the arc: tool outside
  EXPECT_NEAR(glm::length(q.poses()[2].tip - Vec3(15, 0, 0)), 6, 1e-9);
  EXPECT_NEAR(q.poses()[2].tip.y, 1, 1e-9);
  EXPECT_LT(q.poses()[2].tip.x, 10);
  const Program arcs = read("G0 X-5 Y5 Z0\nG41 D1\nG1 X0 Y5\nG2 X10 I5\nX20 I5\nG40");
  const auto all = tips(arcs);
  EXPECT_TRUE(std::ranges::any_of(all, [](const Vec3& t) {
    return glm::length(t - Vec3(10, 5 + std::sqrt(11.0), 0)) < 1e-9;  // 6 from both centres
  }));
}

TEST(CutterCompensation, GoesRoundOutsideCornersAtTheHeightBeforeThem) {
  const Program p = read(std::string(kStart) + "G1 X0\nX10 Z-1\nY-10 Z-2\nG40");
  EXPECT_NEAR(nearest(p, {10, 0}), 1, 0.002);
  int round = 0;
  for (const Vec3& tip : tips(p))
    if (std::abs(glm::length(Vec2(tip.x - 10, tip.y)) - 1) < 1e-9 && tip.z == -1) ++round;
  EXPECT_GT(round, 4);
  EXPECT_EQ(p.poses().back().tip, Vec3(11, -10, -2));
  EXPECT_EQ(p.line().back(), 6);
}

TEST(CutterCompensation, KeepsLinesFeedsAndRapids) {
  const Program p = read("G0 X-5 Y0 Z0\nG41 D1\nG0 X0\nG1 X10 F200\nF300 Y-10\nG0 Z5\nG40\nX20");
  EXPECT_TRUE(p.rapid()[1]);
  EXPECT_EQ(p.feed()[2], 200);
  for (std::size_t k = 3; k < p.size(); ++k)
    if (!p.rapid()[k]) {
      EXPECT_EQ(p.feed()[k], 300);
      EXPECT_EQ(p.line()[k], 6);
    }
  EXPECT_TRUE(p.rapid().back());
  EXPECT_EQ(p.poses().back().tip, Vec3(20, -10, 5));
  // Under G93 a block takes the time of its programmed length.
  const Program inverse = read(std::string(kStart) + "G93 G1 X0 F1\nX10 F2\nG40");
  EXPECT_EQ(inverse.feed()[1], 5);
  EXPECT_EQ(inverse.feed()[2], 20);
}

TEST(CutterCompensation, BeginsWithAnArc) {
  // The arc about (0, 0) leads to (0, -5) along +x; the centre ends at (0, -4) and stays on one circle.
  const Program p = read("G0 X-5 Y0 Z0\nG41 D1\nG3 X0 Y-5 I5\nG1 X10\nG40");
  const auto all = tips(p);
  const auto end = std::ranges::find_if(all, [](const Vec3& t) { return glm::length(t - Vec3(0, -4, 0)) < 1e-9; });
  ASSERT_NE(end, all.end());
  const double radius = (25.0 + 16) / 8;  // of the circle through both that leaves along +x
  for (auto at = all.begin(); at != end; ++at) EXPECT_NEAR(glm::length(*at - Vec3(0, -4 + radius, 0)), radius, 1e-9);
}

TEST(CutterCompensation, WorksInThePlaneOfG18) {
  // Z is the first axis of the plane, X the second: left of +z is +x.
  expect_tips(read("G18\nG0 X0 Y0 Z-5\nG41 D1\nG1 Z0\nZ10\nG40"), {{0, 0, -5}, {1, 0, 0}, {1, 0, 10}});
}

// --- Diameters ---

TEST(CutterCompensation, TakesTheDiameterOfTheBlockTheOptionOrTheProgram) {
  const auto y = [](const std::string& code, Options options) {
    return read_nc_text("G21 T3 M6\nG10 L1 P7 R2.5\nG0 X-50 Y0 Z0\n" + code + "\nG1 X0 F100\nX10\nG40", "3-axis",
                        options)
        .poses()
        .back()
        .tip.y;
  };
  const Options each = with(kOffset, "tool_diameters", std::vector<double>{3, 6, 5, 10, 9, -4});
  EXPECT_EQ(y("G41.1 D4", kOffset), 2);
  EXPECT_NEAR(y("G20 G41.1 D.1", kOffset), 1.27, 1e-12);
  EXPECT_EQ(y("G41", each), 3);
  EXPECT_EQ(y("G41 D5", each), 5);
  EXPECT_EQ(y("D5\nG41", each), 5);
  EXPECT_EQ(y("G42 D5", each), -5);
  EXPECT_EQ(y("G41 D9", each), -2);
  EXPECT_EQ(y("G41 D7", each), 2.5);
  EXPECT_EQ(y("G41 D0", each), 0);
  EXPECT_EQ(y("G41 D8", with(kOffset, "tool_diameters", 1.0)), 0.5);
  EXPECT_EQ(nc_error("G41 D8\nG1 X1 Y1 Z1 F1", "3-axis", each),
            "line 2: cutter compensation (G41): the diameter of offset D8 is not known: give it in mm, as in options "
            "{'tool_diameters': {8: 6}} [G1 X1 Y1 Z1 F1]");
  EXPECT_EQ(nc_error("T4 M6\nG42\nG1 X1 Y1 Z1 F1", "3-axis", each),
            "line 3: cutter compensation (G42): the diameter of tool 4 is not known: give it in mm, as in options "
            "{'tool_diameters': {4: 6}} [G1 X1 Y1 Z1 F1]");
}

TEST(CutterCompensation, OfDiameterZeroIsTheProgrammedPath) {
  const std::string text = "G0 X0 Y0 Z0\nG41 D1\nG1 X1\nX.5\nG3 X1.5 I.5\nG54\nG28 Z0\nG1 Z0\nG40\nG2 X0 I-.75";
  const Program p = read(text, 0);
  std::string plain = text;
  plain.erase(plain.find("G41 D1"), 6);
  EXPECT_EQ(tips(p), tips(read(plain)));
}

TEST(CutterCompensation, InvalidOptionsAreRefused) {
  const auto said = [](OptionValue value) {
    try {
      read_nc_text("G0 X0", "3-axis", with(kOffset, "tool_diameters", std::move(value)));
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(said(std::vector<double>{1, 2, 3}).find("in pairs"), std::string::npos);
  EXPECT_NE(said(std::vector<double>{1.5, 2}).find("whole"), std::string::npos);
  EXPECT_NE(said(std::vector<double>{1, 2, 1, 3}).find("tool 1 twice"), std::string::npos);
  EXPECT_NE(said(1e9).find("out of range"), std::string::npos);
  EXPECT_NE(said(std::string("six")).find("finite numbers"), std::string::npos);
}

// --- What is refused ---

TEST(CutterCompensation, RefusesContoursThatTheToolDoesNotFitInto) {
  const std::string start(kStart),
      fits =
          ": give a smaller diameter, or, where the points are those of the tool's centre, "
          "read the program with options {'cutter_compensation': 'ignore'} [";
  EXPECT_EQ(
      error("G0 X-1 Y0 Z0\nG41 D1\nG1 X0"),
      "line 4: cutter compensation by 1 mm: the first move is not longer than the tool's radius" + fits + "G1 X0]");
  EXPECT_EQ(error(start + "G1 X0\nX10\nG3 X8 I-1"),
            "line 6: cutter compensation by 1 mm: the inside arc of radius 1 mm is not larger than the tool" + fits +
                "G3 X8 I-1]");
  EXPECT_EQ(error(start + "G1 X0\nX10\nY1.5\nX0"),
            "line 7: cutter compensation by 1 mm: line 6: the line is too short "
            "for the tool between its neighbours" +
                fits + "X0]");
  // Each of them is read with a smaller diameter, and as the path of the centre.
  EXPECT_EQ(error("G0 X-1 Y0 Z0\nG41 D1\nG1 X0", 1), "no error");
  EXPECT_EQ(error(start + "G1 X0\nX10\nG3 X8 I-1", 1), "no error");
  EXPECT_EQ(error(start + "G1 X0\nX10\nY1.5\nX0", 1), "no error");
  EXPECT_EQ(nc_error(start + "F1\nG1 X0\nX10\nY1.5\nX0", "3-axis", {{"cutter_compensation", std::string("ignore")}}),
            "no error");
}

TEST(CutterCompensation, RefusesWhatLinuxCncRefusesAndNamesTheRemedy) {
  const std::string start = std::string(kStart) + "G1 X0\n";
  const std::pair<const char*, const char*> cases[] = {
      {"G18", "another plane"},
      {"G28", "G28"},
      {"G30 Z0", "G30"},
      {"G53 G0 Z0", "G53"},
      {"G81 X1 Z-1 R1", "a canned cycle"},
      {"G5 X1 Y1 I1 J1 P1 Q1", "a spline (G5, G5.1)"},
      {"G55", "no error"},  // where it was, as far as the program says
      {"G92 X5", "another place of the coordinates (work offset, G92, tool offset)"},
      {"G10 L2 P1 X5", "another place of the coordinates (work offset, G92, tool offset)"},
      {"M6 T2", "a change of the tool"},
      {"G0 X#5420", "a position is read"},
      {"G28.1", "G28.1 and G30.1"},
  };
  for (const auto& [text, what] : cases) {
    const std::string is = error(start + text + "\nX20");
    const std::string wanted = std::string(what) == "no error"
                                   ? what
                                   : "line 5: " + std::string(what) +
                                         " in cutter compensation: G40 and a straight move before it [" + text + "]";
    EXPECT_EQ(is, wanted) << text;
    EXPECT_EQ(error(start + "G40\nG1 X25\n" + text + "\nG17 G0 X20"), "no error") << text;
  }
  for (const char* change : {"G42 D1", "G41.1 D3"})
    EXPECT_EQ(error(start + change),
              std::string("line 5: ") + std::string(change).substr(0, std::string(change).find(' ')) +
                  " changes the compensation that holds: G40 and a straight move before it [" + change + "]");
  EXPECT_EQ(error(start + "G41 D1\nX10"), "no error");
  EXPECT_EQ(error(start + "X10\nG40\nG2 X20 I5"),
            "line 7: the move after G40 is not straight: write G0 or G1 before it [G2 X20 I5]");
  EXPECT_EQ(error(start + "X10\nG40\nG1 X11\nG2 X20 I5 J0"),
            "line 8: the arc's end misses its circle by 1.0000 mm: option arc_tolerance allows more [G2 X20 I5 J0]");
  EXPECT_EQ(error("G19\nG41 D1"),
            "line 3: cutter compensation (G41) in the plane of G19: G17 and G18 are read [G41 D1]");
  EXPECT_EQ(nc_error("G21 G0 X0 Y0 Z0\nG41.1 D1\nG1 A5 X5 F1", "tcp", kOffset).substr(0, 60),
            std::string("line 3: rotary axes turn in cutter compensation (A): G40 and a straight").substr(0, 60));
}

TEST(CutterCompensation, ReturnsToTheProgrammedPathAfterG40) {
  expect_tips(read(std::string(kStart) + "G1 X0\nX10\nG40 X15 Y5\nG1 X20"),
              {{-5, 0, 0}, {0, 1, 0}, {10, 1, 0}, {15, 5, 0}, {20, 5, 0}});
  const Program up = read(std::string(kStart) + "G1 X0\nX10\nG40\nG0 Z5");
  EXPECT_EQ(up.poses().back().tip, Vec3(10, 0, 5));
  EXPECT_EQ(up.notes.back().kind, "cutter compensation");
  EXPECT_EQ(up.notes.back().line, 7);
  // The end of the program ends it, too.
  for (const char* end : {"", "M2", "%"})
    EXPECT_EQ(read(std::string(kStart) + "G1 X0\nX10\n" + end).poses().back().tip, Vec3(10, 1, 0)) << end;
}

TEST(CutterCompensation, OfDamagedProgramsGivesRowsOrAFormatError) {
  const std::string seeds[] = {
      "G21 G90 F100 T1 M6\nG0 X-5 Y0 Z0\nG41 D1\nG1 X0\nG3 X8 Y8 J8\nZ-1\nG2 X12 Y12 I4\nG1 X20 Y12\nX30 Z-2\nY0\nG0 "
      "X5\n"
      "G40\nG0 Z5\nG18\nG42.1 D.8\nG2 X0 Z12 I-5\nG93 G1 X-9 F2\nX-10 F1\nM2\n",
      "BEGIN PGM A MM\nTOOL CALL 1 Z S100 F100 DR+0.1\nL X-5 Y-5 Z0 R0 FMAX\nL X0 Y0 RL\nL X10\nRND R3\nL Y20\nCT X0 "
      "Y20\n"
      "L IZ-1\nL Y5\nCR X-6 Y0 R9 DR-\nCC X-6 Y-9\nCP IPA-90 DR-\nL X-30 R0\nL Z+50 FMAX\nEND PGM A MM\n"};
  std::mt19937 random(7);
  int read = 0;
  for (int round = 0; round < 6'000; ++round) {
    std::string text = seeds[round % 2];
    for (std::size_t k = 0, count = random() % 4; k < count; ++k) {
      const std::size_t at = random() % text.size();
      if (text[at] >= '0' && text[at] <= '9') text[at] = static_cast<char>('0' + random() % 10);
      if (random() % 5 == 0) text.erase(text.begin() + static_cast<std::ptrdiff_t>(at));
    }
    Options options = with(kOffset, "tool_diameters", static_cast<double>(random() % 100) / 20 - 1);
    options["chord_tolerance"] = 0.1;
    try {
      const Program p = read_nc_text(text, round % 2 ? "heidenhain" : "tcp", options);
      ++read;
      for (const Vec3& tip : tips(p)) ASSERT_TRUE(std::isfinite(tip.x) && std::isfinite(tip.y)) << text;
    } catch (const FormatError&) {
      continue;
    }
  }
  EXPECT_GT(read, 1000);
}

}  // namespace
}  // namespace riffler::nc::cutter_compensation_test
