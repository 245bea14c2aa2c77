// Normals that vary smoothly over a faceted surface, except across its sharp edges.
#pragma once

#include <array>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Normals at the corners of triangles: the mean over the triangles around the vertex whose normals lie within `crease`
/// of the triangle's own. Each is weighted by its angle at the vertex, so the result does not depend on how a face is
/// split into triangles (Thürmer & Wüthrich, Journal of Graphics Tools 3 (1998) 43).
class SmoothNormals {
 public:
  /// Does not refer to the mesh afterwards; the mesh must be valid. `crease` in rad.
  SmoothNormals(const Mesh& mesh, double crease);

  /// Unit normal at a point of triangle `t`, interpolated between its corners. A triangle without area takes it from
  /// the triangles around it.
  Vec3 at(int t, const Vec3& p) const;

 private:
  struct Corners {
    std::array<Vec3, 3> points, normals;
  };
  std::vector<Corners> corners_;
};

}  // namespace riffler::mesh
