// The kernels give the same bits on every instruction set that this machine has, whole and in part of a group of lanes.
#include <gtest/gtest.h>
#include <numeric>
#include <random>

#include <cmath>

#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/effort.hpp"
#include "sweep/kernels.hpp"

namespace riffler::sweep::instruction_sets_test {
namespace {

struct Result {
  Volume volume;
  Cut cut;
};

std::vector<Pose> winding_path() {
  std::vector<Pose> poses;
  for (int k = 0; k <= 60; ++k) {
    const Vec3 axis{0.5 * std::sin(0.2 * k), 0.4 * std::cos(0.13 * k), 1};
    // Every third move keeps its orientation.
    const Vec3 held = k % 3 == 1 ? poses.back().axis : glm::normalize(axis);
    poses.push_back({{4 + 0.4 * k, 15 + 8 * std::sin(0.1 * k), 6 + std::cos(0.3 * k)}, held});
  }
  return poses;
}

/// Moves across what others have left, which no move before has smoothed.
std::vector<Pose> random_path() {
  std::mt19937 bits(7);
  const auto uniform = [&](double a, double b) { return a + (b - a) * (static_cast<double>(bits()) / 4294967296.0); };
  std::vector<Pose> poses;
  for (int k = 0; k <= 60; ++k) {
    const Vec3 axis = k % 4 == 1 ? poses.back().axis : glm::normalize(Vec3(uniform(-1, 1), uniform(-1, 1), 1));
    poses.push_back({{uniform(-2, 33), uniform(-2, 31), uniform(3, 11)}, axis});
  }
  return poses;
}

Result carved(const Tool& tool, const char* directions, const std::vector<Pose>& path) {
  Result out{Volume::block({{{0, 0, 0}, {31, 29, 11}}, test::kSanitized ? 0.74 : 0.37, directions}), {}};
  CarveOptions options;
  options.dt.assign(path.size() - 1, 0.001);
  out.cut = carve(out.volume, tool, path, options);
  return out;
}

void expect_same(const Result& a, const Result& b) {
  EXPECT_TRUE(a.cut.removed == b.cut.removed);
  EXPECT_TRUE(a.cut.force == b.cut.force);
  EXPECT_TRUE(a.cut.torque == b.cut.torque);
  for (std::size_t g = 0; g < a.volume.grids().size(); ++g)
    for (std::size_t t = 0; t < a.volume.grids()[g].tile_count(); ++t) {
      EXPECT_TRUE(a.volume.grids()[g].tile(t).offset == b.volume.grids()[g].tile(t).offset);
      EXPECT_TRUE(a.volume.grids()[g].tile(t).spans == b.volume.grids()[g].tile(t).spans);
      EXPECT_TRUE(a.volume.grids()[g].tile(t).normals == b.volume.grids()[g].tile(t).normals);
    }
}

TEST(Kernels, GiveTheSameBitsOnEveryInstructionSet) {
  const std::vector<std::string> sets = instruction_sets();
  ASSERT_FALSE(sets.empty());
  for (const std::string& name : sets) std::printf("instruction set: %s\n", name.c_str());
  const Tool free = cutters::profile({{{1.5, 0}, {}}, {{3, 1.5}, Vec2(1.5, 1.5)}, {{2, 6}, {}}, {{4, 8}, {}}}, 20);
  const std::vector<Pose> paths[] = {winding_path(), random_path()};
  for (const Tool& tool : {cutters::ball(6, 20), cutters::flat(5, 20), cutters::fillet(6, 1, 20), free,
                           cutters::taper(0.5, 0.3, 7, 20), cutters::cone_end(1.0, 1, 0.4, 6, 20)})
    for (const char* directions : {"z", "xyz"})
      for (const std::vector<Pose>& whole : paths) {
        if (test::kSanitized && (directions == std::string("z") || &whole == paths)) continue;
        const std::vector<Pose> path(whole.begin(), whole.begin() + test::cases(static_cast<int>(whole.size()), 10));
        SCOPED_TRACE(tool.kind());
        use_instruction_set(sets.front());
        const Result best = carved(tool, directions, path);
        EXPECT_GT(std::accumulate(best.cut.removed.begin(), best.cut.removed.end(), 0.0), 50);
        for (const std::string& name : sets) {
          SCOPED_TRACE(name);
          use_instruction_set(name);
          expect_same(best, carved(tool, directions, path));
        }
        use_instruction_set("");
      }
}

TEST(Kernels, RefuseAMissingInstructionSet) {
  EXPECT_THROW(use_instruction_set("AVX1024"), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::sweep::instruction_sets_test
