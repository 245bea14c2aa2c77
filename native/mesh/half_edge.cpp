// OpenMesh makes room for a point by copying one that has no value yet, which GCC sees under the sanitizers' options.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include "mesh/half_edge.hpp"

namespace riffler {

namespace {

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Numbers the fans of all vertices: the fan of each corner, and the vertex of each fan.
void number_fans(const Mesh& mesh, const Adjacency& adjacency, std::vector<int>& fan, std::vector<int>& vertex) {
  const int n = static_cast<int>(3 * mesh.triangles.size());
  fan.assign(static_cast<std::size_t>(n), -1);
  for (int corner = 0; corner < n; ++corner) {
    if (fan[corner] >= 0 || repeats_a_vertex(mesh.triangles[corner / 3])) continue;
    const int here = static_cast<int>(vertex.size());
    vertex.push_back(start_of(mesh, corner));
    // Round the vertex one way, and if there is a border, from the start the other way.
    int at = corner;
    do {
      fan[at] = here;
      at = adjacency.twin(previous_half(at));
    } while (at >= 0 && at != corner);
    for (int twin = adjacency.twin(corner); at < 0 && twin >= 0; twin = adjacency.twin(next_half(twin)))
      fan[next_half(twin)] = here;
  }
}

}  // namespace

HalfEdges::HalfEdges(const Mesh& from) : adjacency(from) {
  number_fans(from, adjacency, corner, source);
  const int halves = static_cast<int>(corner.size());
  mesh.reserve(source.size(), static_cast<std::size_t>(halves) / 2 + 1, from.triangles.size());
  std::vector<int> copies(from.vertices.size(), 0);
  for (const int v : source) ++copies[v], mesh.add_vertex(to_openmesh(from.vertices[v]));

  // The connectivity is known, so it is set directly: OpenMesh's add_face would search for it again, and depends on the
  // order of the faces.
  std::vector<HalfedgeHandle> handle(halves), out_border(source.size());
  const auto end_corner = [&](int half) { return corner[next_half(half)]; };
  for (int half = 0; half < halves; ++half) {
    if (corner[half] < 0 || handle[half].is_valid()) continue;
    handle[half] = mesh.new_edge(VertexHandle(corner[half]), VertexHandle(end_corner(half)));
    const HalfedgeHandle opposite = mesh.opposite_halfedge_handle(handle[half]);
    if (const int twin = adjacency.twin(half); twin >= 0) {
      handle[twin] = opposite;
    } else {
      out_border[end_corner(half)] = opposite;
      const bool open = adjacency.is_open(half);
      for (const int v : {corner[half], end_corner(half)})
        if (!open) mesh.status(VertexHandle(v)).set_locked(true);
    }
  }
  for (int half = 0; half < halves; ++half) {
    if (corner[half] < 0) continue;
    mesh.set_next_halfedge_handle(handle[half], handle[next_half(half)]);
    mesh.set_halfedge_handle(VertexHandle(corner[half]), handle[half]);
    if (half % 3 == 0) {
      const OpenMesh::FaceHandle face = mesh.new_face();
      mesh.set_halfedge_handle(face, handle[half]);
      for (int k = 0; k < 3; ++k) mesh.set_face_handle(handle[half + k], face);
    }
  }
  for (std::size_t v = 0; v < source.size(); ++v) {
    if (copies[source[v]] > 1) mesh.status(VertexHandle(static_cast<int>(v))).set_locked(true);
    if (!out_border[v].is_valid()) continue;
    // OpenMesh wants a border vertex to name its outgoing border half-edge; every fan has just one.
    mesh.set_halfedge_handle(VertexHandle(static_cast<int>(v)), out_border[v]);
    mesh.set_next_halfedge_handle(out_border[v], out_border[mesh.to_vertex_handle(out_border[v]).idx()]);
  }
}

Mesh HalfEdges::to_mesh(const Mesh& from) const {
  Mesh result;
  std::vector<int> number(from.vertices.size(), -1);
  for (const OpenMesh::FaceHandle face : mesh.all_faces()) {
    if (mesh.status(face).deleted()) continue;
    HalfedgeHandle half = mesh.halfedge_handle(face);
    Vec3i& t = result.triangles.emplace_back();
    for (int k = 0; k < 3; ++k, half = mesh.next_halfedge_handle(half)) {
      t[k] = source[mesh.from_vertex_handle(half).idx()];
      number[t[k]] = 0;
    }
  }
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(from.vertices[v]);
  }
  for (Vec3i& t : result.triangles) t = {number[t.x], number[t.y], number[t.z]};
  return result;
}

}  // namespace riffler
