#include "riffler/mesh/orient.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mesh/shapes.hpp"
#include "mesh/solids.hpp"
#include "riffler/mesh/audit.hpp"

namespace riffler::mesh::orient_test {
namespace {

using shapes::box, shapes::flipped, shapes::joined, shapes::unwelded;

Mesh turned(Mesh m, const std::vector<int>& rows) {
  for (const int t : rows) std::swap(m.triangles[t].y, m.triangles[t].z);
  return m;
}

struct Result {
  Mesh mesh;
  Orientation found;
  bool any;
};

Result orient(const Mesh& mesh) {
  Result out{mesh, {}, false};
  if (std::optional<Mesh> better = oriented(mesh, out.found)) out.mesh = *std::move(better), out.any = true;
  return out;
}

const Mesh kCube = box({0, 0, 0}, {10, 10, 10});

TEST(Orient, LeavesGoodMeshesUnchanged) {
  const Mesh inner = box({2, 2, 2}, {8, 8, 8}), apart = box({20, 0, 0}, {30, 10, 10});
  for (const Mesh& m : {kCube, unwelded(kCube), joined(kCube, apart), joined(kCube, flipped(inner)),
                        joined(flipped(inner), kCube), joined(kCube, inner), Mesh{}}) {
    const Result r = orient(m);
    EXPECT_FALSE(r.any);
    EXPECT_FALSE(r.found.changed());
    EXPECT_EQ(r.found.one_sided, 0U);
  }
}

TEST(Orient, CarriesOrientationOverEdges) {
  std::mt19937 random(3);
  for (int run = 0; run < 200; ++run) {
    std::vector<int> rows(12);
    for (int k = 0; k < 12; ++k) rows[k] = k;
    std::shuffle(rows.begin(), rows.end(), random);
    rows.resize(1 + run % 12);
    const Mesh bad = turned(kCube, rows);
    for (const Mesh& m : {bad, unwelded(bad)}) {
      const Result r = orient(m);
      EXPECT_NEAR(volume(r.mesh), 1000, 1e-9);
      ASSERT_EQ(r.mesh.triangles.size(), 12U);
      EXPECT_EQ(r.found.turned, rows.size() == 12 ? 0U : rows.size());
      EXPECT_EQ(r.found.turned_shells, rows.size() == 12 ? 1U : 0U);
    }
    EXPECT_EQ(audit(orient(bad).mesh).nonmanifold_edges, 0U);
  }
}

TEST(Orient, TurnsShellsOutwardsButNotCavities) {
  const Mesh inner = box({2, 2, 2}, {8, 8, 8}), innermost = box({4, 4, 4}, {6, 6, 6});
  Result r = orient(joined(kCube, flipped(box({5, 0, 0}, {15, 10, 10}))));
  EXPECT_NEAR(volume(r.mesh), 2000, 1e-9);
  EXPECT_EQ(r.found.turned_shells, 1U);
  EXPECT_NEAR(r.found.turned_volume, 1000, 1e-9);
  // A part with a cavity, all of it turned, and an island in the cavity.
  r = orient(joined(flipped(kCube), inner));
  EXPECT_NEAR(volume(r.mesh), 1000 - 216, 1e-9);
  EXPECT_EQ(r.found.turned_shells, 2U);
  r = orient(joined(joined(flipped(kCube), inner), flipped(innermost)));
  EXPECT_NEAR(volume(r.mesh), 1000 - 216 + 8, 1e-9);
  r = orient(joined(joined(kCube, flipped(inner)), flipped(innermost)));
  EXPECT_NEAR(volume(r.mesh), 1000 - 216 + 8, 1e-9);
  EXPECT_EQ(r.found.turned_shells, 1U);
  // A pocket modelled as a box that lies against the top stays; one that sticks out is a body of its own.
  EXPECT_FALSE(orient(joined(kCube, flipped(box({2, 2, 5}, {8, 8, 10})))).any);
  EXPECT_TRUE(orient(joined(kCube, flipped(box({2, 2, 5}, {8, 8, 11})))).any);
  // Both pieces turned, next to each other.
  r = orient(joined(flipped(kCube), flipped(box({20, 0, 0}, {30, 10, 10}))));
  EXPECT_NEAR(volume(r.mesh), 2000, 1e-9);
}

TEST(Orient, KeepsHollowsInEndlessMaterialOnRequest) {
  Orientation found;
  const Mesh apart = box({20, 0, 0}, {30, 10, 10});
  EXPECT_FALSE(oriented(flipped(joined(kCube, apart)), found, Hollow::Kept));
  EXPECT_FALSE(oriented(joined(flipped(kCube), box({2, 2, 2}, {8, 8, 8})), found, Hollow::Kept));
  EXPECT_FALSE(found.changed());
  EXPECT_TRUE(oriented(joined(flipped(kCube), apart), found, Hollow::Kept));
  EXPECT_TRUE(oriented(flipped(turned(kCube, {4})), found, Hollow::Kept));
}

TEST(Orient, MendsACavityWhoseTrianglesDisagree) {
  const Mesh inner = box({2, 2, 2}, {8, 8, 8});
  for (const std::vector<int>& rows : {std::vector<int>{3}, {0, 2, 4, 6, 8, 10}, {0, 1, 2}}) {
    const Result r = orient(joined(kCube, turned(flipped(inner), rows)));
    EXPECT_NEAR(volume(r.mesh), 1000 - 216, 1e-9);
    EXPECT_EQ(r.found.turned, rows.size());
  }
}

TEST(Orient, HandlesManyCavitiesAtAnyPlace) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0.1, 0.6), size(0.1, 0.3);
  Mesh m = box({0, 0, 0}, {10, 10, 10});
  double expected = 1000;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      for (int k = 0; k < 10; ++k) {
        const Vec3 lower = Vec3(i, j, k) + Vec3(place(random), place(random), place(random)), extent(size(random));
        m = joined(std::move(m), flipped(box(lower, lower + extent)));
        expected -= extent.x * extent.x * extent.x;
      }
  EXPECT_FALSE(orient(m).any);
  const Result r = orient(joined(flipped(m), box({20, 0, 0}, {21, 1, 1})));
  EXPECT_EQ(r.found.turned_shells, 1001U);
  EXPECT_NEAR(volume(r.mesh), expected + 1, 1e-9);
}

TEST(Orient, KeepsRepeatedTrianglesOnce) {
  Mesh m = kCube;
  for (int k = 0; k < 199; ++k)
    m.triangles.push_back(k % 2 ? m.triangles[4] : Vec3i(m.triangles[4].y, m.triangles[4].z, m.triangles[4].x));
  m.triangles.push_back(Vec3i(m.triangles[4].y, m.triangles[4].x, m.triangles[4].z));
  Result r = orient(m);
  EXPECT_EQ(r.found.left_out, 200U);
  ASSERT_EQ(r.mesh.triangles.size(), m.triangles.size());
  EXPECT_NEAR(volume(r.mesh), 1000, 1e-9);
  // All of them alike: nothing is torn open.
  Mesh twice = kCube;
  twice.triangles.insert(twice.triangles.end(), kCube.triangles.begin(), kCube.triangles.end());
  EXPECT_FALSE(orient(twice).any);
  r = orient(flipped(twice));
  EXPECT_EQ(r.found.turned_shells, 1U);
  EXPECT_NEAR(volume(r.mesh), 2000, 1e-9);
}

TEST(Orient, EdgesOfManyTrianglesCarryNothing) {
  // Two cubes along a common edge, one of them inside out: each is closed by itself.
  const Mesh other = box({10, 10, 0}, {20, 20, 10});
  const Mesh both = joined(kCube, flipped(other));
  for (const Mesh& m : {both, unwelded(both)}) {
    const Result r = orient(m);
    EXPECT_NEAR(volume(r.mesh), 2000, 1e-9);
    EXPECT_EQ(r.found.turned_shells, 1U);
  }
  // Two cubes with a wall between them, used by both: as it was.
  const Mesh wall = joined(kCube, box({10, 0, 0}, {20, 10, 10}));
  EXPECT_FALSE(orient(wall).any);
  EXPECT_FALSE(orient(unwelded(wall)).any);
}

TEST(Orient, OpenPiecesStay) {
  Mesh cup = kCube;
  cup.triangles.erase(cup.triangles.begin() + 2, cup.triangles.begin() + 4);
  EXPECT_FALSE(orient(cup).any);
  EXPECT_FALSE(orient(flipped(cup)).any);
  EXPECT_FALSE(orient(turned(cup, {5})).any);
  const Result r = orient(joined(turned(cup, {5}), turned(box({20, 0, 0}, {30, 10, 10}), {3})));
  EXPECT_EQ(r.found.turned, 1U);
  EXPECT_EQ(r.mesh.triangles[5], turned(cup, {5}).triangles[5]);
}

TEST(Orient, ReportsPiecesWithOneSide) {
  Mesh strip;
  constexpr int kN = 24;
  for (int i = 0; i < kN; ++i)
    for (int j = 0; j < 2; ++j) {
      const double a = 2 * kPi * i / kN, s = 2 * j - 1, r = 10 + s * std::cos(a / 2);
      strip.vertices.emplace_back(r * std::cos(a), r * std::sin(a), s * std::sin(a / 2));
    }
  const auto id = [&](int i, int j) { return i < kN ? 2 * i + j : 1 - j; };
  for (int i = 0; i < kN; ++i) {
    strip.triangles.emplace_back(id(i, 0), id(i + 1, 0), id(i + 1, 1));
    strip.triangles.emplace_back(id(i, 0), id(i + 1, 1), id(i, 1));
  }
  const Result r = orient(joined(strip, flipped(kCube)));
  EXPECT_EQ(r.found.one_sided, 1U);
  EXPECT_EQ(r.found.turned_shells, 1U);
  EXPECT_TRUE(std::equal(strip.triangles.begin(), strip.triangles.end(), r.mesh.triangles.begin()));
}

TEST(Orient, VerticesAFewUlpsApartAreOne) {
  Mesh m = unwelded(turned(kCube, {1, 6, 7}));
  for (std::size_t k = 0; k < m.vertices.size(); k += 2) m.vertices[k] += Vec3(2.7e-16, -1.8e-15, 0);
  const Result r = orient(m);
  EXPECT_EQ(r.found.turned, 3U);
  EXPECT_NEAR(volume(r.mesh), 1000, 1e-9);
}

}  // namespace
}  // namespace riffler::mesh::orient_test
