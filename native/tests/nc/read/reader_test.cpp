#include "riffler/nc/read/reader.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>

#include "riffler/base/error.hpp"
#include "riffler/nc/cutter_path.hpp"
#include "riffler/nc/write/writer.hpp"
#include "support/nc_blocks.hpp"

namespace riffler::nc::reader_test {
namespace {

Program read(const std::string& text, const std::string& machine = "tcp", Options options = {}) {
  return parse_nc(text, "p.ngc", {machine, std::move(options)});
}

std::string error_of(const std::string& text, const std::string& machine = "tcp") {
  try {
    read(text, machine);
  } catch (const FormatError& e) {
    return e.what();
  }
  return "no error";
}

constexpr const char* kAdvice = ": correct it, or read with options {'unknown': 'skip'}";

/// The text of line `number` as messages show it.
std::string shown(const std::string& text, std::size_t number) {
  std::size_t begin = 0;
  while (--number > 0) begin = text.find('\n', begin) + 1;
  std::string line = text.substr(begin, text.find('\n', begin) - begin);
  for (char& c : line)
    if (c < ' ' || c > '~') c = '?';
  return line;
}

TEST(Reader, RefusesUnknownBlocksAndNamesFileAndLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"G1 X NaN F1", "expected a number after X"},
      {"G1 X1 FNAN", "expected a number after F"},
      {"G1 Xinf F1", "expected a number after X"},
      {"G1 X F1", "expected a number after X"},
      {"G1 X- F1", "expected a number after X"},
      {"G1 X. F1", "expected a number after X"},
      {"G1 X1e3 F1", "E has no meaning in this block"},
      {"G1 X1 E3 F1", "E has no meaning in this block"},
      {"G1 X2000000 F1", "X is out of range"},
      {"G1 X1 F1000000000000", "F is out of range"},
      {"T1.5 M6", "T must be a whole number"},
      {"T-1 M6", "T must be a whole number"},
      {"T999999999999 M6", "T is out of range"},
      {"G1 U1 F1", "unknown letter U: second linear axes are not read; have the CAM system write X, Y and Z alone"},
      {"G1 B1 F1",
       "unknown letter B: the machine has no such axis; these have: tcp-bc, linuxcnc-xyzbc, head-head, "
       "head-table"},
      {"G5.5 X1", "unknown code G5.5"},
      {"G43.5 H1", "unknown code G43.5"},
      {"G1.05 X1 F1", "unknown code G1.05"},
      {"G-1", "unknown code G-1"},
      {"G29", "unknown code G29"},
      {"G60", "unknown code G60"},
      {"M97 P1000", "unknown code M97"},
      {"M-3", "unknown code M-3"},
      {"G1 X1 X2 F1", "X twice in one block"},
      {"G1 X1 F1 F1", "F twice in one block"},
      {"G1 G1 X1 F1", "G1 twice in one block"},
      {"G0 G1 X1 F1", "two motions in one block: G0 and G1"},
      {"G20 G21", "codes that contradict each other: G20 and G21"},
      {"M3 M5", "codes that contradict each other: M3 and M5"},
      {"G0 X1 (never closed", "unclosed comment"},
      {"(a (b) X1", "unclosed comment"},
      {"G0 X1 )", "unexpected ')'"},
      {"G1 X1", "a feed move without F: option first_feed, mm/min, holds until the first F"},
      {"F100\nG93 G1 X1", "a feed move without F: under G93 every block needs its own"},
      {"G93 G1 X1 F2\nX2", "a feed move without F: under G93 every block needs its own"},
      {"G93 G1 X1 F2\nG94 X2", "a feed move without F"},
      {"G1 X1 F0", "a feed move without F: option first_feed, mm/min, holds until the first F"},
      {"G1 X1 F-5", "F is negative"},
      {"S-1 M3", "S is negative"},
      {"X1 F1",
       "axis words without a motion (G0, G1, G2, G3): option first_motion names the one at the control's start"},
      {"G80\nX2",
       "axis words without a motion (G0, G1, G2, G3): option first_motion names the one at the control's start"},
      {"G4", "G4 needs P"},
      {"G4 P1 X1", "axis words together with G4"},
      {"G0 X1 R1", "R has no meaning in this block"},
      {"G0 X1 I1", "I has no meaning in this block"},
      {"X1 N5", "N must be first in its block"},
      {"G0 X1\nO5",
       "O with only a number is the program number, before everything else, or a subprogram for M98, after the "
       "program's end"},
      {"G0 X\xC3\xA9", "expected a number after X"},
      {"G0 X1 \xC3\xA9", "a character outside ASCII (byte 0xC3)"},
      {"G0 X1 #5", "expected = after a parameter"},
      {"G0 X1 /G0", "unexpected '/'"},
      {"G0 X1 2", "unexpected '2'"},
      {"G0 X1.2.3", "unexpected '.'"},
      {"G2 X1 F1", "an arc without a centre (I, J, K) or R"},
      {"G2 F1", "an arc without an end or a centre"},
      {"G2 X1 I1 R1 F1", "an arc with both R and a centre"},
      {"G2 X1 K1 I1 F1", "K does not lie in the arc's plane"},
      {"G2 X2 I1.01 F1", "the arc's end misses its circle by 0.0200 mm: option arc_tolerance allows more"},
      {"G2 X5 I1 F1", "the arc's end misses its circle by 3.0000 mm"},
      {"G0 X10\nG3 X0 Y10 I0 J0 F1",
       "the arc's end misses its circle by 14.1421 mm, and fits it with an absolute centre (G90.1): option "
       "arc_centres"},
      {"G0 X10\nG90.1 G3 X0 Y10 I-10 J0 F1",
       "the arc's end misses its circle by 5.8579 mm, and fits it with a centre relative to its start (G91.1): option "
       "arc_centres"},
      {"G2 X2 R0.99 F1", "the arc's end misses its circle by 0.0200 mm: option arc_tolerance allows more"},
      {"G2 X0 Y0 R5 F1", "a full circle by R has no centre"},
      {"G90.1 G2 X2 I1 F1", "with absolute centres (G90.1) an arc needs both I and J"},
      {"G91 G1 X999999 F1\nX999999", "X is out of range"},
  };
  for (const auto& [text, what] : cases) {
    const std::string lines = std::string("(first)\n\n") + text + "\n";
    std::size_t line = 2;
    for (const char* c = text; *c; ++c) line += *c == '\n';
    // The third of three lines is wrong except where the end comes first.
    const std::string advice = std::string_view(what).starts_with("unknown code ") ? kAdvice : "";
    EXPECT_EQ(error_of(lines),
              "p.ngc, line " + std::to_string(line + 1) + ": " + what + advice + " [" + shown(lines, line + 1) + "]")
        << text;
  }
  EXPECT_EQ(
      error_of("G0 X1 A1", "3-axis"),
      "p.ngc, line 1: unknown letter A: the machine has no such axis; these have: tcp, linuxcnc-xyzac [G0 X1 A1]");
  EXPECT_EQ(error_of("G0 X" + std::string(400, '9')),
            "p.ngc, line 1: the number after X is out of range [G0 X" + std::string(76, '9') + " ...]");
  EXPECT_THROW(read_nc("/nowhere/at/all.ngc"), FormatError);
}

TEST(Reader, RefusesUnknownMachinesAndOptions) {
  const auto error = [](const std::string& machine, const Options& options) -> std::string {
    try {
      read("", machine, options);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error("lathe", {}),
            "unknown machine lathe; known: tcp, tcp-bc, linuxcnc-xyzac, linuxcnc-xyzbc, head-head, head-table, 3-axis, "
            "heidenhain, heidenhain-bc, sinumerik, sinumerik-bc, apt, or the path of a .toml file that describes your "
            "machine");
  const std::string unknown = error("tcp", {{"chord", 1.0}});
  EXPECT_TRUE(unknown.starts_with("machine tcp: unknown option 'chord'; known: tcp, max_rotary")) << unknown;
  EXPECT_TRUE(unknown.ends_with(
      "cutter_compensation, tool_diameters, subroutines, parameters, units, arc_tolerance, arc_centres, first_feed, "
      "first_motion, g54, g55, "
      "g56, g57, g58, g59, g59_1, g59_2, g59_3, g28, g30"))
      << unknown;
  EXPECT_NE(error("tcp", {{"chord_tolerance", -1.0}}), "");
  EXPECT_NE(error("tcp", {{"chord_tolerance", std::string("small")}}), "");
}

TEST(Reader, ReadsCodeOfOtherPrograms) {
  const Program p = read(
      "%\r\no1234 (NAME \xC3\xA9)\r\nn10 g90g21g17g40g49g80g54 g94\r\n\r\nN20 T3 M6 ; tool\r\n"
      "s 1000 m3 m8\r\ng0x1.y+.5z-2\r\n  G01 X 10 (mid) Y 20 F 300.5\r\nY21\r\nG91 X1\r\nG90 G00 Z5.0\r\nM5 M9\r\n"
      "G4 P0.5\r\nG64 P0.01\r\nG61\r\nG20 G1 X1 F2\r\nM01\r\nM30\r\n%\r\n");
  ASSERT_EQ(p.size(), 6U);
  EXPECT_EQ(p.poses()[0].tip, Vec3(1, 0.5, -2));
  EXPECT_EQ(p.poses()[1].tip, Vec3(10, 20, -2));
  EXPECT_EQ(p.poses()[2].tip, Vec3(10, 21, -2));
  EXPECT_EQ(p.poses()[3].tip, Vec3(11, 21, -2));
  EXPECT_EQ(p.poses()[4].tip, Vec3(11, 21, 5));
  EXPECT_EQ(p.poses()[5].tip, Vec3(25.4, 21, 5));
  EXPECT_EQ(p.rapid(), (std::vector<std::uint8_t>{1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(p.line(), (std::vector<std::int32_t>{7, 8, 9, 10, 11, 16}));
  EXPECT_EQ(p.feed(), (std::vector<double>{0, 300.5, 300.5, 300.5, 0, 50.8}));
  EXPECT_EQ(p.spindle(), (std::vector<double>{1000, 1000, 1000, 1000, 1000, 0}));
  for (const int tool : p.tool()) EXPECT_EQ(tool, 3);
  for (const Pose& pose : p.poses()) EXPECT_EQ(pose.axis, Vec3(0, 0, 1));
}

TEST(Reader, ReadsTheFilesOfOtherSystems) {
  const Program p = read(
      "%\nO1234\n(T1 D=6. CR=3. - BALL)\nN10G90G94G17G49G40G80\nN15G21\nN20G28G91Z0.\nN25G90\nN30T1M6\nN35S5000M3\n"
      "N40G54\nN45M8\nN50G0X1.Y2.\nN55G43Z15.H1\nN60G1Z-1.F333.\nF500.\nX5.\nG2X6.Y3.I0.J1.\nN99G0Z15.\nM9M5\n"
      "G28G91Z0.\nG28X0.Y0.\nM30\n%\n");
  EXPECT_EQ(p.tool().back(), 1);
  EXPECT_EQ(p.poses()[0].tip, Vec3(1, 2, 15));
  EXPECT_EQ(p.feed()[1], 333);
  EXPECT_EQ(p.feed()[2], 500);
  EXPECT_TRUE(p.at_machine().back());
}

TEST(Reader, SkipsDeletedBlocksUnlessAnOptionReadsThem) {
  EXPECT_EQ(read("G0 X1\n/X2\n /N5 X3 nonsense").size(), 1U);
  EXPECT_EQ(read("G0 X1\n/X2\n/N5 X3", "tcp", {{"block_delete", false}}).size(), 3U);
}

TEST(Reader, SkipsAndListsUnknownWordsOnRequest) {
  const Program p = read("G0 X1 U7\nG1 X2 F10\nG187 P1 E0.1\nG60 X9\nG60 G1 X3\nM97 P5\nX4", "tcp",
                         {{"unknown", std::string("skip")}});
  ASSERT_EQ(p.size(), 4U);
  EXPECT_EQ(p.poses()[2].tip.x, 3) << "G60 takes its block's words with it in a block without a motion";
  EXPECT_EQ(p.provenance[1].first, "skipped");
  EXPECT_EQ(
      p.provenance[1].second,
      "line 1: U was skipped, an axis of the program; line 3: G187; line 4: G60 was skipped, with its axis words; "
      "line 5: G60; line 6: M97");
  std::string many = "G0\n";
  for (int k = 0; k < 1000; ++k) many += "X1 U1\n";
  const std::string listed = read(many, "tcp", {{"unknown", std::string("skip")}}).provenance[1].second;
  EXPECT_TRUE(listed.ends_with("line 21: U was skipped, an axis of the program; and 980 more")) << listed;
}

TEST(Reader, FollowsSwitchesOfTheKinematics) {
  const Options table{{"rot_point", std::vector<double>{1, 2, 3}}, {"offset", std::vector<double>{0, 4, 5}}};
  const std::string machine = "linuxcnc-xyzac";
  Options joints = table, tips = table;
  joints["tcp"] = false, tips["tcp"] = true;
  const std::string path = "G0 X10 Y20 Z30\nG1 X11 A20 C30 F100\n";
  EXPECT_EQ(read("M428\n" + path, machine, table).poses().back().tip, read(path, machine, tips).poses().back().tip);
  EXPECT_EQ(read("M429\n" + path, machine, table).poses().back().tip, read(path, machine, table).poses().back().tip);
  // The machine stands still while its kinematics are switched.
  for (const std::string order : {"M428", "M429"}) {
    const std::string other = order == "M428" ? "M429" : "M428";
    const Program p = read(order + "\n" + path + other + "\nG91 G1 X0\n" + order + "\nX0", machine, table);
    const Pose here = p.poses()[p.size() - 3];
    for (std::size_t row = p.size() - 2; row < p.size(); ++row) {
      EXPECT_LT(glm::length(p.poses()[row].tip - here.tip), 1e-12);
      EXPECT_LT(glm::length(p.poses()[row].axis - here.axis), 1e-15);
    }
  }
  EXPECT_NO_THROW(read("G0 X1\nM428", machine, table));
  const auto fails = [&](const std::string& text, const std::string& name, const Options& options) -> std::string {
    try {
      read(text, name, options);
    } catch (const FormatError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(fails("\nM428", machine, joints),
            "p.ngc, line 2: M428 makes X Y Z the tip, but option tcp says otherwise: leave the option out, and what "
            "the program says is followed [M428]");
  EXPECT_EQ(fails("\nM429", machine, tips),
            "p.ngc, line 2: M429 makes X Y Z the axis positions, but option tcp says otherwise: leave the option out, "
            "and what the program says is followed [M429]");
  EXPECT_NE(fails("M430", "3-axis", {}), "");
  EXPECT_EQ(fails("M428\nM429", "3-axis", {}), "");
}

TEST(Reader, SplinesFollowTheirPolynomials) {
  const Program p = read("F100\nG0 X1\nG5 X5 Y5 I1 J2 P-1 Q-2\nX9 Y5 P-1 Q-2\nG5.1 X12 Y3 I1 J1");
  const auto cubic = [](Vec2 a, Vec2 b, Vec2 c, Vec2 d, double t) {
    const auto mix = [t](Vec2 u, Vec2 v) { return (1 - t) * u + t * v; };  // de Casteljau's
    return mix(mix(mix(a, b), mix(b, c)), mix(mix(b, c), mix(c, d)));
  };
  const auto check = [&](int line, Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    double worst = 0;
    std::size_t ends = 0;
    for (std::size_t row = 1; row < p.size(); ++row) {
      if (p.line()[row] != line) continue;
      ++ends;
      // Every point of the curve is near a chord, densely.
    }
    for (int i = 0; i <= 2000; ++i) {
      const Vec2 q = cubic(a, b, c, d, i / 2000.0);
      double near = 1e9;
      for (std::size_t row = 1; row < p.size(); ++row) {
        if (p.line()[row] != line) continue;
        const Vec2 from(p.poses()[row - 1].tip), to(p.poses()[row].tip);
        const double t = std::clamp(glm::dot(q - from, to - from) / glm::dot(to - from, to - from), 0.0, 1.0);
        near = std::min(near, glm::length(q - from - t * (to - from)));
      }
      worst = std::max(worst, near);
    }
    EXPECT_LE(worst, 0.002) << line;
    EXPECT_GT(ends, 10U);
    EXPECT_LT(ends, 200U);
  };
  check(3, {1, 0}, {2, 2}, {4, 3}, {5, 5});
  check(4, {5, 5}, {6, 7}, {8, 3}, {9, 5});
  const Vec2 control(10, 6);
  check(5, {9, 5}, (Vec2(9, 5) + 2.0 * control) / 3.0, (Vec2(12, 3) + 2.0 * control) / 3.0, {12, 3});
}

TEST(Reader, ArcsMayTurnSeveralTimes) {
  const Program p = read("G0 X10\nG3 X-10 I-10 Z4 P3 F100");
  double way = 0;
  for (std::size_t k = 1; k < p.size(); ++k) way += glm::length(p.poses()[k].tip - p.poses()[k - 1].tip);
  EXPECT_NEAR(way, std::hypot(50 * kPi, 4), 0.03);
  EXPECT_EQ(read("G2 I5 P2 F1").poses().back().tip, Vec3(0, 0, 0));
}

TEST(Reader, TakesFeedPerTurnFromTheSpindle) {
  EXPECT_EQ(read("G95 F0.1 S2000 M3 G1 X1").feed()[0], 200);
  EXPECT_EQ(error_of("G95 F0.1 G1 X1"),
            "p.ngc, line 1: a feed per revolution (G95) without a spindle speed S [G95 F0.1 G1 X1]");
}

TEST(Reader, ReadsAnEmptyFileAsAnEmptyProgram) {
  for (const char* text : {"", "\n\n", "%\n%\n", "(only a comment)", "; \xFF\n", "M30"})
    EXPECT_TRUE(read(text).empty());
}

TEST(Reader, TurnsRotaryWordsIntoTheAxis) {
  const Program p = read("G43.4 H1\nG1 X1 A30 C40 F100\nA-50\nG91 C-100\nG20 C1");
  const std::pair<double, double> ac[] = {{30, 40}, {-50, 40}, {-50, -60}, {-50, -59}};
  ASSERT_EQ(p.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT(glm::length(p.poses()[k].axis - test::axis_of(ac[k].first, ac[k].second)), 1e-15);
}

TEST(Reader, TakesFeedUnderInverseTimeFromTheTipsPath) {
  const Program p = read("G93 G1 X3 Y4 F2\nX13 F0.5\nA10 F3\nG0 X0\nG2 X10 I5 Z4 F10\nG94 G1 X0 F77");
  EXPECT_DOUBLE_EQ(p.feed()[0], 10);
  EXPECT_DOUBLE_EQ(p.feed()[1], 5);
  EXPECT_EQ(p.feed()[2], 0) << "the tip stands still";
  EXPECT_DOUBLE_EQ(p.feed()[4], 10 * std::hypot(5 * kPi, 4));
  EXPECT_EQ(p.feed().back(), 77);
  EXPECT_DOUBLE_EQ(read("G20 G93 G1 X1 F2").feed()[0], 50.8) << "1/min knows no inch";
}

/// Largest distance of the rows' chords from the circle about `centre` in the plane of the world axes u, v.
double off_circle(const Program& p, int u, int v, const Vec2& centre, double r, const Vec3& from) {
  double worst = 0;
  Vec3 before = from;
  for (const Pose& pose : p.poses()) {
    for (int i = 0; i <= 10; ++i) {
      const Vec3 q = before + i / 10.0 * (pose.tip - before);
      worst = std::max(worst, std::abs(glm::length(Vec2(q[u], q[v]) - centre) - r));
    }
    before = pose.tip;
  }
  return worst;
}

TEST(Reader, ArcsFollowTheirCircleInEveryPlane) {
  struct Case {
    const char* text;
    int u, v;
    Vec2 centre;
    double quarter_u, quarter_v;  // a point a quarter of the arc on
  };
  // Half circles of radius 5 from the origin, in the two axes of the plane: G2 is clockwise seen from the plane's
  // normal.
  const Case cases[] = {
      {"G17 G2 X10 I5 F1", 0, 1, {5, 0}, 1, 1},
      {"G17 G3 X10 I5 F1", 0, 1, {5, 0}, 1, -1},
      {"G18 G2 Z10 K5 F1", 2, 0, {5, 0}, 1, 1},
      {"G18 G3 Z10 K5 F1", 2, 0, {5, 0}, 1, -1},
      {"G19 G2 Y10 J5 F1", 1, 2, {5, 0}, 1, 1},
      {"G19 G3 Y10 J5 F1", 1, 2, {5, 0}, 1, -1},
      {"G17 G2 Y10 J5 F1", 0, 1, {0, 5}, -1, 1},
      {"G18 G2 X10 I5 F1", 2, 0, {0, 5}, -1, 1},
      {"G17 G2 X10 R5 F1", 0, 1, {5, 0}, 1, 1},
      {"G90.1 G3 X10 I5 J0 F1", 0, 1, {5, 0}, 1, -1},
      {"G20 G91.1 G2 X0.39370078740157 I0.196850393700787 F1", 0, 1, {5, 0}, 1, 1},
  };
  for (const Case& c : cases) {
    const Program p = read(c.text);
    EXPECT_LE(off_circle(p, c.u, c.v, c.centre, 5, {0, 0, 0}), 0.002 + 1e-9) << c.text;
    const Vec3 middle = p.poses()[p.size() / 2].tip;
    EXPECT_GT(glm::dot(Vec2(middle[c.u], middle[c.v]), Vec2(c.quarter_u, c.quarter_v)), 5) << c.text;
    Vec3 end(0);
    end[c.u] = 2 * c.centre.x, end[c.v] = 2 * c.centre.y;
    EXPECT_LT(glm::length(p.poses().back().tip - end), 1e-9) << c.text;
  }
}

TEST(Reader, HelicesAndFullCirclesAreRead) {
  const Program full = read("G0 X10\nG3 I-10 F100");
  EXPECT_EQ(full.line().back(), 2);
  double area = 0;
  for (std::size_t k = 1; k < full.size(); ++k) {
    const Vec3 &a = full.poses()[k - 1].tip, &b = full.poses()[k].tip;
    area += (a.x * b.y - a.y * b.x) / 2;
  }
  EXPECT_NEAR(area, 100 * kPi, 2 * kPi * 10 * 0.002);
  const Program helix = read("G0 X10\nG2 X10 Y0 Z-7 I-10 A20 F100");
  double way = 0;
  for (std::size_t k = 1; k < helix.size(); ++k) {
    const Vec3 &a = helix.poses()[k - 1].tip, &b = helix.poses()[k].tip;
    way += glm::length(b - a);
    EXPECT_NEAR(b.z / -7, (std::atan2(-b.y, b.x) + (b.y > 1e-9 || k + 1 == helix.size() ? 2 * kPi : 0)) / (2 * kPi),
                1e-6);
    EXPECT_LT(test::angle(helix.poses()[k].axis, test::axis_of(20 * b.z / -7, 0)), 1e-7);
  }
  EXPECT_NEAR(way, std::hypot(20 * kPi, 7), 0.02);
  EXPECT_GT(read("G2 I5 F1", "tcp", {{"chord_tolerance", 1e-5}}).size(), 10 * read("G2 I5 F1").size());
  EXPECT_LT(read("G2 I5 F1", "tcp", {{"chord_tolerance", 1.0}}).size(), 10U);
}

TEST(Reader, MakesOneRowPerBlockUnlessItFollowsTheAxis) {
  const std::string text = "G1 A30 F10\nX100 C360 F100\nG0 C0";
  EXPECT_EQ(read(text).size(), 3U);
  const Program p = read(text, "tcp", {{"axis_tolerance", 0.001}});
  ASSERT_GT(p.size(), 20U);
  EXPECT_EQ(p.rapid().back(), 1);
  EXPECT_EQ(p.line()[p.size() - 2], 3) << "rapids, too";
  for (std::size_t k = 1; k + 2 < p.size(); ++k) {
    if (p.line()[k] != 2 || p.line()[k + 1] != 2) continue;
    const Motion motion(p.poses()[k], p.poses()[k + 1]);
    for (int i = 0; i <= 10; ++i)
      EXPECT_LT(test::angle(motion.axis(i / 10.0), test::axis_of(30, 3.6 * motion.tip(i / 10.0).x)), 0.0011);
  }
}

TEST(Reader, ReadsHundredThousandBlocksInLessThanASecond) {
  CutterPath path{{}, {500}, 0, 1};
  for (int i = 0; i < 100'000; ++i) {
    const double t = 1e-3 * i;
    path.poses.push_back({{t, 20 * std::sin(t), std::cos(3 * t)}, glm::normalize(Vec3(std::sin(t), std::cos(t), 2))});
  }
  WriteOptions how;
  how.options["safe_start"] = false;
  const std::string text = to_nc(program_from_paths(std::vector{path}, {}), how);
  const std::clock_t begin = std::clock();
  const Program p = read(text);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 1.0);
  EXPECT_EQ(p.size(), 100'002U);
}

}  // namespace
}  // namespace riffler::nc::reader_test
