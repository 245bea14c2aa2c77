#include <gtest/gtest.h>

#include <random>

#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::sweep::swept_normals_test {
namespace {

constexpr double kRadius = 3, kWay = 1e5 * kRadius;  // mm

/// A tool that passes through `middle` in the direction `way`, from far away to far away.
struct Pass {
  Vec3 middle, axis, way;
  std::vector<Pose> poses() const { return {{middle - 0.37 * kWay * way, axis}, {middle + 0.63 * kWay * way, axis}}; }
  /// The normal of the wall that the shank sweeps, on the side of `aside`.
  Vec3 wall(const Vec3& aside) const {
    const Vec3 n = glm::normalize(glm::cross(axis, way));
    return glm::dot(n, aside) < 0 ? -n : n;
  }
};

/// The outward normal at p of what the ball's capsule and its shank sweep.
Vec3 of_ball(const Pass& pass, const Vec3& p) {
  const Vec3 w = p - pass.middle - kRadius * pass.axis, n = glm::normalize(w - glm::dot(w, pass.way) * pass.way);
  return glm::dot(n, pass.axis) <= 0 ? n : pass.wall(w);
}

/// The same of a flat end: p is on the rim if it is kRadius from the axis when the flat end passes it.
Vec3 of_flat(const Pass& pass, const Vec3& p) {
  const Vec3 w = p - pass.middle, at = w - glm::dot(w, pass.axis) / glm::dot(pass.way, pass.axis) * pass.way;
  if (std::abs(glm::length(at) - kRadius) > 1e-8) return pass.wall(w);
  const Vec3 n = glm::normalize(glm::cross(glm::cross(pass.axis, at), pass.way));
  return glm::dot(n, at) < 0 ? -n : n;
}

template <class Normal>
void expect_normals(const Tool& tool, const Normal& normal) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> spread;
  const auto direction = [&] { return glm::normalize(Vec3(spread(random), spread(random), spread(random))); };
  const dexel::Frame frame{{{0, 0, 0}, {17, 18, 19}}, 1, "xyz"};
  int ends = 0;
  for (int k = 0; k < 60; ++k) {
    const Pass pass{{8.3, 9.2, 9.7}, direction(), direction()};
    if (std::abs(glm::dot(pass.axis, pass.way)) < 0.02) continue;  // rounding then turns the normal of the rim
    Volume volume = Volume::block(frame);
    carve(volume, tool, pass.poses());
    for (const dexel::Grid& grid : volume.grids())
      for (int i = 0; i < grid.nu(); ++i)
        for (int j = 0; j < grid.nv(); ++j) {
          const auto ray = grid.ray(i, j);
          for (std::size_t s = 0; s < ray.size(); ++s)
            for (const bool near : {true, false}) {
              const double end = near ? ray[s].near : ray[s].far;
              if (end == grid.box().lower.z || end == grid.box().upper.z) continue;
              const Vec3 p = to_world(grid.axis(), {grid.shifted_u(i), grid.shifted_v(j), end});
              const dexel::SpanNormals& stored = grid.ray_normals(i, j)[s];
              const Vec3 n = (near ? stored.near : stored.far).unpack();
              ASSERT_LT(glm::length(n + normal(pass, p)), 7e-5)
                  << tool.kind() << " " << k << ", ray " << i << ", " << j;
              ++ends;
            }
        }
  }
  EXPECT_GT(ends, 10000);
}

/// The time at which an end arises is stored with 30 bits: over the whole move, they would be 3e-4 mm.
TEST(SweptNormals, AreExactOnMovesAHundredThousandRadiiLong) {
  expect_normals(cutters::ball(2 * kRadius, 90), of_ball);
  expect_normals(cutters::flat(2 * kRadius, 90), of_flat);
}

/// The apex of a cone sweeps an edge as long as the path is flatter than the cone.
TEST(SweptNormals, AreSquareToTheLineOfAnApex) {
  const Tool tool = cutters::cone_end(0.85, 0.5, 0.4, 4, 40);
  const Vec3 start{6.25, 6.25, 5};
  int ends = 0;
  for (const Vec3& way : {Vec3(-4, 0, 1), Vec3(-4, 0, -1), Vec3(3, 0, 0.6), Vec3(3, 0, 0), Vec3(4.3, 0, -2.9)}) {
    Volume volume = Volume::block({{{0, 0, 0}, {12, 12, 12}}, 0.5, "xyz"});
    carve(volume, tool, std::vector<Pose>{{start, {0, 0, 1}}, {start + way, {0, 0, 1}}});
    const dexel::Grid& grid = volume.grids()[2];
    for (int i = 0; i < grid.nu(); ++i) {
      const double t = (grid.u(i) - start.x) / way.x;
      if (t < 1e-6 || t > 1 - 1e-6) continue;
      const Vec3 normal = grid.ray_normals(i, 12)[0].far.unpack();  // y = 6.25
      const Vec3 edge = glm::normalize(Vec3(-way.z, 0, way.x) * (way.x < 0 ? -1.0 : 1.0));
      EXPECT_LT(glm::length(normal - edge), 1e-4) << "moved by " << way.x << ", " << way.z << ", ray " << i;
      ++ends;
    }
  }
  EXPECT_GT(ends, 30);
}

/// A rim that slides along itself, next to an arc whose end does, too.
TEST(SweptNormals, AreSquareToAWallThatARimSweepsAlongTheAxis) {
  const Tool tool = cutters::profile({{{1.75, 0}, {}}, {{3.5, 1.75}, Vec2(1.75, 1.75)}, {{2.25, 7}, {}}}, 7);
  int ends = 0;
  for (const double rise : {0.3, 1.7, 5.1, 17.3, 41.0}) {
    Volume volume = Volume::block({{{-4, -4, 0}, {4, 4, 8}}, 0.3, "xyz"});
    const Pose from{{0.013, 0.021, 2}, {0, 0, 1}}, to{from.tip + Vec3(0, 0, rise), {0, 0, 1}};
    carve(volume, tool, std::vector<Pose>{from, to});
    for (int k : {0, 1}) {
      const dexel::Grid& grid = volume.grids()[static_cast<std::size_t>(k)];
      for (int i = 0; i < grid.nu(); ++i)
        for (int j = 0; j < grid.nv(); ++j) {
          const auto ray = grid.ray(i, j);
          if (ray.size() != 2) continue;
          const Vec3 p = to_world(grid.axis(), {grid.u(i), grid.v(j), ray[0].far}) - from.tip;
          if (p.z < 1.75 || p.z > std::min(rise, 4.0)) continue;
          const Vec3 normal = grid.ray_normals(i, j)[0].far.unpack();
          EXPECT_LT(glm::length(normal + Vec3(p.x, p.y, 0) / 3.5), 1e-4) << p.z << ", rise " << rise;
          ++ends;
        }
    }
  }
  EXPECT_GT(ends, 100);
}

}  // namespace
}  // namespace riffler::sweep::swept_normals_test
