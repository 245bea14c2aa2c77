// Normals that vary smoothly over a faceted surface, but not over its edges.
#pragma once

#include <array>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Normals at triangles' corners: means of the triangles round the vertex whose normals lie within `crease` of the
/// triangle's own, weighted by their angles there, so that they do not depend on how a face is cut into triangles
/// (Thürmer & Wüthrich, Journal of Graphics Tools 3 (1998) 43).
class SmoothNormals {
 public:
  /// Keeps what it needs of the mesh, which must be valid. `crease` in rad.
  SmoothNormals(const Mesh& mesh, double crease);

  /// Unit normal at a point of triangle `t`, between those of its corners; that of the nearest face with an area where
  /// the triangle has none.
  Vec3 at(int t, const Vec3& p) const;

 private:
  struct Corners {
    std::array<Vec3, 3> points, normals;
  };
  std::vector<Corners> corners_;
};

}  // namespace riffler::mesh
