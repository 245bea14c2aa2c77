// The half space is a volume with one span per ray; a clip intersects the volume with it.
#include "riffler/dexel/clip.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/dexel/boolean.hpp"

namespace riffler::dexel {

namespace {

/// The part of a ray of `grid` behind the plane, in the grid's frame; may be empty.
struct HalfSpace {
  const Grid& grid;
  Vec3 point, normal;

  Span behind(int i, int j) const {
    const Vec3 foot(grid.shifted_u(i), grid.shifted_v(j), 0);
    const double low = grid.box().lower.z, high = grid.box().upper.z;
    // Signed distance of the ray from the plane at the height of `point`.
    const double off = glm::dot(Vec3(foot.x, foot.y, point.z) - point, normal);
    if (normal.z == 0) return off <= 0 ? Span{low, high} : Span{high, low};
    const double crossing = std::clamp(point.z - off / normal.z, low, high);
    return normal.z > 0 ? Span{low, crossing} : Span{crossing, high};
  }
};

void fill(Grid& grid, std::size_t tile, const HalfSpace& half) {
  const double low = grid.box().lower.z, high = grid.box().upper.z;
  const Vec3 along = to_world(grid.axis(), Vec3(0, 0, 1));
  const PackedNormal down = PackedNormal::pack(-along), up = PackedNormal::pack(along),
                     plane = PackedNormal::pack(to_world(grid.axis(), half.normal));
  grid.fill_tile(tile, [&](int i, int j, TileBuilder& builder) {
    const Span s = half.behind(i, j);
    if (s.near < s.far) builder.add(s, {s.near > low ? plane : down, s.far < high ? plane : up});
  });
}

}  // namespace

void clip(Volume& volume, const Vec3& point, const Vec3& normal, const Progress& progress) {
  base::require(geom::finite(point), "point", "must be finite");
  const double length = glm::length(normal);
  if (!geom::finite(normal) || !(length > 0) || !std::isfinite(length))
    throw std::invalid_argument("normal must be finite and not of length 0");
  Volume behind(volume.frame());
  for (Grid& grid : behind.grids()) {
    const HalfSpace half{grid, to_local(grid.axis(), point), to_local(grid.axis(), normal / length)};
    base::parallel_for(grid.tile_count(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) fill(grid, t, half);
    });
  }
  apply(Boolean::Intersect, volume, behind, progress);
}

}  // namespace riffler::dexel
