// Distance of points from a mesh, as a reference for meshes: a tree of boxes over the triangles. Shares no code with
// native/mesh.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::bench {

class MeshDistance {
 public:
  /// Copies the triangles. Throws std::invalid_argument for a mesh without triangles.
  explicit MeshDistance(const Mesh& mesh);

  /// Distance from `p` to the nearest triangle, mm. If that is at most `enough`, returns any distance between it and
  /// `enough`: for the largest distance of many points, `enough` is the largest so far. `near`: where given, the
  /// triangle that is tried first, and becomes the nearest one found; at the start 0.
  double operator()(const Vec3& p, double enough = 0, int* near = nullptr) const;
  std::vector<double> operator()(std::span<const Vec3> points) const;

  /// The largest distance of any of `points`, mm; 0 without points. Much faster than all their distances where points
  /// that follow each other are near each other.
  double farthest(std::span<const Vec3> points) const;

 private:
  struct Corners {
    Vec3 a, b, c, normal;  // not normalised
  };
  /// Children: the next node and `other`; a leaf has triangles from `first` on, and no `other`.
  struct Node {
    Box3 box;
    int other, first, count;
  };
  int build(std::vector<Corners>::iterator begin, std::vector<Corners>::iterator end);

  std::vector<Corners> triangles_;  // in the order of the leaves
  std::vector<Node> nodes_;
};

/// Squared distance from `p` to the triangle a b c.
double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace riffler::bench
