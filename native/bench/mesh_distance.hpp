// Distance of points from a mesh, as a reference for meshes: examines every triangle in the nearby cells of a grid.
// Shares no code with native/mesh.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::bench {

class MeshDistance {
 public:
  /// Keeps a reference to the mesh. Throws std::invalid_argument for a mesh without triangles.
  explicit MeshDistance(const Mesh& mesh);

  /// Distance from `p` to the nearest triangle, mm; meant for points that are close to the mesh.
  double operator()(const Vec3& p) const;
  std::vector<double> operator()(std::span<const Vec3> points) const;

 private:
  Vec3i cell_of(const Vec3& p) const;
  void insert(int triangle, const Vec3& a, const Vec3& b, const Vec3& c);
  /// The smallest squared distance to the triangles of one cell, at most `least`.
  double in_cell(const Vec3i& cell, const Vec3& p, double least) const;

  const Mesh& mesh_;
  Vec3 origin_;
  double side_;   // of a cell
  Vec3i counts_;  // cells per axis
  std::unordered_map<std::size_t, std::vector<int>> cells_;
};

/// Squared distance from `p` to the triangle a b c.
double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace riffler::bench
