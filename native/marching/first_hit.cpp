#include "marching/first_hit.hpp"

#include <algorithm>
#include <cmath>

#include "marching/facets.hpp"

namespace riffler::marching {

namespace {

// A brick's quads have corners in its cells and in the layer below; a vertex leaves its cell by less than a cell.
constexpr int kBelow = 2, kAbove = 1;

/// Bounding box of all possible triangles of the bricks from `first` to `last`.
Box3 reach(const Lattice& lattice, const Vec3i& first, const Vec3i& last) {
  Box3 box;
  for (int a = 0; a < 3; ++a) {
    box.lower[a] = lattice.at(a, first[a] * kBrickSide - kBelow);
    box.upper[a] = lattice.at(a, (last[a] + 1) * kBrickSide + kAbove);
  }
  return box;
}

/// The first and last brick along an axis that may have triangles between two coordinates, within the lattice.
std::pair<int, int> bricks_between(const Lattice& lattice, int axis, double from, double to) {
  const auto brick = [&](double x, int reach) {
    const double place = (x - lattice.at(axis, 0)) / lattice.pitch() + reach;
    return static_cast<int>(std::clamp(std::floor(place / kBrickSide), 0.0, bricks_along(lattice, axis) - 1.0));
  };
  return {brick(from, -kAbove - 1), brick(to, kBelow)};
}

}  // namespace

std::optional<SurfaceHit> first_hit(const Lattice& lattice, const Vec3& origin, const Vec3& direction,
                                    const FacetsOf& facets, PickStats& stats) {
  const Vec3i count{bricks_along(lattice, 0), bricks_along(lattice, 1), bricks_along(lattice, 2)};
  const Box3 all = reach(lattice, Vec3i(0), count - 1);
  double far = 0;
  for (int a = 0; a < 3; ++a) far = std::max({far, std::abs(all.lower[a]), std::abs(all.upper[a])});
  const Sight sight(to_local(lattice.axis(), origin), to_local(lattice.axis(), direction), far);
  Nearest best;
  ++stats.rays;
  // Visit layers of bricks perpendicular to the ray's main axis: the ray leaves each layer after a few bricks. Layers
  // overlap, so a hit in the next one may still be nearer than one in this layer.
  const int k = sight.axis(), i = (k + 1) % 3, j = (k + 2) % 3;
  const bool up = sight.direction()[k] > 0;
  for (int layer = 0; layer < count[k]; ++layer) {
    Vec3i first{0}, last = count - 1;
    first[k] = last[k] = up ? layer : count[k] - 1 - layer;
    const Box3 box = reach(lattice, first, last);
    const Sight::Range range = sight.through(box.lower, box.upper);
    if (range.empty()) continue;
    if (range.enter > best.distance) break;
    for (const int a : {i, j}) {
      const auto [from, to] = sight.between(a, range);
      std::tie(first[a], last[a]) = bricks_between(lattice, a, from, to);
    }
    Vec3i at;
    for (at.x = first.x; at.x <= last.x; ++at.x)
      for (at.y = first.y; at.y <= last.y; ++at.y)
        for (at.z = first.z; at.z <= last.z; ++at.z) {
          const Box3 own = reach(lattice, at, at);
          const Sight::Range inside = sight.through(own.lower, own.upper);
          if (inside.empty() || inside.enter > best.distance) continue;
          const std::size_t number = (static_cast<std::size_t>(at.x) * count.y + at.y) * count.z + at.z;
          const Facets* const found = facets(number);
          if (!found) continue;
          ++stats.bricks_visited;
          stats.triangles_tested += found->look(sight, number, best);
        }
  }
  if (best.distance == std::numeric_limits<double>::infinity()) return std::nullopt;
  return SurfaceHit{best.distance, to_world(lattice.axis(), sight.at(best.distance)),
                    to_world(lattice.axis(), glm::normalize(best.normal)), best.brick};
}

}  // namespace riffler::marching
