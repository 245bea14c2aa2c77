// OpenMesh grows its point array by copying an uninitialised point, which GCC reports under the sanitizers' options.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include "mesh/decimate/half_edge.hpp"

#include "mesh/decimate/separate.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

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
    // Go around the vertex in one direction and, if that reaches a border, from the start in the other.
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

HalfEdges::HalfEdges(const Mesh& from, const Progress& progress) : adjacency(from) {
  base::report(progress, 0.3);
  number_fans(from, adjacency, corner, source);
  base::report(progress, 0.5);
  const int halves = static_cast<int>(corner.size());
  std::vector<int> copies(from.vertices.size(), 0);
  for (const int v : source) ++copies[v];

  // The connectivity is known, so it is set directly: OpenMesh's add_face would search for it again, with a result that
  // depends on the order of the faces. Memory is reserved once, because new_edge visits every property each time.
  std::vector<HalfedgeHandle> handle(halves), out_border(source.size());
  int edges = 0, faces = 0;
  for (int half = 0; half < halves; ++half) {
    if (corner[half] < 0) continue;
    if (half % 3 == 0) ++faces;
    if (const int twin = adjacency.twin(half); twin < 0 || twin > half) {
      handle[half] = HalfedgeHandle(2 * edges);
      if (twin >= 0) handle[twin] = HalfedgeHandle(2 * edges + 1);
      ++edges;
    }
  }
  base::report(progress, 0.6);
  mesh.resize(source.size(), static_cast<std::size_t>(edges), static_cast<std::size_t>(faces));
  base::parallel_for(source.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const VertexHandle vertex(static_cast<int>(v));
      mesh.set_point(vertex, to_openmesh(from.vertices[source[v]]));
      if (copies[source[v]] > 1) mesh.status(vertex).set_locked(true);
    }
  });

  base::report(progress, 0.8);
  const auto end_corner = [&](int half) { return corner[next_half(half)]; };
  OpenMesh::FaceHandle face(-1);
  for (int half = 0; half < halves; ++half) {
    if (corner[half] < 0) continue;
    if (half % 3 == 0) {
      face = OpenMesh::FaceHandle(face.idx() + 1);
      mesh.set_halfedge_handle(face, handle[half]);
    }
    mesh.set_vertex_handle(handle[half], VertexHandle(end_corner(half)));
    mesh.set_next_halfedge_handle(handle[half], handle[next_half(half)]);
    mesh.set_halfedge_handle(VertexHandle(corner[half]), handle[half]);
    mesh.set_face_handle(handle[half], face);
    if (adjacency.twin(half) >= 0) continue;
    const HalfedgeHandle opposite = mesh.opposite_halfedge_handle(handle[half]);
    mesh.set_vertex_handle(opposite, VertexHandle(corner[half]));
    out_border[end_corner(half)] = opposite;
    if (!adjacency.is_open(half))
      for (const int v : {corner[half], end_corner(half)}) mesh.status(VertexHandle(v)).set_locked(true);
  }
  for (std::size_t v = 0; v < source.size(); ++v) {
    if (!out_border[v].is_valid()) continue;
    // OpenMesh requires a border vertex to store its outgoing border half-edge; every fan has exactly one.
    mesh.set_halfedge_handle(VertexHandle(static_cast<int>(v)), out_border[v]);
    mesh.set_next_halfedge_handle(out_border[v], out_border[mesh.to_vertex_handle(out_border[v]).idx()]);
  }
}

Mesh HalfEdges::to_mesh(const Mesh& from, const Mesh& start, const Vec3& centre) const {
  Mesh result;
  std::vector<int> number(from.vertices.size(), -1);
  Vertices point = from.vertices;
  std::vector<char> moved(from.vertices.size(), 0), movable;
  for (const OpenMesh::FaceHandle face : mesh.all_faces()) {
    if (mesh.status(face).deleted()) continue;
    HalfedgeHandle half = mesh.halfedge_handle(face);
    Vec3i& t = result.triangles.emplace_back();
    for (int k = 0; k < 3; ++k, half = mesh.next_halfedge_handle(half)) {
      const VertexHandle v = mesh.from_vertex_handle(half);
      t[k] = source[v.idx()];
      if (number[t[k]] == 0) continue;
      number[t[k]] = 0;
      if (const Vec3 p = to_vec3(mesh.point(v)); p != start.vertices[t[k]]) point[t[k]] = p + centre, moved[t[k]] = 1;
    }
  }
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(point[v]);
    movable.push_back(moved[v]);
  }
  for (Vec3i& t : result.triangles) t = {number[t.x], number[t.y], number[t.z]};
  separate(result, movable);
  return result;
}

}  // namespace riffler::mesh
