#include "mesh/decimate/near_surface.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::mesh {

Mesh mesh_of(const std::vector<Corners>& triangles) {
  Mesh mesh;
  for (const Corners& t : triangles) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), t.begin(), t.end());
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

NearSurface::NearSurface(const std::vector<Corners>& surface, double tolerance)
    : closest_(mesh_of(surface)), triangles_(surface), tolerance_(tolerance) {}

bool NearSurface::holds(const Corners& place, int most) const {
  std::vector<Piece> open(1);
  for (const Vec3& p : place) open[0].add(p);
  for (; !open.empty(); --most) {
    if (most <= 0) return false;
    Piece piece = open.back();
    open.pop_back();
    const Vec3 centre = piece.centre();
    double limit = tolerance_;
    if (piece.hint >= 0) limit = std::min(limit, closest_.distance_to(piece.hint, centre));
    // slightly enlarged, so that the search finds the hint itself again
    const Closest::Hit hit = closest_(centre, limit * (1 + 1e-12) + 1e-300);
    if (!(hit.distance <= tolerance_)) return false;
    piece.hint = hit.triangle;
    if (near_triangle(piece, hit.triangle) || cut_along(piece, hit.triangle, open)) continue;
    if (piece.halvings == kHalvings) return false;
    halve(piece, open);
  }
  return true;
}

Vec3 NearSurface::Piece::centre() const {
  Vec3 sum(0);
  for (int i = 0; i < corners; ++i) sum += point[i];
  return sum / static_cast<double>(corners);
}

bool NearSurface::near_triangle(const Piece& piece, int triangle) const {
  for (int i = 0; i < piece.corners; ++i)
    if (!(closest_.distance_to(triangle, piece.point[i]) <= tolerance_)) return false;
  return true;
}

bool NearSurface::has_width(const Piece& piece) const {
  Vec3 area(0);
  double longest = 0;
  for (int i = 1; i < piece.corners; ++i) {
    const Vec3 side = piece.point[i] - piece.point[0];
    longest = std::max(longest, glm::length(side));
    if (i > 1) area += glm::cross(piece.point[i - 1] - piece.point[0], side);
  }
  return piece.corners >= 3 && glm::length(area) > kGrain * tolerance_ * longest;
}

/// Cuts a piece by the plane through `at` across `unit`. Both parts get the corners on the plane.
void NearSurface::cut(const Piece& piece, const Vec3& at, const Vec3& unit, Piece& in, Piece& out) const {
  const double grain = kGrain * tolerance_;
  in.corners = out.corners = 0;
  const auto height_of = [&](int i) {
    const double height = glm::dot(unit, piece.point[i] - at);
    return std::abs(height) <= grain ? 0 : height;
  };
  double height = height_of(0);
  for (int i = 0; i < piece.corners; ++i) {
    const int j = i + 1 < piece.corners ? i + 1 : 0;
    const double next = height_of(j);
    if (height >= 0) in.add(piece.point[i]);
    if (height <= 0) out.add(piece.point[i]);
    if ((height < 0 && next > 0) || (height > 0 && next < 0)) {
      const Vec3 p = piece.point[i] + (height / (height - next)) * (piece.point[j] - piece.point[i]);
      in.add(p), out.add(p);
    }
    height = next;
  }
}

/// Whether the part of the piece over the triangle is near it; then the parts around it are still open.
bool NearSurface::cut_along(const Piece& piece, int triangle, std::vector<Piece>& open) const {
  const Corners& t = triangles_[triangle];
  const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  Piece inside = piece, in = piece, out = piece;
  Piece around[3];
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3 inward = glm::cross(normal, t[(k + 1) % 3] - t[k]);
    const double length = glm::length(inward);
    if (!(length > 0) || inside.corners + 2 > kCorners) return false;
    cut(inside, t[k], inward / length, in, out);
    if (!has_width(in)) return false;
    inside = in;
    if (has_width(out)) around[count++] = out;
  }
  if (!near_triangle(inside, triangle)) return false;
  open.insert(open.end(), around, around + count);
  return true;
}

/// Halves a piece across its longest diagonal.
void NearSurface::halve(const Piece& piece, std::vector<Piece>& open) const {
  int from = 0, to = 1;
  double longest = 0;
  for (int i = 0; i < piece.corners; ++i)
    for (int j = i + 1; j < piece.corners; ++j)
      if (const double length = glm::length(piece.point[j] - piece.point[i]); length > longest)
        longest = length, from = i, to = j;
  const Vec3 way = piece.point[to] - piece.point[from];
  Piece in = piece, out = piece;
  if (piece.corners + 2 <= kCorners) {
    cut(piece, piece.point[from] + 0.5 * way, way / longest, in, out);
  } else {  // too many corners to cut: along a diagonal
    const int half = piece.corners / 2;
    in.corners = out.corners = 0;
    for (int i = 0; i <= half; ++i) in.add(piece.point[i]);
    for (int i = half; i <= piece.corners; ++i) out.add(piece.point[i % piece.corners]);
  }
  for (Piece* part : {&in, &out}) {
    ++part->halvings;
    if (has_width(*part)) open.push_back(*part);
  }
}

}  // namespace riffler::mesh
