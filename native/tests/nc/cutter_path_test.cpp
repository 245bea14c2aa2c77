#include "riffler/nc/cutter_path.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace riffler::nc::cutter_path_test {
namespace {

const Box3 kStock{{0, 0, 0}, {100, 60, 30}};

/// Least z of the tool's solid (cylinder of the cutter's radius about the axis) at a pose.
double lowest(const Pose& pose, double radius, double length) {
  const double side = std::sqrt(1 - pose.axis.z * pose.axis.z);
  return pose.tip.z + std::min(0.0, pose.axis.z * length) - radius * side;
}

TEST(CutterPath, BecomesApproachFeedRowsAndRetract) {
  const Pose a{{10, 10, 5}, {0, 0, 1}}, b{{20, 10, 5}, {0, 0.6, 0.8}};
  const Program p =
      program_from_paths(std::vector<CutterPath>{{{a, a, b}, {100, 200, 300}, 8000, 3}}, {}, {50, 10, {}});
  ASSERT_EQ(p.size(), 5U);
  EXPECT_EQ(p.rapid(), (std::vector<std::uint8_t>{1, 0, 0, 0, 1}));
  EXPECT_EQ(p.feed(), (std::vector<double>{0, 100, 200, 300, 0}));
  EXPECT_EQ(p.poses()[0].tip, Vec3(10, 10, 50));
  EXPECT_EQ(p.poses()[2].tip, a.tip) << "a doubled row is kept";
  EXPECT_NEAR(p.poses()[4].tip.z, 50, 1e-12);
  EXPECT_LT(glm::length(glm::cross(p.poses()[4].tip - b.tip, b.axis)), 1e-12) << "out along the axis";
  EXPECT_EQ(p.poses()[4].axis, b.axis);
  for (const int tool : p.tool()) EXPECT_EQ(tool, 3);
  for (const double s : p.spindle()) EXPECT_EQ(s, 8000);
}

TEST(CutterPath, RapidsKeepOutOfTheStockForAnyAxis) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit;
  const std::map<int, Tool> tools{{1, Tool("flat", {}, tool::Profile({{{3, 0}, {}}, {{3, 40}, {}}}))}};
  for (int round = 0; round < 300; ++round) {
    std::vector<CutterPath> paths;
    for (int k = 0; k < 3; ++k) {
      CutterPath path{{}, {100}, 0, 1};
      for (int i = 0; i < 2; ++i)
        path.poses.push_back({Vec3(unit(random), unit(random), unit(random)) * kStock.upper,
                              glm::normalize(Vec3(normal(random), normal(random), normal(random)))});
      if (round == 0) path.poses[0].axis = {0, 0, -1}, path.poses[1].axis = {1, 0, 0};
      paths.push_back(path);
    }
    const Program p = program_from_paths(paths, tools, {{}, 5, kStock});
    for (std::size_t row = 1; row < p.size(); ++row) {
      if (!p.rapid()[row]) continue;
      const Pose &a = p.poses()[row - 1], &b = p.poses()[row];
      const bool leaves = !p.rapid()[row - 1];
      if (leaves) {
        EXPECT_LT(glm::length(glm::cross(b.tip - a.tip, a.axis)), 1e-9 * glm::length(b.tip - a.tip))
            << "along the axis";
        EXPECT_GT(glm::dot(b.tip - a.tip, a.axis), 0);
        continue;
      }
      // The tip and the reach of the cutter's radius keep out of the stock; above it, so does the whole tool.
      for (int i = 0; i <= 50; ++i) {
        const Pose pose = Motion(a, b).at(i / 50.0);
        const Vec3 q = glm::clamp(pose.tip, kStock.lower, kStock.upper);
        ASSERT_GT(glm::length(q - pose.tip), 3) << "round " << round << " row " << row;
        ASSERT_TRUE(a.axis == b.axis || lowest(pose, 3, 40) > kStock.upper.z) << "round " << round << " row " << row;
      }
    }
  }
}

TEST(CutterPath, NamesBadInput) {
  const Pose up{{0, 0, 0}, {0, 0, 1}};
  const auto error = [](const CutterPath& path, const Clearance& clearance) -> std::string {
    try {
      program_from_paths(std::vector<CutterPath>{path}, {}, clearance);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error({{}, {1}}, {}), "path 0 has no rows");
  EXPECT_EQ(error({{up, {{0, 0, 0}, {0, 0, 2}}}, {1}}, {}), "path 0, row 1: the axis is not a unit vector");
  EXPECT_EQ(error({{up, up}, {1, 0}}, {}), "path 0, row 1: feed must be positive and finite");
  EXPECT_EQ(error({{up, up, up}, {1, 2}}, {}), "path 0: one feed, or one per row");
  EXPECT_NE(error({{up}, {1}}, {-1, 10, {}}).find("safe_height"), std::string::npos);
  EXPECT_NE(error({{up}, {1}}, {{}, 0, {}}).find("clearance"), std::string::npos);
  EXPECT_TRUE(program_from_paths({}, {}).empty());
}

}  // namespace
}  // namespace riffler::nc::cutter_path_test
