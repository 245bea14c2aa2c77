// Volumes filled ray by ray: from solids whose rays are computed exactly, or from a function.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "stress/random.hpp"

namespace riffler::stress {

/// A span with its true normals, along a line p + s d.
struct SolidSpan {
  double near, far;
  Vec3 near_normal, far_normal;
};
using SolidSpans = std::vector<SolidSpan>;
/// A solid as a function from a line (origin, unit direction) to its sorted, disjoint spans on the line.
using Solid = std::function<SolidSpans(const Vec3&, const Vec3&)>;

constexpr double kFarAway = 1e9;

/// The half-space n·p ≤ c.
inline Solid half_space(const Vec3& n, double c) {
  return [n, c](const Vec3& p, const Vec3& d) -> SolidSpans {
    const double slope = glm::dot(n, d), at = c - glm::dot(n, p);
    if (slope > 0) return {{-kFarAway, at / slope, -n, n}};
    if (slope < 0) return {{at / slope, kFarAway, n, -n}};
    if (at >= 0) return {{-kFarAway, kFarAway, -d, d}};
    return {};
  };
}

inline Solid sphere(const Vec3& centre, double radius) {
  return [centre, radius](const Vec3& p, const Vec3& d) -> SolidSpans {
    const double middle = glm::dot(centre - p, d);
    const Vec3 off = p + middle * d - centre;
    const double rest = radius * radius - glm::dot(off, off);
    if (rest <= 0) return {};
    const double half = std::sqrt(rest);
    return {{middle - half, middle + half, (off - half * d) / radius, (off + half * d) / radius}};
  };
}

/// Combines two solids by a rule on (inside a, inside b).
inline Solid combine(const Solid& a, const Solid& b, std::function<bool(bool, bool)> rule) {
  return [=](const Vec3& p, const Vec3& d) {
    const SolidSpans cut[2] = {a(p, d), b(p, d)};
    struct Event {
      double at;
      int who;
      bool in;
      Vec3 normal;
    };
    std::vector<Event> events;
    for (int w = 0; w < 2; ++w)
      for (const SolidSpan& c : cut[w])
        events.push_back({c.near, w, true, c.near_normal}), events.push_back({c.far, w, false, c.far_normal});
    std::stable_sort(events.begin(), events.end(), [](const Event& x, const Event& y) { return x.at < y.at; });
    SolidSpans out;
    bool in[2] = {false, false}, now = false;
    for (const Event& e : events) {
      in[e.who] = e.in;
      const bool next = rule(in[0], in[1]);
      if (next == now) continue;
      now = next;
      // The normals of a subtracted solid are reversed.
      const bool turned = next != e.in;
      const Vec3 normal = turned ? -e.normal : e.normal;
      if (next)
        out.push_back({e.at, e.at, normal, normal});
      else
        out.back().far = e.at, out.back().far_normal = normal;
    }
    std::erase_if(out, [](const SolidSpan& c) { return !(c.far > c.near); });
    return out;
  };
}
inline Solid unite(const Solid& a, const Solid& b) {
  return combine(a, b, [](bool x, bool y) { return x || y; });
}
inline Solid meet(const Solid& a, const Solid& b) {
  return combine(a, b, [](bool x, bool y) { return x && y; });
}
inline Solid subtract(const Solid& a, const Solid& b) {
  return combine(a, b, [](bool x, bool y) { return x && !y; });
}

/// A box with half sides `half` about `centre`; its axes are the columns of `turn`.
inline Solid turned_box(const Vec3& centre, const Vec3& half, const Mat3& turn) {
  Solid box;
  for (int a = 0; a < 3; ++a)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 n = side * turn[a];
      const Solid h = half_space(n, glm::dot(n, centre) + half[a]);
      box = box ? meet(box, h) : h;
    }
  return box;
}
inline Solid box(const Vec3& lower, const Vec3& upper) {
  return turned_box((lower + upper) / 2.0, (upper - lower) / 2.0, Mat3(1.0));
}

/// A random rotation.
inline Mat3 random_turn(Random& random) {
  const Vec3 a = random.direction(), b = random.square_to(a);
  return Mat3(a, b, glm::cross(a, b));
}

inline dexel::SpanNormals packed(const SolidSpan& c) {
  return {dexel::PackedNormal::pack(c.near_normal), dexel::PackedNormal::pack(c.far_normal)};
}

/// Fills every grid of a volume: cuts(grid, i, j) returns the spans of a ray, in absolute coordinates along it; clips
/// them to the box.
inline void fill(Volume& volume, const std::function<SolidSpans(const dexel::Grid&, int, int)>& cuts) {
  for (dexel::Grid& grid : volume.grids())
    for (std::size_t t = 0; t < grid.tile_count(); ++t)
      grid.fill_tile(t, [&](int i, int j, dexel::TileBuilder& builder) {
        for (const SolidSpan& c : cuts(grid, i, j)) {
          // Clip to the box to the last bit, which a solid's own arithmetic may exceed.
          const dexel::Span span{std::max(c.near, grid.box().lower.z), std::min(c.far, grid.box().upper.z)};
          if (span.near < span.far) builder.add(span, packed(c));
        }
      });
  volume.touch();
}

/// The part of a solid within the volume's box.
inline Volume solid_volume(const dexel::Frame& frame, const Solid& solid) {
  Volume volume(frame);
  const Solid clipped = meet(solid, box(frame.box.lower, frame.box.upper));
  fill(volume, [&](const dexel::Grid& grid, int i, int j) {
    const Vec3 p = to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), 0)), d = to_world(grid.axis(), Vec3(0, 0, 1));
    return clipped(p, d);
  });
  return volume;
}

/// Replaces the rays i0 … i1 × j0 … j1 of a grid.
inline void change_rays(dexel::Grid& grid, int i0, int i1, int j0, int j1, const std::function<SolidSpans()>& cuts) {
  for (int a = i0 / dexel::kTileSide; a <= i1 / dexel::kTileSide; ++a)
    for (int b = j0 / dexel::kTileSide; b <= j1 / dexel::kTileSide; ++b) {
      const auto old = grid.shared_tile(grid.tile_index(a, b));
      grid.fill_tile(grid.tile_index(a, b), [&](int i, int j, dexel::TileBuilder& builder) {
        const int r = dexel::Grid::ray_index(i, j);
        if (i >= i0 && i <= i1 && j >= j0 && j <= j1)
          for (const SolidSpan& c : cuts()) builder.add({c.near, c.far}, packed(c));
        else
          for (std::size_t n = 0; n < old->ray(r).size(); ++n)
            builder.add(old->ray(r)[n], old->normals.empty() ? dexel::SpanNormals{} : old->ray_normals(r)[n]);
      });
    }
}

}  // namespace riffler::stress
