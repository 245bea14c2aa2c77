#include <gtest/gtest.h>

#include <random>

#include "reference/swept_distance.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::sweep::random_moves_test {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random) {
  return std::uniform_real_distribution<double>(0, 1)(random);
}

Vec3 direction(Random& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(Vec3(x, y, z));
}

Tool any_cutter(Random& random) {
  const double d = 1 + 6 * uniform(random);
  switch (random() % 6) {
    case 0:
      return cutters::ball(d, 25);
    case 1:
      return cutters::flat(d, 25);
    case 2:
      return cutters::fillet(d, d / 6, 25);
    case 3:
      return cutters::taper(d / 8, 0.25, d, 40);
    case 4:
      return cutters::cone_end(1.0, d / 10, 0.4, d, 40);
    default:
      return cutters::ball(d, d * 0.6);  // its flat upper face reaches the material
  }
}

/// A move that turns by 0.001 to 3.1 rad about any axis, over a distance of some millimetres or none.
std::pair<Pose, Pose> any_move(Random& random) {
  const Vec3 from = random() % 4 == 0 ? Vec3(0, 0, 1) : direction(random);
  const Vec3 about = glm::normalize(glm::cross(from, direction(random)));
  const double angle = std::min(3.1, std::pow(10.0, -3 + 3.49 * uniform(random)));
  const Vec3 to = glm::normalize(std::cos(angle) * from + std::sin(angle) * glm::cross(about, from));
  const double x = 20 * uniform(random), y = 19 * uniform(random), z = 14 * uniform(random);
  const Vec3 way = random() % 3 == 0 ? Vec3(0) : 4.0 * uniform(random) * direction(random);
  return {{{x, y, z}, from}, {Vec3(x, y, z) + way, to}};
}

/// Every end and some points of every ray, against the reference.
void expect_within(const Volume& volume, const reference::SweptDistance& swept, double tolerance, Random& random) {
  for (const dexel::Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        const auto distance = [&](double s) {  // no closer than the comparisons ask
          return swept.bracket(to_world(grid.axis(), {grid.u(i), grid.v(j), s}), tolerance / 50, 4 * tolerance).upper;
        };
        const double lower = grid.box().lower.z, upper = grid.box().upper.z;
        const std::span<const dexel::Span> ray = grid.ray(i, j);
        for (const dexel::Span& s : ray)
          for (const double end : {s.near, s.far}) {
            if (end <= lower || end >= upper) continue;
            ASSERT_LE(std::abs(distance(end)), tolerance) << i << ", " << j;
          }
        for (int k = 0; k < 3; ++k) {
          const double s = lower + uniform(random) * (upper - lower), off = distance(s);
          const bool solid =
              std::any_of(ray.begin(), ray.end(), [&](const dexel::Span& x) { return s >= x.near && s <= x.far; });
          if (std::abs(off) <= tolerance) continue;
          ASSERT_EQ(solid, off > 0) << i << ", " << j << " at " << s;
        }
      }
}

TEST(Carve, RandomTurningMovesKeepTheTolerance) {
  // The first three turn a flat face edge-on to a ray; they failed while two tangents were trusted across such an edge.
  std::vector<int> seeds{5139, 7109, 8628};
  for (int seed = 0; seed < 250; ++seed) seeds.push_back(seed);
  for (const int seed : seeds) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const Tool tool = any_cutter(random);
    const auto [from, to] = any_move(random);
    Volume volume = Volume::block({{{0, 0, 0}, {20, 19, 14}}, 1.9, "xyz"});
    CarveOptions options;
    options.tolerance = std::pow(10.0, -1 - 2 * uniform(random));
    carve(volume, tool, std::vector<Pose>{from, to}, options);
    expect_within(volume, {tool.profile(), Motion(from, to)}, options.tolerance, random);
  }
}

/// A thin disc that turns edge-on to the rays: hits on its faces run along the ray without bound, and the face through
/// which a ray enters changes.
TEST(Carve, DiscsThatTurnEdgeOnToTheRaysKeepTheTolerance) {
  for (const double height : {0.05, 0.3})
    for (const double lean : {0.0, 0.02, 0.4}) {
      SCOPED_TRACE(height);
      const Tool tool = cutters::flat(9, height);
      const auto axis = [&](double angle) { return glm::normalize(Vec3(std::cos(angle), lean, std::sin(angle))); };
      const Pose from{{10, 9, 7}, axis(-0.25)}, to{{11, 9.5, 7.5}, axis(0.3)};
      Volume volume = Volume::block({{{0, 0, 0}, {20, 19, 14}}, 0.7, "xyz"});
      CarveOptions options;
      options.tolerance = 0.005;
      carve(volume, tool, std::vector<Pose>{from, to}, options);
      Random random(1);
      expect_within(volume, {tool.profile(), Motion(from, to)}, options.tolerance, random);
    }
}

}  // namespace
}  // namespace riffler::sweep::random_moves_test
