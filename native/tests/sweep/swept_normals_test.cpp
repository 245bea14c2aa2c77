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

}  // namespace
}  // namespace riffler::sweep::swept_normals_test
