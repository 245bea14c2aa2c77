// Finds the nearest one of a part's steep faces at one height.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::plan {

/// The triangles of a mesh that are at least `kSteep` from level, in a tree.
class SteepFaces {
 public:
  static constexpr double kSteep = 1.25;  ///< rad

  struct Found {
    int triangle = -1;  ///< of the mesh; −1: none
    Vec3 point{0};      ///< of it
  };

  explicit SteepFaces(const Mesh& mesh);

  /// The face whose section at the height of `p` is nearest to `p`, if it is within `reach` (mm). A face that ends less
  /// than `slack` (mm) above or below counts with its end.
  Found nearest(const Vec3& p, double reach, double slack) const;

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
