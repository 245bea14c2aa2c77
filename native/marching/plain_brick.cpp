#include "marching/plain_brick.hpp"

#include <algorithm>

#include "base/sort_unique.hpp"

namespace riffler::marching {

namespace {

std::uint32_t number(int u, int v) {
  return static_cast<std::uint32_t>(kBrickSide * u + v);
}

/// Four fans: each quarter's centre with the square's own border, and one long edge along each of the two lines that
/// separate the quarters.
FlatSquare four_fans() {
  constexpr int kEnd = kPlainLast - 1, kMiddle = 15;
  FlatSquare out;
  for (const int u0 : {0, kMiddle})
    for (const int v0 : {0, kMiddle}) {
      const int u1 = u0 + kMiddle, v1 = v0 + kMiddle;
      std::vector<std::uint32_t> rim;
      const auto add = [&](int u, int v) {
        const bool border = u == 0 || v == 0 || u == kEnd || v == kEnd, corner = u % kMiddle == 0 && v % kMiddle == 0;
        if (border || corner) rim.push_back(number(u, v));
      };
      for (int u = u0; u < u1; ++u) add(u, v0);
      for (int v = v0; v < v1; ++v) add(u1, v);
      for (int u = u1; u > u0; --u) add(u, v1);
      for (int v = v1; v > v0; --v) add(u0, v);
      const std::uint32_t centre = number(u0 + kMiddle / 2, v0 + kMiddle / 2);
      for (std::size_t n = 0; n < rim.size(); ++n) out.triangles.push_back({centre, rim[n], rim[(n + 1) % rim.size()]});
      out.vertices.push_back(centre);
      out.vertices.insert(out.vertices.end(), rim.begin(), rim.end());
    }
  base::sort_unique(out.vertices);
  return out;
}

}  // namespace

const FlatSquare& flat_square() {
  static const FlatSquare square = four_fans();
  return square;
}

void make_rest(Surface& surface, ActiveBrick& brick) {
  if (!brick.hollow) return;
  brick.hollow = false;
  const PlainFace& face = *brick.plain;
  const int first = face.axis == 0 ? 1 : 0, second = face.axis == 2 ? 1 : 2;
  Vec3i origin = brick.at * kBrickSide;
  origin[face.axis] += face.layer;
  const auto at = [&](int u, int v) {
    Vec3i out = origin;
    out[first] += u, out[second] += v;
    return out;
  };
  Vec3 middle(0.5);
  // The mean as CycleSums rounds it.
  middle[face.axis] = (((face.place + face.place) + face.place) + face.place) * 0.25;
  for (int u = 0; u < kBrickSide; ++u)
    for (int v = 0; v < kBrickSide; ++v) {
      if (has_hollow_vertex(u, v)) continue;
      const std::size_t vertex = brick.first_vertex + number(u, v);
      surface.mesh.vertices[vertex] = surface.grid.inside(at(u, v), middle);
      surface.marks[vertex] = 0;
    }
  HitFinder finder = surface.hits;
  for (int u = 0; u < kBrickSide; ++u)
    for (int v = 0; v < kBrickSide; ++v) {
      if (has_hollow_quad(u, v)) continue;
      const Vec3i from = at(u, v);
      const QuadRef ref{static_cast<std::uint32_t>(brick.first_edge + number(u, v)),
                        {face.axis, from.x, from.y, from.z, face.rising}};
      std::array<std::int32_t, 4> corners;
      for (int n = 0; n < 4; ++n) {
        const Vec3i off = corner_cell(ref.edge, n) - origin;
        corners[n] = static_cast<std::int32_t>(brick.first_vertex + number(off[first], off[second]));
      }
      surface.write(ref.quad, corners, 0);
      surface.split(ref, finder);
    }
}

void make_rest_near(Surface& surface, const std::vector<CellVertex>& cells) {
  std::vector<std::size_t> found;
  for (const CellVertex& v : cells) found.push_back(surface.bricks.index_of(v.cell));
  base::sort_unique(found);
  for (const std::size_t n : found) {
    const Vec3i at = surface.bricks.place(n);
    for (int i = at.x - 1; i <= at.x + 1; ++i)
      for (int j = at.y - 1; j <= at.y + 1; ++j)
        for (int k = at.z - 1; k <= at.z + 1; ++k)
          if (surface.bricks.active(i, j, k)) make_rest(surface, *surface.bricks.active(surface.bricks.index(i, j, k)));
  }
}

}  // namespace riffler::marching
