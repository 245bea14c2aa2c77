// Convex solids as volumes whose ends are exact, from closed forms.
#pragma once

#include <vector>

#include "riffler/dexel/volume.hpp"

namespace riffler::test {

/// Where normal · x ≤ offset.
struct HalfSpace {
  Vec3 normal;
  double offset;

  static HalfSpace at(const Vec3& place, const Vec3& normal) {
    const Vec3 n = glm::normalize(normal);
    return {n, glm::dot(n, place)};
  }
};

/// Both ends of a ray in a solid, with the surface's normals there.
struct Piece {
  Interval inside{-1e300, 1e300};
  Vec3 near_normal{0}, far_normal{0};

  void cut(const Interval& other, const Vec3& near, const Vec3& far) {
    if (other.near > inside.near) inside.near = other.near, near_normal = near;
    if (other.far < inside.far) inside.far = other.far, far_normal = far;
  }
  void cut(const HalfSpace& h, const Vec3& start, const Vec3& along) {
    const double slope = glm::dot(h.normal, along), rest = h.offset - glm::dot(h.normal, start);
    if (slope > 0) {
      cut({-1e300, rest / slope}, {}, h.normal);
    } else if (slope < 0) {
      cut({rest / slope, 1e300}, h.normal, {});
    } else if (rest < 0) {
      inside = {};
    }
  }
};

/// A volume of one piece a ray: piece(start, along) in the world frame, cut by the box.
template <class F>
Volume solid(const dexel::Frame& frame, const F& piece) {
  Volume volume(frame);
  for (dexel::Grid& grid : volume.grids())
    for (std::size_t t = 0; t < grid.tile_count(); ++t)
      grid.fill_tile(t, [&](int i, int j, dexel::TileBuilder& builder) {
        const Vec3 along = to_world(grid.axis(), {0, 0, 1});
        const double w0 = grid.box().lower.z;
        Piece p = piece(to_world(grid.axis(), {grid.u(i), grid.v(j), w0}), along);
        p.inside = {p.inside.near + w0, p.inside.far + w0};
        p.cut({grid.box().lower.z, grid.box().upper.z}, -along, along);
        if (p.inside.near < p.inside.far)
          builder.add({p.inside.near, p.inside.far},
                      {dexel::PackedNormal::pack(p.near_normal), dexel::PackedNormal::pack(p.far_normal)});
      });
  volume.touch();
  return volume;
}

inline Volume convex(const dexel::Frame& frame, const std::vector<HalfSpace>& sides) {
  return solid(frame, [&](const Vec3& start, const Vec3& along) {
    Piece p;
    for (const HalfSpace& side : sides) p.cut(side, start, along);
    return p;
  });
}

inline Volume ball(const dexel::Frame& frame, const Vec3& centre, double radius) {
  return solid(frame, [&](const Vec3& start, const Vec3& along) {
    const Vec3 r = start - centre;
    const double b = glm::dot(r, along), d = b * b - glm::dot(r, r) + radius * radius;
    Piece p;
    if (d <= 0) return p.inside = {}, p;
    const Interval inside{-b - std::sqrt(d), -b + std::sqrt(d)};
    p.cut(inside, (r + inside.near * along) / radius, (r + inside.far * along) / radius);
    return p;
  });
}

}  // namespace riffler::test
