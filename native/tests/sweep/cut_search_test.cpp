// Distances from swept bodies against dense sampling, and the moves that made a surface against carving one move after
// the other.
#include "riffler/sweep/cut_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "riffler/base/parallel.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "sweep/swept_distance.hpp"

namespace riffler::sweep::cut_search_test {
namespace {

std::vector<Tool> some_tools() {
  return {cutters::ball(6, 30), cutters::flat(8, 30), cutters::fillet(10, 2, 30), cutters::taper(1, 0.2, 8, 30)};
}

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  Vec3 vec(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
  Vec3 axis() {
    for (;;)
      if (const Vec3 v = vec(1); glm::length(v) > 0.1 && glm::length(v) < 1) return glm::normalize(v);
  }

 private:
  std::mt19937 engine_;
};

double dense(const tool::Outline& cutter, const Motion& motion, const Vec3& p) {
  double best = 1e300;
  constexpr int kSteps = 4000;
  for (int k = 0; k <= kSteps; ++k) {
    const Pose pose = motion.at(static_cast<double>(k) / kSteps);
    const double z = glm::dot(p - pose.tip, pose.axis);
    best = std::min(best, cutter.nearest(glm::length(p - pose.tip - z * pose.axis), z).distance);
  }
  return best;
}

TEST(SweptDistance, IsThatOfDenseSampling) {
  Draw draw(5);
  for (const Tool& tool : some_tools()) {
    const tool::Outline cutter(tool);
    for (int k = 0; k < 100; ++k) {
      const Vec3 axis = draw.axis();
      // Nothing moves, only the tip, only the axis, both; a turn by 1e-12 rad.
      const int kind = k % 5;
      const Pose from{draw.vec(5), axis};
      const Vec3 side = glm::normalize(glm::cross(axis, draw.axis()));
      Pose to = from;
      if (kind == 1 || kind == 3) to.tip += draw.vec(10);
      if (kind >= 2) to.axis = glm::normalize(axis + (kind == 4 ? 1e-12 : draw(0.01, 1.5)) * side);
      const Motion motion(from, to);
      const Vec3 p = draw.vec(20);
      const double truth = dense(cutter, motion, p), speed = 40.0 / 4000;
      const double found = swept_distance(cutter, motion, p, 1e300, 1e-4);
      EXPECT_GT(found, truth - speed) << tool.kind() << " " << k;
      EXPECT_LT(found, truth + 1e-4 + 1e-9) << tool.kind() << " " << k;
      EXPECT_GT(swept_distance(cutter, motion, p, truth - 1, 1e-4), truth - 1);
    }
  }
}

TEST(SweptDistance, IsTheSameFarFromTheOrigin) {
  const tool::Outline cutter(cutters::ball(6, 30));
  const Vec3 far(1e5, -1e5, 1e5);
  const Motion here({{0, 0, 0}, {0, 0, 1}}, {{10, 0, 0}, {0, 0, 1}});
  const Motion there({far, {0, 0, 1}}, {far + Vec3(10, 0, 0), {0, 0, 1}});
  const Vec3 p(4, 1, -2);
  EXPECT_NEAR(swept_distance(cutter, here, p, 1e300, 1e-6), swept_distance(cutter, there, far + p, 1e300, 1e-6), 1e-9);
}

std::vector<Vec3> tops_of(const Volume& volume) {
  std::vector<Vec3> out;
  const dexel::Grid& grid = volume.grids().front();
  for (int i = 0; i < grid.nu(); ++i)
    for (int j = 0; j < grid.nv(); ++j) {
      const auto spans = grid.ray(i, j);
      out.emplace_back(grid.shifted_u(i), grid.shifted_v(j), spans.empty() ? -1 : spans.back().far);
    }
  return out;
}

/// Carves move by move and notes, for each ray, the last move that lowered its upper end. Then each upper end is asked.
TEST(CutSearch, FindsTheMoveThatLastChangedEachRay) {
  constexpr double kTolerance = 0.01;
  const std::vector<Tool> tools = some_tools();
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Draw draw(seed);
    Volume volume = Volume::block({{{-20, -20, 0}, {20, 20, 20}}, 0.5, "z"});
    std::vector<SearchedMove> moves;
    std::vector<Vec3> tops = tops_of(volume);
    std::vector<std::int32_t> maker(tops.size(), -1);
    Pose at{{0, 0, 25}, {0, 0, 1}};
    for (std::int32_t k = 0; k < 40; ++k) {
      const Vec3 axis = glm::normalize(Vec3(draw(-0.4, 0.4), draw(-0.4, 0.4), 1));
      const Pose next{{draw(-9, 9), draw(-9, 9), draw(8, 19)}, k % 3 == 0 ? at.axis : axis};
      const std::uint32_t tool = static_cast<std::uint32_t>(k) % 4;
      moves.push_back({at, next, tool, 10 * k});
      CarveOptions options;
      options.tolerance = 1e-6;
      carve(volume, tools[tool], std::vector<Pose>{at, next}, options);
      std::vector<Vec3> now = tops_of(volume);
      for (std::size_t r = 0; r < now.size(); ++r)
        if (now[r] != tops[r]) maker[r] = 10 * k;
      tops = std::move(now), at = next;
    }
    const CutSearch search(tools, moves, kTolerance);
    base::set_thread_count(1);
    const std::vector<std::int32_t> found = search.find(tops);
    base::set_thread_count(2);
    EXPECT_EQ(search.find(tops), found);
    base::set_thread_count(std::nullopt);
    std::size_t other = 0, stock = 0;
    for (std::size_t r = 0; r < found.size(); ++r) {
      if (tops[r].z < 0) continue;  // nothing is left of the ray
      stock += maker[r] < 0;
      if (found[r] == maker[r]) continue;
      ASSERT_GE(found[r], 0) << "seed " << seed << ", ray " << r;
      const SearchedMove& move = moves[static_cast<std::size_t>(found[r] / 10)];
      const double distance =
          std::abs(swept_distance(tool::Outline(tools[move.tool]), Motion(move.from, move.to), tops[r], 1e300, 1e-6));
      // The stock's own surface at the edge of a groove.
      if (maker[r] < 0) {
        EXPECT_LE(distance, kTolerance);
        continue;
      }
      // An earlier move came within the band of equals: consecutive moves touch where they meet.
      ++other;
      EXPECT_LT(found[r], maker[r]);
      EXPECT_LT(distance, 0.1 * kTolerance);
    }
    EXPECT_GT(stock, 20U);
    EXPECT_LT(other, found.size() / 10);
  }
}

TEST(CutSearch, TheFirstOfRepeatedMovesMadeTheSurface) {
  const Pose a{{0, 0, 0}, {0, 0, 1}}, b{{20, 0, 0}, {0, 0, 1}};
  const CutSearch search({cutters::ball(6, 30)}, {{a, b, 0, 7}, {b, a, 0, 8}, {a, a, 0, 9}}, 0.05);
  EXPECT_EQ(search.find(std::vector<Vec3>{{10, 0, 0}, {-3, 0, 3}, {10, 0, -0.04}, {10, 0, -0.06}, {10, 3, 10}}),
            (std::vector<std::int32_t>{7, 7, 7, -1, 7}));
}

TEST(CutSearch, NoMovesMadeNoSurfaceAndBadInputIsNamed) {
  const Pose a{{0, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(CutSearch({}, {}, 0.05).find(std::vector<Vec3>{{0, 0, 0}}), std::vector<std::int32_t>{-1});
  EXPECT_TRUE(CutSearch({}, {}, 0.05).find({}).empty());
  EXPECT_THROW(CutSearch({}, {}, 0), std::invalid_argument);
  EXPECT_THROW(CutSearch({}, {{a, a, 0, 0}}, 0.05), std::invalid_argument);
  EXPECT_THROW(CutSearch({cutters::ball(6, 30)}, {{a, {{0, 0, 0}, {0, 0, -1}}, 0, 0}}, 0.05), std::invalid_argument);
}

TEST(CutSearch, CanBeCancelled) {
  const Pose a{{0, 0, 0}, {0, 0, 1}};
  const CutSearch search({cutters::ball(6, 30)}, {{a, a, 0, 0}}, 0.05);
  EXPECT_THROW(search.find(std::vector<Vec3>(100000, Vec3(0)), [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace riffler::sweep::cut_search_test
