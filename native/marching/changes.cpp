#include "marching/changes.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::marching {

namespace {

/// One end of a span.
struct End {
  double place;
  dexel::PackedNormal normal;
  bool operator==(const End&) const = default;
};

End end_of(const dexel::Tile& tile, int ray, std::size_t n) {
  const dexel::Span& span = tile.ray(ray)[n / 2];
  const auto normals = tile.ray_normals(ray);
  const bool far = n % 2;
  const dexel::PackedNormal normal = normals.empty() ? dexel::PackedNormal{}
                                     : far           ? normals[n / 2].far
                                                     : normals[n / 2].near;
  return {far ? span.far : span.near, normal};
}

/// The interval between the first and last end that two states of a ray do not share; empty if they are equal.
Interval difference(const dexel::Tile& a, const dexel::Tile& b, int ray) {
  const std::size_t na = 2 * a.ray(ray).size(), nb = 2 * b.ray(ray).size();
  std::size_t first = 0, last = 0;
  while (first < na && first < nb && end_of(a, ray, first) == end_of(b, ray, first)) ++first;
  while (first + last < na && first + last < nb && end_of(a, ray, na - 1 - last) == end_of(b, ray, nb - 1 - last))
    ++last;
  Interval out;
  for (std::size_t n = first; n < na - last; ++n) out.include(end_of(a, ray, n).place);
  for (std::size_t n = first; n < nb - last; ++n) out.include(end_of(b, ray, n).place);
  return out;
}

class Marker {
 public:
  Marker(const Lattice& lattice, const Bricks& bricks, Changes& out) : lattice_(lattice), bricks_(bricks), out_(out) {}

  /// Marks the bricks of the points from `first` to `last`.
  void mark(const Vec3i& first, const Vec3i& last) {
    mark(first, last, out_.signs, out_.sign_bricks);
    // A vertex depends on the signs of its cell and, to resolve an ambiguous face, of the next cell; a hit depends on
    // an end up to half a pitch beyond its edge. A brick's quads have corners in the layer of cells below it.
    mark(first - Vec3i(kReach), last + Vec3i(kReach), out_.meshes, out_.mesh_bricks);
  }

  /// Marks the changed part of a ray (u, v) along a lattice axis.
  void mark_ray(int axis, int u, int v, const Interval& part) {
    Vec3i first{0}, last{0};
    first[axis] = point(axis, std::floor((part.near - lattice_.at(axis, 0)) / lattice_.pitch()));
    last[axis] = point(axis, std::ceil((part.far - lattice_.at(axis, 0)) / lattice_.pitch()));
    first[(axis + 1) % 3] = last[(axis + 1) % 3] = u + 1;
    first[(axis + 2) % 3] = last[(axis + 2) % 3] = v + 1;
    mark(first, last);
  }

 private:
  static constexpr int kReach = 3;

  int point(int axis, double x) const {
    return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(lattice_.points(axis) - 1)));
  }

  void mark(const Vec3i& first, const Vec3i& last, std::vector<bool>& marks, std::vector<std::size_t>& list) {
    int from[3], to[3];
    for (int a = 0; a < 3; ++a) {
      from[a] = std::max(first[a], 0) / kBrickSide;
      to[a] = std::min(last[a] / kBrickSide, bricks_.count(a) - 1);
    }
    for (int a = from[0]; a <= to[0]; ++a)
      for (int b = from[1]; b <= to[1]; ++b)
        for (int c = from[2]; c <= to[2]; ++c) {
          const std::size_t n = bricks_.index(a, b, c);
          if (!marks[n]) list.push_back(n);
          marks[n] = true;
        }
  }

  const Lattice& lattice_;
  const Bricks& bricks_;
  Changes& out_;
};

}  // namespace

Changes changes_between(const Volume& before, const Volume& after, const Lattice& lattice, const Bricks& bricks) {
  Changes changes(bricks.size());
  Marker marker(lattice, bricks, changes);
  for (std::size_t g = 0; g < after.grids().size(); ++g) {
    const dexel::Grid &a = before.grids()[g], &b = after.grids()[g];
    // A grid of one direction lies along the lattice's third axis.
    const int axis = after.grids().size() == 3 ? static_cast<int>(b.axis()) : 2;
    for (std::size_t t = 0; t < b.tile_count(); ++t) {
      if (a.shared_tile(t) == b.shared_tile(t)) continue;
      const int u = static_cast<int>(t) / b.tiles_v() * dexel::kTileSide,
                v = static_cast<int>(t) % b.tiles_v() * dexel::kTileSide;
      for (int r = 0; r < dexel::kTileRays; ++r)
        if (const Interval part = difference(a.tile(t), b.tile(t), r); !part.empty())
          marker.mark_ray(axis, u + r / dexel::kTileSide, v + r % dexel::kTileSide, part);
    }
  }
  std::sort(changes.sign_bricks.begin(), changes.sign_bricks.end());
  std::sort(changes.mesh_bricks.begin(), changes.mesh_bricks.end());
  return changes;
}

}  // namespace riffler::marching
