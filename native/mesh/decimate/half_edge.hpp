// OpenMesh half-edges of a mesh that need not be a manifold.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <vector>

#include "mesh/adjacency.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

struct HalfEdgeTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::None);
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<HalfEdgeTraits>;

inline Vec3 to_vec3(const OpenMesh::Vec3d& p) {
  return {p[0], p[1], p[2]};
}
inline OpenMesh::Vec3d to_openmesh(const Vec3& p) {
  return {p.x, p.y, p.z};
}

/// Half-edges, and where their vertices come from. Triangles that name a vertex twice are left out. Triangles are
/// joined across edges of two that run it in opposite directions; every other edge is a border. A vertex whose
/// triangles then make several fans stands here once for each, and all its copies and the ends of crowded edges are
/// locked, so that the copies can be made one vertex again.
struct HalfEdges {
  HalfEdgeMesh mesh;
  std::vector<int> source;  // vertex here → vertex of the mesh it was made of
  // Of the mesh as it was, whatever happens to the half-edges:
  Adjacency adjacency;
  std::vector<int> corner;  // vertex here at which each half-edge of `adjacency` starts, -1 for triangles left out

  explicit HalfEdges(const Mesh& from, const Progress& progress = {});
  /// Triangles that are not deleted, in their old order, with the vertices that they use, in their old order: as in
  /// `from` where they are still where they were in `start`, else about `centre`.
  Mesh to_mesh(const Mesh& from, const Mesh& start, const Vec3& centre) const;
};

}  // namespace riffler::mesh
