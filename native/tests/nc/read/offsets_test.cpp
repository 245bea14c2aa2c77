// Work offsets, shifts, homes, dynamic tool lengths: where program coordinates are. Random programs of them are judged
// by LinuxCNC's interpreter in tests/python.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "geom/math.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::offsets_test {
namespace {

using test::nc_error;
using test::read_nc_text;

/// The tips of all rows.
std::vector<Vec3> tips(const std::string& text, Options options = {}) {
  const Program program = read_nc_text(text, "tcp", std::move(options));
  std::vector<Vec3> out;
  for (const Pose& pose : program.poses()) out.push_back(pose.tip);
  return out;
}
using Tips = std::vector<Vec3>;

TEST(NcOffsets, ThatHoldFromTheFirstMoveAreNotNoted) {
  for (const char* before : {"G55", "G10 L2 P1 X100 Y20 R30", "G92 X7 Z3", "G52 Y5", "G43.1 Z120", "G59.3"})
    EXPECT_EQ(tips(std::string(before) + "\nG0 X1 Y2 Z3\nX4"), (Tips{{1, 2, 3}, {4, 2, 3}})) << before;
}

TEST(NcOffsets, ThatChangeLaterMoveTheFollowingBlocks) {
  EXPECT_EQ(tips("G10 L2 P2 X100\nG0 X1\nG55 X1\nG54 X1"), (Tips{{1, 0, 0}, {101, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(tips("G0 X1\nG92 X0\nX2\nG92.2\nX2\nG92.3\nX2\nG92.1\nG92.3\nX2"),
            (Tips{{1, 0, 0}, {3, 0, 0}, {2, 0, 0}, {3, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(tips("G0 X1\nG52 X10\nX1\nG52 X0\nX1"), (Tips{{1, 0, 0}, {11, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(tips("G0 X5\nG10 L20 P1 X0\nX1\nG20 G10 L2 P0 X1\nG21 X0"), (Tips{{5, 0, 0}, {6, 0, 0}, {25.4, 0, 0}}));
  const Tips turned = tips("G0 X1\nG10 L2 P1 R90\nX2 Y0\nG91 X1\nG90 G2 X4 I0.5 J0 F1");
  EXPECT_LT(glm::length(turned[1] - Vec3(0, 2, 0)), 1e-15);
  EXPECT_LT(glm::length(turned[2] - Vec3(0, 3, 0)), 1e-15);
  for (std::size_t k = 3; k < turned.size(); ++k) {
    EXPECT_NEAR(glm::length(turned[k] - Vec3(0, 3.5, 0)), 0.5, 1e-12);
    EXPECT_GT(turned[k].x, -1e-12 - 0.5);
  }
  EXPECT_NEAR(turned.back().y, 4, 1e-12);
}

TEST(NcOffsets, TurnRotaryAxesToo) {
  const Program p = read_nc_text("G0 A10\nG92 A0\nA5\nG10 L2 P1 A1\nA5");
  EXPECT_NEAR(p.poses()[1].axis.y, -std::sin(15 * kPi / 180), 1e-15);
  EXPECT_NEAR(p.poses()[2].axis.y, -std::sin(16 * kPi / 180), 1e-15);
}

TEST(NcOffsets, HomesAreMachinePositions) {
  EXPECT_EQ(tips("G0 X1 Y1 Z1\nG28.1\nX5 Y6\nG28 Y7\nG91 G28 X0"),
            (Tips{{1, 1, 1}, {5, 6, 1}, {5, 7, 1}, {5, 1, 1}, {5, 1, 1}, {1, 1, 1}}));
  const std::string var = "5161 10\n5163\t-20.5\n5221 1\n5222 2\n5223 3\n5230 0\n\n5220 1.000\n";
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("riffler_var_" + std::to_string(getpid()));
  std::ofstream(file) << var;
  EXPECT_EQ(tips("G0 X0 Y0 Z0\nG28\nG53 G0 X1 Y2 Z3", {{"parameters", file.string()}}),
            (Tips{{0, 0, 0}, {9, -2, -23.5}, {0, 0, 0}}));
  std::ofstream(file) << "5221 one\n";
  EXPECT_THROW(tips("", {{"parameters", file.string()}}), FormatError);
  std::filesystem::remove(file);
}

TEST(NcOffsets, OfTheToolLengthMoveTheTipByTheirDifference) {
  EXPECT_EQ(tips("T1 M6 G43.1 Z120\nG0 Z0\nG43.1 Z120.5\nZ0\nG43 H1\nZ0"), (Tips{{0, 0, 0}, {0, 0, 0.5}, {0, 0, 0}}));
  EXPECT_EQ(tips("T1 M6 G43.1 Z120\nG0 Z0\nT2 M6 G43.1 Z90\nZ0"), (Tips{{0, 0, 0}, {0, 0, 0}}));
  const Program p = read_nc_text("G21 G43 H1\nG0 Z1\nG49\nZ50");
  EXPECT_EQ(p.provenance[1].second, "line 4: a move after G49: its points are taken as those of the tip");
  EXPECT_EQ(read_nc_text("G21 G43 H1\nG0 Z1\nG49\nM2").provenance.size(), 1U);
}

TEST(NcOffsets, AreRefusedIfInvalid) {
  const std::pair<const char*, const char*> cases[] = {
      {"G92", "G92 without axis words"},
      {"G52", "G52 without axis words"},
      {"G10 L2 X1", "G10 needs P"},
      {"G10 P1 X1", "G10 needs L"},
      {"G10 L2 P10 X1", "G10 L2 takes P0 to P9"},
      {"G10 L20 P1 R5", "R with G10 L20: only L2 turns a system"},
      {"G10 L3 P1 X1", "G10 L3 is not read: L1, L2, L10, L11 and L20 are"},
      {"G53 X1",
       "axis words without a motion (G0, G1, G2, G3): option first_motion names the one at the control's start"},
      {"G53 G2 X1 I.5 F1", "G53 goes with G0 and G1 only"},
      {"G91 G53 G0 X1", "G53 under G91: machine positions are absolute (G90)"},
      {"G0 X1 G92 Y1", "two codes that both use axis words: they need a block each"},
      {"G41 D1 G1 X1 F1",
       "cutter radius compensation (G41): where the program has the contour, read it with options "
       "{'cutter_compensation': 'offset', 'tool_diameters': 6}, the tool's diameter in mm; where it has the path of "
       "the "
       "tool's centre, with {'cutter_compensation': 'ignore'}"},
  };
  for (const auto& [text, what] : cases)
    EXPECT_EQ(nc_error(std::string("\n") + text), std::string("line 2: ") + what + " [" + text + "]");
}

}  // namespace
}  // namespace riffler::nc::offsets_test
