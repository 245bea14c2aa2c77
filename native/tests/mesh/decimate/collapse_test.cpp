// What one edge collapse leaves of the half-edges, compared with OpenMesh's own collapse.
#include "mesh/decimate/collapse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <vector>

namespace riffler::mesh::collapse_test {
namespace {

/// A sheet of n × n squares with bumps, without some of its triangles.
Mesh torn_sheet(int n, int missing, std::mt19937& random) {
  Mesh sheet;
  std::uniform_real_distribution<double> height(-0.2, 0.2);
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) sheet.vertices.emplace_back(x, y, height(random));
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      sheet.triangles.emplace_back(a, b, d);
      sheet.triangles.emplace_back(a, d, c);
    }
  std::shuffle(sheet.triangles.begin(), sheet.triangles.end(), random);
  sheet.triangles.resize(sheet.triangles.size() - static_cast<std::size_t>(missing));
  return sheet;
}

/// Every half-edge that is left has the same ends, neighbours and face, and every vertex one that starts there, of the
/// border where it is on one.
void expect_same(const HalfEdgeMesh& mesh, const HalfEdgeMesh& reference) {
  for (const auto half : reference.all_halfedges()) {
    const auto edge = reference.edge_handle(half);
    ASSERT_EQ(mesh.status(edge).deleted(), reference.status(edge).deleted());
    if (reference.status(edge).deleted()) continue;
    ASSERT_EQ(mesh.to_vertex_handle(half), reference.to_vertex_handle(half));
    ASSERT_EQ(mesh.next_halfedge_handle(half), reference.next_halfedge_handle(half));
    ASSERT_EQ(mesh.prev_halfedge_handle(half), reference.prev_halfedge_handle(half));
    ASSERT_EQ(mesh.face_handle(half), reference.face_handle(half));
  }
  for (const auto face : reference.all_faces()) {
    ASSERT_EQ(mesh.status(face).deleted(), reference.status(face).deleted());
    if (reference.status(face).deleted()) continue;
    ASSERT_EQ(mesh.face_handle(mesh.halfedge_handle(face)), face);
    ASSERT_FALSE(mesh.status(mesh.edge_handle(mesh.halfedge_handle(face))).deleted());
  }
  for (const auto v : reference.all_vertices()) {
    ASSERT_EQ(mesh.status(v).deleted(), reference.status(v).deleted());
    if (reference.status(v).deleted()) continue;
    const auto spoke = mesh.halfedge_handle(v);
    ASSERT_EQ(spoke.is_valid(), reference.halfedge_handle(v).is_valid());
    if (!spoke.is_valid()) continue;
    ASSERT_EQ(mesh.from_vertex_handle(spoke), v);
    ASSERT_FALSE(mesh.status(mesh.edge_handle(spoke)).deleted());
    ASSERT_EQ(mesh.is_boundary(spoke), reference.is_boundary(v));
  }
}

TEST(Collapse, AgreesWithOpenMeshInsideAndAtBorders) {
  std::mt19937 random(7);
  int inside = 0, to_border = 0, along[2] = {0, 0};
  for (const int missing : {0, 3, 40, 90, 150})
    for (int k = 0; k < 4; ++k) {
      HalfEdges half_edges(torn_sheet(12, missing, random));
      HalfEdgeMesh& mesh = half_edges.mesh;
      Collapse collapse(mesh);
      std::uniform_int_distribution<int> any(0, static_cast<int>(mesh.n_halfedges()) - 1);
      for (int n = 0; n < 1500; ++n) {
        const OpenMesh::HalfedgeHandle half(any(random));
        const auto from = mesh.from_vertex_handle(half), to = mesh.to_vertex_handle(half);
        if (mesh.status(mesh.edge_handle(half)).deleted() || mesh.status(from).locked() || mesh.status(to).locked())
          continue;
        const bool borders[2] = {mesh.is_boundary(from), mesh.is_boundary(to)};
        const Vec3 ends[2] = {to_vec3(mesh.point(from)), to_vec3(mesh.point(to))};
        const bool between = !borders[0] && !borders[1] && n % 2 == 1;
        if (!collapse.prepare({half, between ? 0.5 * (ends[0] + ends[1]) : ends[1], between, 0})) continue;
        inside += !borders[0] && !borders[1];
        to_border += !borders[0] && borders[1];
        if (borders[0]) ++along[mesh.is_boundary(half)];
        HalfEdgeMesh reference = mesh;
        reference.collapse(half);
        collapse.commit();
        ASSERT_NO_FATAL_FAILURE(expect_same(mesh, reference));
      }
    }
  EXPECT_GT(inside, 500);
  EXPECT_GT(to_border, 100);
  EXPECT_GT(along[0], 100);  // the border's half-edge ends where the vertex that goes was
  EXPECT_GT(along[1], 100);
}

}  // namespace
}  // namespace riffler::mesh::collapse_test
