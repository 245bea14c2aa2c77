// Finds the steep face of a part that is nearest to a point, at the point's height.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::plan {

/// The triangles of a mesh with a slope of at least `kSteep`, in a tree.
class SteepFaces {
 public:
  static constexpr double kSteep = 1.25;  ///< slope from level, rad

  struct Found {
    int triangle = -1;  ///< index in the mesh; −1: none
    Vec3 point{0};      ///< nearest point of the triangle
  };

  explicit SteepFaces(const Mesh& mesh);

  /// Finds the face whose section at the height of `p` is nearest to `p`, within `reach` (mm). A face that ends at most
  /// `slack` (mm) above or below `p` counts with the section at its end. The section is the strip at most `band` (mm)
  /// above and below that height: at an edge that is not quite level, a face has a section without it at one end only.
  Found nearest(const Vec3& p, double reach, double slack, double band) const;

 private:
  struct Triangle {
    Vec3 a, b, c;
  };

  std::size_t levels_ = 0;
  std::vector<Box3> boxes_;
  std::vector<Triangle> triangles_;
  std::vector<int> numbers_;
};

}  // namespace riffler::plan
