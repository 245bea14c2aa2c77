// OpenMesh half-edges for a mesh that need not be a manifold.
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

/// Half-edges with the origin of their vertices. Triangles that name a vertex twice are left out. Two triangles are
/// joined across an edge if they are its only ones and run it in opposite directions; every other edge is a border. A
/// vertex whose triangles then form several fans has one copy per fan. All copies, and the ends of edges with three or
/// more triangles, are locked, so that the copies can be merged again.
struct HalfEdges {
  HalfEdgeMesh mesh;
  std::vector<int> source;  // vertex here → vertex of the original mesh
  // These two always describe the original mesh, even after collapses:
  Adjacency adjacency;
  std::vector<int> corner;  // vertex here at which each half-edge of `adjacency` starts; -1 for triangles left out

  explicit HalfEdges(const Mesh& from, const Progress& progress = {});
  /// The triangles that are not deleted and the vertices that they use, both in their old order. A vertex that has not
  /// moved since `start` gets its exact coordinates from `from`; the others are moved back by `centre`.
  Mesh to_mesh(const Mesh& from, const Mesh& start, const Vec3& centre) const;
};

}  // namespace riffler::mesh
