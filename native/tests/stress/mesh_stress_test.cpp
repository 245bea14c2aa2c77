// The meshing stress run, short and always the same; its checks themselves; and volumes that once failed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "mesh/shapes.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "stress/float_audit.hpp"
#include "stress/mesh_run.hpp"
#include "support/checkout.hpp"
#include "support/effort.hpp"

namespace riffler::stress::mesh_stress_test {
namespace {

TEST(MeshStress, HoldsForVolumesFromTheDegenerateLimits) {
  const MeshResults results = run_meshes({}, test::cases(2000, 10));
  for (const MeshFailure& f : results.failures)
    ADD_FAILURE() << "volume " << f.number << " (" << name(f.scene) << "): " << f.problem
                  << "\nagain: " << reproducer(f);
  EXPECT_GT(results.thread_checks, test::cases(100, 10));
  for (std::size_t k = 0; k < results.scenes.size(); ++k) {
    const MeshTally& t = results.scenes[k];
    EXPECT_EQ(t.volumes, test::cases(200, 10));
    EXPECT_GT(t.triangles, test::cases(3000, 10)) << name(static_cast<MeshScene>(k)) << ": hardly anything was meshed";
  }
}

TEST(MeshStress, HoldsWithTolerancesOfAllSizes) {
  MeshOptions options;
  options.tolerant = true;
  const MeshResults results = run_meshes(options, test::cases(150));
  for (const MeshFailure& f : results.failures)
    ADD_FAILURE() << "volume " << f.number << " (" << name(f.scene) << "): " << f.problem
                  << "\nagain: " << reproducer(f);
  EXPECT_GT(results.total().triangles, test::cases(25000));
}

/// Volumes that a mesher once failed for: the least of each, as riffler_mesh_stress writes them.
TEST(MeshStress, HoldsForVolumesThatOnceFailed) {
  for (const auto& entry : std::filesystem::directory_iterator(test::checkout() / "native/tests/marching/volumes"))
    EXPECT_EQ(check_mesh(dexel::load(entry.path()), true), "") << entry.path().filename();
}

TEST(MeshStress, DrawsTheSameVolumeAgain) {
  for (std::uint64_t n = 0; n < 20; ++n) EXPECT_EQ(check_same_bytes(mesh_volume(7, n), mesh_volume(7, n)), "") << n;
  EXPECT_NE(to_bytes(mesh_volume(7, 0)), to_bytes(mesh_volume(8, 0)));
}

TEST(MeshStress, FindsTheSmallestFailingVolume) {
  const Volume volume = mesh_volume(3, 0);
  const dexel::Grid& grid = volume.grids().back();
  int i = 0, j = 0;
  while (grid.ray(i, j).empty()) ++j == grid.nv() ? j = 0, ++i : i;
  const dexel::Span wanted = grid.ray(i, j).front();
  const auto has_it = [&](const Volume& v) {
    const auto spans = v.grids().back().ray(i, j);
    return std::find(spans.begin(), spans.end(), wanted) != spans.end();
  };
  const Volume least = minimised(volume, has_it);
  EXPECT_TRUE(has_it(least));
  std::size_t spans = 0;
  for (const dexel::Grid& g : least.grids()) spans += g.span_count();
  EXPECT_EQ(spans, 1u);
}

// The judge: each defect is seen.

TEST(MeshStress, FindsAMeshThatIsFartherThanTheTolerance) {
  const Volume volume = Volume::block({{{0, 0, 0}, {6, 5, 4}}, 0.5, "xyz"});
  const Mesh full = marching::to_mesh(volume), mesh = marching::to_mesh(volume, 0.01);
  EXPECT_EQ(check_within(mesh, full, 0.01), "");
  Mesh shifted = mesh;
  for (Vec3& v : shifted.vertices) v.x += 1.0 / 64;
  EXPECT_NE(check_within(shifted, full, 0.01), "");
  EXPECT_EQ(check_within(shifted, full, 0.016), "");
  Mesh open = mesh;
  open.triangles.pop_back();
  EXPECT_NE(check_within(open, full, 0.01), "");
  EXPECT_NE(check_within({}, full, 0.01), "");
}

/// To multiples of 2⁻²⁰, which float32 holds.
Vec3 on_floats(const Vec3& v) {
  return glm::round(v * 0x1p20) * 0x1p-20;
}

FloatAudit audit_of(const std::function<void(Mesh&)>& harm) {
  Mesh mesh = mesh::sphere_mesh(1, 2);
  for (Vec3& v : mesh.vertices) v = on_floats(v);
  harm(mesh);
  return float_audit(mesh);
}

TEST(FloatAudit, FindsEveryDefect) {
  EXPECT_TRUE(audit_of([](Mesh&) {}).clean());
  EXPECT_EQ(audit_of([](Mesh& m) { m.triangles.pop_back(); }).open, 3u);
  EXPECT_GT(audit_of([](Mesh& m) { m.triangles.push_back(m.triangles.back()); }).repeated, 0u);
  EXPECT_EQ(audit_of([](Mesh& m) { m.triangles.push_back(m.triangles.back()); }).duplicates, 1u);
  EXPECT_GT(audit_of([](Mesh& m) { std::swap(m.triangles[0].x, m.triangles[0].y); }).open, 0u);
  EXPECT_EQ(audit_of([](Mesh& m) { m.vertices[0] += Vec3(1e-9); }).inexact, 1u);
  EXPECT_EQ(audit_of([](Mesh& m) { m.vertices.push_back({5, 5, 5}); }).unused, 1u);
  EXPECT_GT(audit_of([](Mesh& m) { m.vertices[m.triangles[0].x] = m.vertices[m.triangles[0].y]; }).merged, 0u);
  EXPECT_EQ(audit_of([](Mesh& m) {  // two spheres that share one vertex
              const Mesh other = m;
              const int n = static_cast<int>(m.vertices.size());
              for (const Vec3& v : other.vertices) m.vertices.push_back({2 - v.x, v.y, -v.z});
              for (const Vec3i& t : other.triangles) m.triangles.push_back({t.x + n, t.y + n, t.z + n});
            })
                .pinched,
            1u);
  EXPECT_GT(audit_of([](Mesh& m) {  // a vertex laid flat onto a neighbouring triangle
              const Vec3i t = m.triangles[0];
              m.vertices[t.x] = 0.5 * (m.vertices[t.y] + m.vertices[t.z]);
            })
                .degenerate,
            0u);
}

}  // namespace
}  // namespace riffler::stress::mesh_stress_test
