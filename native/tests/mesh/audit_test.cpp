#include "riffler/mesh/audit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mesh/shapes.hpp"

namespace riffler::mesh::audit_test {
namespace {

const Mesh kBox = box_mesh({0, 0, 0}, {1, 2, 3});

TEST(Audit, FindsNothingInClosedMeshes) {
  for (const Mesh& mesh : {kBox, sphere_mesh(5, 3), torus_mesh(10, 3, 20, 12)}) {
    const Audit a = audit(mesh);
    EXPECT_TRUE(a.watertight());
    EXPECT_EQ(a.degenerate + a.duplicates + a.folds, 0U);
    EXPECT_EQ(a.components, 1U);
    EXPECT_DOUBLE_EQ(a.volume, volume(mesh));
  }
}

TEST(Audit, EmptyMeshHasNoDefects) {
  const Audit a = audit({});
  EXPECT_TRUE(a.watertight());
  EXPECT_EQ(a.components, 0U);
  EXPECT_EQ(a.volume, 0);
}

TEST(Audit, AMissingTriangleLeavesThreeOpenEdges) {
  Mesh mesh = sphere_mesh(5, 2);
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  const Audit a = audit(mesh);
  EXPECT_EQ(a.open_edges, 3U);
  EXPECT_EQ(a.nonmanifold_edges + a.nonmanifold_vertices, 0U);  // open fans are fine
}

TEST(Audit, ATurnedTriangleSpoilsThreeEdgesButNoVertex) {
  Mesh mesh = sphere_mesh(5, 2);
  std::swap(mesh.triangles[17].x, mesh.triangles[17].y);
  const Audit a = audit(mesh);
  EXPECT_EQ(a.nonmanifold_edges, 3U);
  EXPECT_EQ(a.open_edges + a.nonmanifold_vertices, 0U);
}

TEST(Audit, AFinOnAnEdgeIsNonManifold) {
  Mesh mesh = kBox;
  mesh.vertices.emplace_back(-1, -1, 1);
  mesh.triangles.emplace_back(0, 4, 8);
  const Audit a = audit(mesh);
  EXPECT_EQ(a.nonmanifold_edges, 1U);
  EXPECT_EQ(a.nonmanifold_vertices, 2U);
  EXPECT_EQ(a.open_edges, 2U);
  EXPECT_EQ(a.components, 1U);
}

TEST(Audit, BoxesThatShareAnEdgeOrAVertexAreNonManifold) {
  // The second box's vertices 0 and 4 are the first one's 3 and 7: four triangles at the edge between them.
  Mesh edge = both(kBox, moved(kBox, {1, 2, 0}));
  for (Vec3i& t : edge.triangles)
    for (int k = 0; k < 3; ++k) t[k] = t[k] == 8 ? 3 : t[k] == 12 ? 7 : t[k];
  Audit a = audit(edge);
  EXPECT_EQ(a.nonmanifold_edges, 1U);
  EXPECT_EQ(a.nonmanifold_vertices, 2U);
  EXPECT_EQ(a.open_edges, 0U);
  EXPECT_EQ(a.components, 1U);

  Mesh vertex = both(kBox, moved(kBox, {1, 2, 3}));
  for (Vec3i& t : vertex.triangles)
    for (int k = 0; k < 3; ++k) t[k] = t[k] == 8 ? 7 : t[k];
  a = audit(vertex);
  EXPECT_EQ(a.nonmanifold_edges, 0U);
  EXPECT_EQ(a.nonmanifold_vertices, 1U);
  EXPECT_EQ(a.open_edges, 0U);
  EXPECT_EQ(a.components, 2U);
  EXPECT_FALSE(a.watertight());
}

TEST(Audit, DuplicatesAreCountedInAnyOrder) {
  Mesh mesh = kBox;
  const Vec3i t = mesh.triangles[4];
  mesh.triangles.push_back(t);
  EXPECT_EQ(audit(mesh).duplicates, 1U);
  mesh.triangles.emplace_back(t.z, t.y, t.x);
  EXPECT_EQ(audit(mesh).duplicates, 2U);
  EXPECT_EQ(audit(mesh).nonmanifold_edges, 3U);
}

TEST(Audit, DegenerateTrianglesAreCounted) {
  Mesh mesh = kBox;
  mesh.triangles.emplace_back(0, 0, 1);  // no edges, so no other defect
  Audit a = audit(mesh);
  EXPECT_EQ(a.degenerate, 1U);
  EXPECT_TRUE(a.watertight());
  EXPECT_EQ(a.components, 1U);
  mesh.vertices.emplace_back(0.5, 1, 1.5);  // the middle of the diagonal 0 – 7
  mesh.triangles.emplace_back(0, 8, 7);
  a = audit(mesh);
  EXPECT_EQ(a.degenerate, 2U);
  EXPECT_EQ(a.open_edges, 3U);
}

TEST(Audit, TwoTrianglesBackToBackAreFoldedAndDuplicate) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  const Audit a = audit(mesh);
  EXPECT_TRUE(a.watertight());
  EXPECT_EQ(a.folds, 3U);
  EXPECT_EQ(a.duplicates, 1U);
}

TEST(Audit, AFoldIsFarSharperThanAnEdge) {
  const auto folds = [](double height) {
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0.5, 0}, {1, 0.4, height}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
    return audit(mesh).folds;
  };
  EXPECT_EQ(folds(0), 1U);
  EXPECT_EQ(folds(0.004), 1U);  // n1 · n2 = -0.999992
  EXPECT_EQ(folds(0.005), 0U);  // n1 · n2 = -0.9999875
  EXPECT_EQ(folds(-0.004), 1U);
}

TEST(Audit, AMoebiusStripHasOneEdgeThatRunsOneWay) {
  Mesh mesh;
  constexpr int kN = 12;
  for (int i = 0; i < kN; ++i) {
    const double u = 2 * std::acos(-1.0) * i / kN;
    for (const double s : {-1.0, 1.0})
      mesh.vertices.emplace_back((5 + s * std::cos(u / 2)) * std::cos(u), (5 + s * std::cos(u / 2)) * std::sin(u),
                                 s * std::sin(u / 2));
    const int a = 2 * i, b = a + 1, c = i + 1 < kN ? a + 2 : 1, d = i + 1 < kN ? a + 3 : 0;
    mesh.triangles.emplace_back(a, c, d), mesh.triangles.emplace_back(a, d, b);
  }
  const Audit a = audit(mesh);
  EXPECT_EQ(a.nonmanifold_edges, 1U);
  EXPECT_EQ(a.nonmanifold_vertices, 0U);
  EXPECT_EQ(a.open_edges, 2U * kN);
  EXPECT_EQ(a.components, 1U);
}

/// Counts straight from the definitions, with sorted lists of everything.
Audit slow_audit(const Mesh& mesh) {
  Audit a;
  std::map<std::pair<int, int>, std::vector<std::pair<int, bool>>> edges;
  std::map<std::vector<int>, int> sets;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Vec3i& v = mesh.triangles[t];
    if (v.x == v.y || v.y == v.z || v.z == v.x) continue;
    std::vector<int> set{v.x, v.y, v.z};
    std::sort(set.begin(), set.end());
    if (sets[set]++ > 0) ++a.duplicates;
    for (int k = 0; k < 3; ++k) edges[std::minmax(v[k], v[(k + 1) % 3])].emplace_back(t, v[k] < v[(k + 1) % 3]);
  }
  std::vector<int> piece(mesh.triangles.size());
  for (std::size_t t = 0; t < piece.size(); ++t) piece[t] = static_cast<int>(t);
  const auto join = [](std::vector<int>& of, int x, int y) {
    const int from = of[x], to = of[y];
    for (int& i : of)
      if (i == from) i = to;
  };
  std::vector<char> bad(mesh.vertices.size(), 0);
  for (const auto& [ends, uses] : edges) {
    if (uses.size() == 1) ++a.open_edges;
    if (uses.size() > 2 || (uses.size() == 2 && uses[0].second == uses[1].second)) ++a.nonmanifold_edges;
    if (uses.size() > 2) bad[ends.first] = bad[ends.second] = 1;
    for (const auto& [t, way] : uses) join(piece, uses[0].first, t);
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::vector<int> fan(mesh.triangles.size());
    for (std::size_t t = 0; t < fan.size(); ++t) fan[t] = static_cast<int>(t);
    for (const auto& [ends, uses] : edges)
      if (uses.size() == 2 && (ends.first == static_cast<int>(v) || ends.second == static_cast<int>(v)))
        join(fan, uses[0].first, uses[1].first);
    std::vector<int> fans;
    for (std::size_t t = 0; t < fan.size(); ++t) {
      const Vec3i& c = mesh.triangles[t];
      const bool here = c.x == static_cast<int>(v) || c.y == static_cast<int>(v) || c.z == static_cast<int>(v);
      if (here && c.x != c.y && c.y != c.z && c.z != c.x) fans.push_back(fan[t]);
    }
    std::sort(fans.begin(), fans.end());
    fans.erase(std::unique(fans.begin(), fans.end()), fans.end());
    if (fans.size() > 1 || bad[v]) ++a.nonmanifold_vertices;
  }
  std::vector<int> pieces;
  for (std::size_t t = 0; t < piece.size(); ++t) {
    const Vec3i& c = mesh.triangles[t];
    if (c.x != c.y && c.y != c.z && c.z != c.x) pieces.push_back(piece[t]);
  }
  std::sort(pieces.begin(), pieces.end());
  a.components = static_cast<std::size_t>(std::unique(pieces.begin(), pieces.end()) - pieces.begin());
  return a;
}

TEST(Audit, AgreesWithTheDefinitionsOnRandomTriangles) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    Mesh mesh;
    const int n = 4 + static_cast<int>(random() % 10);
    for (int v = 0; v < n; ++v) mesh.vertices.emplace_back(v, v * v, v * v * v);
    for (int t = 1 + static_cast<int>(random() % 30); t > 0; --t)
      mesh.triangles.emplace_back(static_cast<int>(random()) & 0xffff, static_cast<int>(random()) & 0xffff,
                                  static_cast<int>(random()) & 0xffff);
    for (Vec3i& t : mesh.triangles) t = t % n;
    const Audit fast = audit(mesh), slow = slow_audit(mesh);
    EXPECT_EQ(fast.open_edges, slow.open_edges);
    EXPECT_EQ(fast.nonmanifold_edges, slow.nonmanifold_edges);
    EXPECT_EQ(fast.nonmanifold_vertices, slow.nonmanifold_vertices);
    EXPECT_EQ(fast.duplicates, slow.duplicates);
    EXPECT_EQ(fast.components, slow.components);
  }
}

TEST(Audit, VerticesAFewUlpsApartLeaveNothingOpen) {
  Mesh mesh = kBox;
  // Another vertex for one corner of some triangles, as far away as rounding would put it.
  const int copy = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(mesh.vertices[0] + Vec3(2.7e-16, 0, -4e-16));
  for (int t : {0, 5, 8})
    for (int k = 0; k < 3; ++k)
      if (mesh.triangles[t][k] == 0) mesh.triangles[t][k] = copy;
  const Audit a = audit(mesh);
  EXPECT_TRUE(a.watertight());
  EXPECT_EQ(a.components, 1U);
  mesh.vertices.back().x = 1e-12;
  EXPECT_GT(audit(mesh).open_edges, 0U);
  // Equal vertices count as two: welding them is the file readers' job.
  mesh.vertices.back() = mesh.vertices[0];
  EXPECT_GT(audit(mesh).open_edges, 0U);
}

TEST(Audit, RefusesAnInvalidMesh) {
  Mesh mesh = kBox;
  mesh.triangles[3].y = 99;
  EXPECT_THROW(audit(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::mesh::audit_test
