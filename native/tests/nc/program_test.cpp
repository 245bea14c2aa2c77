#include "riffler/nc/program.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace riffler::nc::program_test {
namespace {

std::string error_of(const Program& program, const Move& move) {
  Program copy = program;
  try {
    copy.append(move);
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(copy.size(), program.size()) << "half a row was added";
    return e.what();
  }
  return "";
}

TEST(Program, RefusesInvalidMovesAndNamesTheRow) {
  Program p;
  p.append({{{0, 0, 0}, {0, 0, 1}}, 100, 0, 1, 0, false});
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Pose up{{1, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(error_of(p, {{{nan, 0, 0}, {0, 0, 1}}, 100}), "poses, row 1: not finite");
  EXPECT_EQ(error_of(p, {{{0, 0, 0}, {0, 0, inf}}, 100}), "poses, row 1: not finite");
  EXPECT_EQ(error_of(p, {{{0, 0, 0}, {0, 0, 0}}, 100}), "poses, row 1: the axis is not a unit vector");
  EXPECT_EQ(error_of(p, {{{0, 0, 0}, {0, 0, 1.000002}}, 100}), "poses, row 1: the axis is not a unit vector");
  EXPECT_EQ(error_of(p, {up, 0}), "feed, row 1: 0, but the tip moves");
  EXPECT_EQ(error_of(p, {up, -1}), "feed, row 1: must be positive and finite");
  EXPECT_EQ(error_of(p, {up, nan}), "feed, row 1: must be positive and finite");
  EXPECT_EQ(error_of(p, {up, 1, inf}), "spindle, row 1: not finite or out of range");
  EXPECT_EQ(error_of(p, {up, 1, 0, -1}), "tool, row 1: negative or out of range");
  EXPECT_EQ(error_of(p, {up, 1}), "");
  EXPECT_EQ(error_of(p, {up, nan, 0, 1, 0, true}), "") << "a rapid has no feed";
  EXPECT_EQ(error_of(p, {{{0, 0, 0}, {1, 0, 0}}, 0}), "") << "the tip stands still";
}

TEST(Program, NormalisesAxesThatAreNearlyUnit) {
  Program p;
  p.append({{{0, 0, 0}, {0, 0.6 * (1 + 9e-7), 0.8 * (1 + 9e-7)}}, 1});
  EXPECT_NEAR(glm::length(p.poses()[0].axis), 1, 3e-16);
}

TEST(Program, RunsChangeWithTheTool) {
  Program p;
  for (const int tool : {1, 1, 2, 1, 1, 1}) p.append({{}, 1, 0, tool, 0, false});
  const auto runs = p.runs();
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].end, 2U);
  EXPECT_EQ(runs[1].tool, 2);
  EXPECT_EQ(runs[2].begin, 3U);
  EXPECT_EQ(runs[2].end, 6U);
  EXPECT_TRUE(Program().runs().empty());
}

}  // namespace
}  // namespace riffler::nc::program_test
