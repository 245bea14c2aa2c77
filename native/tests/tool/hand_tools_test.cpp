#include "riffler/tool/hand_tools.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace riffler::tool {
namespace {

std::string error_of(const std::vector<Vec3>& points) {
  try {
    hand_tools::convex({points});
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(HandTools, HullsKeepOnlyTheirCorners) {
  std::vector<Vec3> points;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z) points.push_back({x, y, z});
  const Hull hull = make_hull(points, "hull");
  EXPECT_EQ(hull.faces.size(), 6U);
  EXPECT_EQ(hull.vertices.size(), 8U);
  EXPECT_DOUBLE_EQ(hull.size, std::sqrt(12.0));
}

TEST(HandTools, BadBodiesAreNamed) {
  EXPECT_NE(error_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}).find("hulls[0]: the body is flat"),
            std::string::npos);
  EXPECT_NE(error_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).find("flat"), std::string::npos);
  EXPECT_NE(error_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).find("flat"), std::string::npos);
  EXPECT_NE(error_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).find("four points"), std::string::npos);
  EXPECT_NE(error_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, NAN}}).find("point 3: not finite"), std::string::npos);
  EXPECT_THROW(hand_tools::gouge(12, 5, 0.5, 30), std::invalid_argument);
  EXPECT_THROW(hand_tools::chisel(12, 3, 0.1, 20), std::invalid_argument);
  EXPECT_THROW(hand_tools::v_tool(0, 10, 0.5, 30), std::invalid_argument);
}

TEST(HandTools, CallsForBodiesOfRevolutionRefuseThem) {
  const Tool tool = hand_tools::v_tool(1, 10, 0.5, 60);
  EXPECT_FALSE(tool.revolved());
  EXPECT_EQ(tool.name(), "v_tool 10");
  EXPECT_DOUBLE_EQ(tool.length(), 60);
  EXPECT_THROW(tool.profile(), std::invalid_argument);
  EXPECT_THROW(tool.cutter(), std::invalid_argument);
  EXPECT_THROW(tool.assembly(), std::invalid_argument);
  EXPECT_THROW(tool.with_shank({}), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::tool
