// Meshes whose triangles do not agree, or stand repeatedly in one place, against the volumes of the solids meant.
#include <gtest/gtest.h>

#include <chrono>

#include "dexel/shapes.hpp"
#include "riffler/dexel/from_mesh/from_mesh.hpp"

namespace riffler::dexel::from_mesh_orient_test {
namespace {

using namespace shapes;

struct Result {
  double volume;
  MeshReport report;
};

Result made(const Mesh& mesh, double pitch = 0.5, const char* directions = "z") {
  Result out{};
  const Volume v = from_mesh(mesh, {box_of(mesh), pitch, directions}, {}, &out.report);
  out.volume = v.volume();
  EXPECT_DOUBLE_EQ(from_mesh(mesh, {box_of(mesh), pitch, directions}).volume(), out.volume);
  return out;
}

Mesh turned(Mesh m, const std::vector<int>& rows) {
  for (const int t : rows) std::swap(m.triangles[t].y, m.triangles[t].z);
  return m;
}

const Mesh kCube = box({0, 0, 0}, {10, 10, 10});

TEST(FromTurnedMesh, IsTheIntendedSolid) {
  for (const std::vector<int>& rows : {std::vector<int>{0, 2, 4, 6, 8, 10}, {0, 1, 2, 3, 4, 5}, {7}})
    for (const Mesh& m : {turned(kCube, rows), unwelded(turned(kCube, rows))}) {
      const Result r = made(m);
      EXPECT_NEAR(r.volume, 1000, 1e-9);
      EXPECT_EQ(r.report.turned, rows.size());
      EXPECT_EQ(r.report.openings, 0U);
    }
  EXPECT_NEAR(made(turned(box({0, 0, 0}, {50, 50, 10}), {2})).volume, 25000, 1e-6);
}

TEST(FromTurnedMesh, OverlappingShellsAreAddedAndCavitiesStay) {
  const Mesh a = box({0, 0, 0}, {20, 20, 20}), b = box({10, 0, 0}, {30, 20, 20}), hole = box({5, 5, 5}, {15, 15, 15});
  Result r = made(joined(a, flipped(b)));
  EXPECT_NEAR(r.volume, 12000, 1e-6);
  EXPECT_EQ(r.report.flipped_shells, 1U);
  EXPECT_NEAR(r.report.overlap, 1. / 3, 1e-9);
  r = made(joined(a, flipped(hole)));
  EXPECT_NEAR(r.volume, 7000, 1e-6);
  EXPECT_TRUE(r.report.clean());
  // All of it inside out; a third body is not.
  r = made(joined(joined(flipped(a), hole), box({40, 0, 0}, {50, 10, 10})));
  EXPECT_NEAR(r.volume, 8000, 1e-6);
  EXPECT_EQ(r.report.flipped_shells, 2U);
  // The cavity's triangles disagree.
  r = made(joined(a, turned(flipped(hole), {1, 2, 3, 8})));
  EXPECT_NEAR(r.volume, 7000, 1e-6);
  EXPECT_EQ(r.report.turned, 4U);
}

TEST(FromRepeatedTriangles, IsAsQuickAsWithoutThem) {
  Mesh m = kCube;
  for (int k = 0; k < 199; ++k) m.triangles.push_back(m.triangles[3]);
  const auto start = std::chrono::steady_clock::now();
  Result r = made(m, 10.0 / 64);
  EXPECT_NEAR(r.volume, 1000, 1e-9);
  EXPECT_EQ(r.report.left_out, 199U);
  EXPECT_EQ(r.report.duplicates, 199U);
  // A polygon that runs round 234 times, as a fan: some of its triangles name a vertex twice.
  Mesh part = sphere({0, 0, 0}, 10, 16);
  const double whole = made(part, 20.0 / 120).volume;
  const Vec3i t = part.triangles[200];
  const int corners[] = {t.x, t.y, t.z};
  for (int k = 2; k < 3 * 234; ++k) part.triangles.emplace_back(t.x, corners[(k - 1) % 3], corners[k % 3]);
  EXPECT_NEAR(made(part, 20.0 / 120).volume, whole, 1e-9);
  // Minutes before; loose, as machines may be busy.
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 10);
}

TEST(FromNestedShells, CostGrowsWithTheInput) {
  const auto seconds = [](int shells) {
    Mesh m;
    for (int k = 1; k <= shells; ++k) {
      const Mesh shell = box(Vec3(-k), Vec3(k));
      const auto n = static_cast<int>(m.vertices.size());
      m.vertices.insert(m.vertices.end(), shell.vertices.begin(), shell.vertices.end());
      for (const Vec3i& t : shell.triangles) m.triangles.push_back(t + Vec3i(n));
    }
    const auto start = std::chrono::steady_clock::now();
    const Volume v = from_mesh(m, {box_of(m), 2.0 * shells / 16, "z"});
    EXPECT_NEAR(v.volume(), 8.0 * shells * shells * shells, 1e-6 * v.volume());
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  // 0.3 s where it grows with the input, 7 s where it grows with its square.
  EXPECT_LT(std::min(seconds(8000), seconds(8000)), 2.5);
}

}  // namespace
}  // namespace riffler::dexel::from_mesh_orient_test
