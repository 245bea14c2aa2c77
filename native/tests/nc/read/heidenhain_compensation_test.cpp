// RL, RR and R0 of Heidenhain's conversational programs: the path of the tool's centre.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/nc_reading.hpp"

namespace riffler::nc::heidenhain_compensation_test {
namespace {

const Options kOffset{{"cutter_compensation", std::string("offset")}, {"tool_diameters", std::vector<double>{1, 2}}};

std::string program(const std::string& blocks) {
  return "0 BEGIN PGM T MM\nTOOL CALL 1 Z S1000 F100\nL X-5 Y-5 Z+0 R0 FMAX\n" + blocks + "\nEND PGM T MM\n";
}

/// Without that of the first block, which is line 3.
std::vector<Vec3> tips(const std::string& blocks, const Options& options = kOffset) {
  std::vector<Vec3> out;
  const Program read = test::read_nc_text(program(blocks), "heidenhain", options);
  for (std::size_t k = 1; k < read.size(); ++k) out.push_back(read.poses()[k].tip);
  return out;
}

std::string error(const std::string& blocks, const Options& options = kOffset) {
  return test::nc_error(program(blocks), "heidenhain", options);
}

void expect_tips(const std::vector<Vec3>& is, const std::vector<Vec3>& wanted) {
  ASSERT_EQ(is.size(), wanted.size());
  for (std::size_t k = 0; k < is.size(); ++k) EXPECT_LT(glm::length(is[k] - wanted[k]), 1e-9) << k;
}

TEST(HeidenhainCompensation, BeginsAndEndsPerpendicularToTheContour) {
  expect_tips(tips("L X0 Y0 RL F AUTO\nL X10\nL Z-1\nL Y10\nL X5\nL X0 Y20 R0\nL X-5"),
              {{0, 1, 0}, {9, 1, 0}, {9, 1, -1}, {9, 9, -1}, {5, 9, -1}, {0, 20, -1}, {-5, 20, -1}});
  expect_tips(tips("L X0 Y0 RR F100\nL X10\nL X20 R0"), {{0, -1, 0}, {10, -1, 0}, {20, 0, 0}});
}

TEST(HeidenhainCompensation, StaysBesideTheContourUntilAMoveInThePlane) {
  expect_tips(tips("L X0 Y0 RL F100\nL X10\nL Z+50 R0 FMAX\nL Z+60\nL X0\nL Y5"),
              {{0, 1, 0}, {10, 1, 0}, {10, 1, 50}, {10, 1, 60}, {0, 0, 60}, {0, 5, 60}});
  expect_tips(tips("L X0 Y0 RL F100\nL X10\nM30"), {{0, 1, 0}, {10, 1, 0}});
}

TEST(HeidenhainCompensation, GoesRoundCornersAndAlongArcs) {
  const auto outside = tips("L X0 Y0 RL F100\nL X10\nL Y-10\nL Y-20 R0");
  ASSERT_GT(outside.size(), 6U);
  for (std::size_t k = 1; k + 2 < outside.size(); ++k)
    EXPECT_NEAR(glm::length(outside[k] - Vec3(10, 0, 0)), 1, 1e-9) << k;
  const auto round = tips("L X0 Y0 RL F100\nL X10\nRND R5\nL Y20\nCT X0 Y20\nL Y0\nL Y-20 R0");
  int fillet = 0, half = 0;
  for (const Vec3& tip : round) {
    fillet += std::abs(glm::length(tip - Vec3(5, 5, 0)) - 4) < 1e-9;
    half += std::abs(glm::length(tip - Vec3(5, 20, 0)) - 4) < 1e-9;
  }
  EXPECT_GT(fillet, 10);
  EXPECT_GT(half, 20);
  const auto circle = tips("L X0 Y0 RR F100\nCC X0 Y10\nCP IPA+360 DR+\nL X10 Y-5 R0");
  for (std::size_t k = 0; k + 1 < circle.size(); ++k)
    EXPECT_NEAR(glm::length(circle[k] - Vec3(0, 10, 0)), 11, 1e-9) << k;
}

TEST(HeidenhainCompensation, TakesTheRadiusOfTheOptionOrTheProgramAndDr) {
  const auto y = [](const std::string& call, Options options) {
    return tips(call + "\nL X0 Y0 RL F100\nL X10\nL X20 R0", options)[0].y;
  };
  const Options none{{"cutter_compensation", std::string("offset")}};
  EXPECT_EQ(y("TOOL CALL 1 Z S100 DR+0.5", kOffset), 1.5);
  EXPECT_EQ(y("TOOL CALL 1 Z S100 DR-1", kOffset), 0);
  EXPECT_EQ(y("TOOL CALL 1 Z S100 DR-1.5", kOffset), -0.5);
  EXPECT_EQ(y("TOOL DEF 7 L+0 R+3\nTOOL CALL 7 Z S100", kOffset), 3);
  EXPECT_EQ(y("; D=4\nTOOL CALL 8 Z S100", none), 2);
  EXPECT_EQ(error("TOOL CALL 9 Z S100\nL X0 Y0 RL F100"),
            "line 5: cutter compensation (RL): the diameter of tool 9 is not known: give it in mm, as in options "
            "{'tool_diameters': {9: 6}} [L X0 Y0 RL F100]");
}

TEST(HeidenhainCompensation, RefusesShiftedContoursAndToolsThatDoNotFit) {
  const std::string on = "L X0 Y0 RL F100\nL X10\n", remedy = " in radius compensation: a line with R0 before it [";
  const std::pair<const char*, const char*> cases[] = {
      {"TOOL CALL 1 Z", "TOOL CALL"},
      {"L Z+50 FMAX M91", "a machine position"},
      {"CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+5", "another place or tilt of the coordinates"},
      {"L M140 MB+5 F100", "M140"},
  };
  for (const auto& [text, what] : cases) {
    const std::string is = error(on + text);
    EXPECT_NE(is.find(std::string(": ") + what + remedy), std::string::npos) << is;
    EXPECT_EQ(error(on + "L X20 R0\n" + text), "no error") << text;
  }
  EXPECT_EQ(error(on + "L X20 RR"),
            "line 6: RR changes the compensation that holds: a line with R0 before it [L X20 RR]");
  EXPECT_EQ(error("CC X-5 Y0\nC X-10 Y0 DR+ RL F100"),
            "line 5: the first move of a cutter compensation is an arc: begin with a line [C X-10 Y0 DR+ RL F100]");
  EXPECT_NE(error(on + "CC X15 Y0\nC X20 DR- R0").find("an arc after R0: write a line before it"), std::string::npos);
  EXPECT_NE(error(on + "CC X10 Y0.5\nC X10 Y1 DR+").find("the inside arc of radius 0.5 mm is not larger than the tool"),
            std::string::npos);
  EXPECT_NE(error("L X0 Y0 R+ F100").find("compensation along an axis (R+, R-) is not read"), std::string::npos);
}

}  // namespace
}  // namespace riffler::nc::heidenhain_compensation_test
