// Points that are equal but for rounding.
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Points in buckets of side `size`, each searched among its neighbours.
class NearPoints {
 public:
  NearPoints(double size, std::size_t points);

  /// The number of the first point within `size` of p; p itself, added, where there is none.
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

/// A few ulps of the largest coordinate: by that much rounding moves vertices that were one.
double rounding_of(const Mesh& mesh);

/// The mesh with vertices at its open edges joined that lie within `rounding_of(mesh)` of another one there without
/// being equal to it; nothing where there are none. Triangles keep their places; some may name a vertex twice.
std::optional<Mesh> join_near(const Mesh& mesh);

/// The mesh with vertices of equal coordinates as one, in the order of their first appearance, and then `join_near`.
Mesh welded(const Mesh& mesh);

}  // namespace riffler::mesh
