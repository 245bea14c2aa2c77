// Volumes for the mesher's tests, filled ray by ray from exact solids or from random numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "dexel/volume.hpp"

namespace riffler::testing {

/// A span with its true normals, along a line p + s d.
struct Cut {
  double near, far;
  Vec3 near_normal, far_normal;
};
using Cuts = std::vector<Cut>;
/// Where a solid meets a line: origin, direction (unit) → sorted, disjoint cuts.
using Solid = std::function<Cuts(const Vec3&, const Vec3&)>;

constexpr double kFarAway = 1e9;

/// The half-space n·p ≤ c.
inline Solid half_space(const Vec3& n, double c) {
  return [n, c](const Vec3& p, const Vec3& d) -> Cuts {
    const double slope = glm::dot(n, d), at = c - glm::dot(n, p);
    if (slope > 0) return {{-kFarAway, at / slope, -n, n}};
    if (slope < 0) return {{at / slope, kFarAway, n, -n}};
    if (at >= 0) return {{-kFarAway, kFarAway, -d, d}};
    return {};
  };
}

inline Solid sphere(const Vec3& centre, double radius) {
  return [centre, radius](const Vec3& p, const Vec3& d) -> Cuts {
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
    const Cuts cut[2] = {a(p, d), b(p, d)};
    struct Event {
      double at;
      int who;
      bool in;
      Vec3 normal;
    };
    std::vector<Event> events;
    for (int w = 0; w < 2; ++w)
      for (const Cut& c : cut[w])
        events.push_back({c.near, w, true, c.near_normal}), events.push_back({c.far, w, false, c.far_normal});
    std::stable_sort(events.begin(), events.end(), [](const Event& x, const Event& y) { return x.at < y.at; });
    Cuts out;
    bool in[2] = {false, false}, now = false;
    for (const Event& e : events) {
      in[e.who] = e.in;
      const bool next = rule(in[0], in[1]);
      if (next == now) continue;
      now = next;
      // A solid that is taken away turns its normal.
      const bool turned = next != e.in;
      const Vec3 normal = turned ? -e.normal : e.normal;
      if (next)
        out.push_back({e.at, e.at, normal, normal});
      else
        out.back().far = e.at, out.back().far_normal = normal;
    }
    std::erase_if(out, [](const Cut& c) { return !(c.far > c.near); });
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

/// A box of half sides `half` about `centre`, its axes the columns of `turn`.
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

/// Fills every grid of a volume: cuts(axis, i, j) gives each ray's, absolute along the ray.
inline void fill(Volume& volume, const std::function<Cuts(const Grid&, int, int)>& cuts) {
  for (Grid& grid : volume.grids())
    for (int a = 0; a < grid.tiles_u(); ++a)
      for (int b = 0; b < grid.tiles_v(); ++b) {
        TileBuilder builder(grid.has_normals());
        for (int r = 0; r < kTileRays; ++r) {
          const int i = a * kTileSide + r / kTileSide, j = b * kTileSide + r % kTileSide;
          if (i < grid.nu() && j < grid.nv())
            for (const Cut& c : cuts(grid, i, j))
              builder.add({c.near, c.far}, {PackedNormal::pack(c.near_normal), PackedNormal::pack(c.far_normal)});
          builder.next_ray();
        }
        grid.set_tile(grid.tile_index(a, b), builder.finish());
      }
  volume.touch();
}

/// The part of a solid within the volume's box.
inline Volume solid_volume(const Frame& frame, const Solid& solid) {
  Volume volume(frame);
  const Solid clipped = meet(solid, box(frame.box.lower, frame.box.upper));
  fill(volume, [&](const Grid& grid, int i, int j) {
    const Vec3 p = to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), 0)), d = to_world(grid.axis(), Vec3(0, 0, 1));
    return clipped(p, d);
  });
  return volume;
}

/// Reproducible numbers, the same with every standard library.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double real(double from, double to) { return from + (to - from) * (static_cast<double>(engine_()) * 0x1p-32); }
  int whole(int from, int to) { return from + static_cast<int>(engine_() % static_cast<unsigned>(to - from + 1)); }
  bool chance(double p) { return real(0, 1) < p; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v{real(-1, 1), real(-1, 1), real(-1, 1)};
      const double length = glm::length(v);
      if (length > 0.1 && length < 1) return v / length;
    }
  }
  Mat3 turn() {
    const Vec3 a = direction();
    Vec3 b = direction();
    while (std::abs(glm::dot(a, b)) > 0.9) b = direction();
    const Vec3 c = glm::normalize(glm::cross(a, b));
    return Mat3(a, glm::cross(c, a), c);
  }

 private:
  std::mt19937 engine_;
};

/// Spans that know nothing of each other: ends anywhere, often on lattice planes or box faces, also outside the box.
inline Cuts wild_cuts(Dice& dice, const Grid& grid, double fill, bool random_normals) {
  const double h = grid.pitch(), low = grid.box().lower.z, high = grid.box().upper.z;
  std::vector<double> ends;
  for (int n = dice.chance(fill) ? dice.whole(1, 4) : 0; n > 0; --n)
    for (int e = 0; e < 2; ++e) {
      double at = dice.real(low - h, high + h);
      if (dice.chance(0.3)) at = low + std::round((at - low) / (h / 2)) * (h / 2);
      if (dice.chance(0.1)) at += dice.real(-2e-3, 2e-3) * h;
      ends.push_back(at);
    }
  std::sort(ends.begin(), ends.end());
  const Vec3 along = to_world(grid.axis(), Vec3(0, 0, 1));
  Cuts cuts;
  for (std::size_t n = 0; n + 1 < ends.size(); n += 2) {
    if (!(ends[n] < ends[n + 1])) continue;
    cuts.push_back(
        {ends[n], ends[n + 1], random_normals ? dice.direction() : -along, random_normals ? dice.direction() : along});
  }
  return cuts;
}

/// Replaces the rays i0 … i1 × j0 … j1 of a grid.
inline void change_rays(Grid& grid, int i0, int i1, int j0, int j1, const std::function<Cuts()>& cuts) {
  for (int a = i0 / kTileSide; a <= i1 / kTileSide; ++a)
    for (int b = j0 / kTileSide; b <= j1 / kTileSide; ++b) {
      const Tile& old = grid.tile(grid.tile_index(a, b));
      TileBuilder builder(grid.has_normals());
      for (int r = 0; r < kTileRays; ++r) {
        const int i = a * kTileSide + r / kTileSide, j = b * kTileSide + r % kTileSide;
        if (i >= i0 && i <= i1 && j >= j0 && j <= j1)
          for (const Cut& c : cuts())
            builder.add({c.near, c.far}, {PackedNormal::pack(c.near_normal), PackedNormal::pack(c.far_normal)});
        else
          for (std::size_t n = 0; n < old.ray(r).size(); ++n)
            builder.add(old.ray(r)[n], old.normals.empty() ? SpanNormals{} : old.ray_normals(r)[n]);
        builder.next_ray();
      }
      grid.set_tile(grid.tile_index(a, b), builder.finish());
    }
}

}  // namespace riffler::testing
