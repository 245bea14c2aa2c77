// Finds points that are equal except for rounding.
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Points in buckets of side `size`; a search looks at the neighbouring buckets.
class NearPoints {
 public:
  NearPoints(double size, std::size_t points);

  /// The number of the first point within `size` of p. If there is none, adds p and returns its number.
  int find_or_add(const Vec3& p);
  const Vec3& operator[](int number) const { return points_[static_cast<std::size_t>(number)].p; }

 private:
  struct Point {
    Vec3 p, cell;
    int next;
  };
  std::size_t slot(const Vec3& cell) const;

  double size_;
  std::vector<int> heads_;
  std::vector<Point> points_;
};

/// A few ulps of the largest coordinate, mm: the distance by which rounding may separate equal vertices.
double rounding_of(const Mesh& mesh);

/// Joins vertices at open edges that lie within `rounding_of(mesh)` of each other but are not equal. Returns nothing if
/// there are none. Triangles keep their indices; some may name a vertex twice.
std::optional<Mesh> join_near(const Mesh& mesh);

/// Merges vertices with equal coordinates, in the order of their first appearance, then applies `join_near`.
Mesh welded(const Mesh& mesh);

}  // namespace riffler::mesh
