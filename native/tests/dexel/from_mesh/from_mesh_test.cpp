#include "riffler/dexel/from_mesh/from_mesh.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "dexel/shapes.hpp"
#include "support/effort.hpp"
#include "sweep/kernels.hpp"

namespace riffler::dexel::from_mesh_test {
namespace {

using namespace shapes;

/// Spans as the contract has them: sorted, disjoint, finite, never empty, within the box.
void expect_sound(const Volume& volume) {
  for (const Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        double last = -std::numeric_limits<double>::infinity();
        for (const Span& s : grid.ray(i, j)) {
          ASSERT_LT(s.near, s.far);
          ASSERT_GT(s.near, last);
          ASSERT_GE(s.near, grid.box().lower.z);
          ASSERT_LE(s.far, grid.box().upper.z);
          last = s.far;
        }
        ASSERT_EQ(grid.ray_normals(i, j).size(), grid.has_normals() ? grid.ray(i, j).size() : 0);
      }
}

/// All bytes of all rays.
std::vector<std::uint8_t> bytes_of(const Volume& volume) {
  std::vector<std::uint8_t> bytes;
  const auto append = [&](const auto& values) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(values.data());
    bytes.insert(bytes.end(), data, data + values.size_bytes());
  };
  for (const Grid& grid : volume.grids())
    for (std::size_t k = 0; k < grid.tile_count(); ++k) {
      append(std::span(grid.tile(k).offset));
      append(std::span(grid.tile(k).spans));
      append(std::span(grid.tile(k).normals));
    }
  return bytes;
}

/// The same for 1, 2 and 4 threads and on every instruction set.
void expect_same_everywhere(const Mesh& mesh, const Frame& frame) {
  std::vector<std::uint8_t> first;
  for (const char* threads : {"1", "2", "4"}) {
    setenv("RIFFLER_THREADS", threads, 1);
    const std::vector<std::uint8_t> bytes = bytes_of(from_mesh(mesh, frame));
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
  unsetenv("RIFFLER_THREADS");
  for (const std::string& name : sweep::instruction_sets()) {
    sweep::use_instruction_set(name);
    EXPECT_TRUE(bytes_of(from_mesh(mesh, frame)) == first) << name;
  }
  sweep::use_instruction_set("");
}

TEST(FromMesh, AlignedBoxIsTheBlockAtAnyOffset) {
  // Walls on rays, between rays, at the box's sides; near the origin and far from it.
  for (const double far : {0.0, 1.0, -37.3, 1e5})
    for (const double pitch : {0.25, 0.1, 1.0 / 3}) {
      const Vec3 lower = Vec3(far, -far, 2 * far);
      const Frame frame{{lower, lower + Vec3(40, 30, 20) * pitch}, pitch, "xyz"};
      for (const double part : {0.0, 0.25, 0.5, 0.75}) {
        const Vec3 from = lower + Vec3(5 + part) * pitch, to = lower + Vec3(33, 21, 12) * pitch + Vec3(part * pitch);
        const Volume volume = from_mesh(box(from, to), frame);
        expect_sound(volume);
        for (const Grid& grid : volume.grids()) {
          const Vec3 a = to_local(grid.axis(), from), b = to_local(grid.axis(), to);
          std::size_t full = 0;
          for (int i = 0; i < grid.nu(); ++i)
            for (int j = 0; j < grid.nv(); ++j) {
              for (const Span& s : grid.ray(i, j)) {
                EXPECT_EQ(s.near, a.z);
                EXPECT_EQ(s.far, b.z);
              }
              full += grid.ray(i, j).size();
            }
          // Half-open: as many rays as cells, wherever the walls stand.
          const Vec3 cells = glm::round((b - a) / pitch);
          EXPECT_EQ(full, static_cast<std::size_t>(cells.x * cells.y)) << far << " " << pitch << " " << part;
        }
      }
    }
}

TEST(FromMesh, NormalsPointOutOfTheMaterial) {
  const Mesh ball = sphere({0, 0, 0}, 10, 40);
  for (const Mesh& mesh : {ball, flipped(ball)}) {
    const Volume volume = from_mesh(mesh, {{Vec3(-11), Vec3(11)}, 0.5, "xyz"});
    for (const Grid& grid : volume.grids())
      for (int i = 0; i < grid.nu(); ++i)
        for (int j = 0; j < grid.nv(); ++j)
          for (std::size_t k = 0; k < grid.ray(i, j).size(); ++k) {
            const auto at = [&](double z) {
              return glm::normalize(to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), z)));
            };
            const Span s = grid.ray(i, j)[k];
            const SpanNormals n = grid.ray_normals(i, j)[k];
            // Facets are up to half of π / 40 off the sphere's normals, in both directions.
            EXPECT_GT(glm::dot(n.near.unpack(), at(s.near)), std::cos(0.06));
            EXPECT_GT(glm::dot(n.far.unpack(), at(s.far)), std::cos(0.06));
          }
  }
}

TEST(FromMesh, BoxNormalsWhereTheBoxClips) {
  const Volume volume = from_mesh(box(Vec3(-5), Vec3(5)), {{Vec3(-1), Vec3(1)}, 0.5, "xyz"});
  EXPECT_DOUBLE_EQ(volume.volume(), 8);
  for (const Grid& grid : volume.grids()) {
    const Vec3 along = to_world(grid.axis(), Vec3(0, 0, 1));
    EXPECT_EQ(grid.ray(1, 2)[0], (Span{-1, 1}));
    EXPECT_GT(glm::dot(grid.ray_normals(1, 2)[0].far.unpack(), along), 0.9999);
    EXPECT_LT(glm::dot(grid.ray_normals(1, 2)[0].near.unpack(), along), -0.9999);
  }
}

TEST(FromMesh, VolumeOfASphereConverges) {
  const Mesh ball = sphere({1, 2, 3}, 10, 200);
  const double exact = signed_volume(ball);
  double last = 1;
  for (const double pitch : {1.0, 0.5, 0.25, 0.125}) {
    const double v = from_mesh(ball, {{Vec3(-10, -9, -8), Vec3(12, 13, 14)}, pitch, "z"}).volume();
    const double error = std::abs(v / exact - 1);
    EXPECT_LT(error, 0.01 * pitch * pitch);
    last = error;
  }
  EXPECT_LT(last, 1e-4);
}

/// Total length along each direction times h², for meshes whose faces lie between rays.
void expect_volume(const Mesh& mesh, double volume, double pitch = 0.25) {
  const Box3 b = box_of(mesh);
  const Volume v = from_mesh(mesh, {b.grown(2 * pitch), pitch, "xyz"});
  expect_sound(v);
  for (const Grid& grid : v.grids()) EXPECT_NEAR(grid.volume(), volume, 1e-5 * volume) << int(grid.axis());
}

TEST(FromMesh, ComponentsAddUp) {
  const Mesh a = box({0, 0, 0}, {4, 4, 4}), b = box({2, 2, 2}, {6, 6, 6}), inner = box({1, 1, 1}, {3, 3, 3});
  expect_volume(a, 64);
  expect_volume(flipped(a), 64);
  expect_volume(joined(a, b), 64 + 64 - 8);          // overlapping
  expect_volume(joined(a, flipped(inner)), 64 - 8);  // a cavity
  expect_volume(joined(flipped(a), inner), 64 - 8);  // the same, inside out
  expect_volume(joined(a, inner), 64);               // nested with equal orientation
  expect_volume(joined(joined(a, flipped(inner)), box({1.5, 1.5, 1.5}, {2.5, 2.5, 2.5})), 64 - 8 + 1);
  expect_volume(joined(a, a), 64);  // doubled
  expect_volume(joined(a, joined(a, a)), 64);
  expect_volume(joined(a, moved(a, Mat3(1), Vec3(1e-7))), 64);            // nearly doubled
  expect_volume(joined(a, box({4, 0, 0}, {8, 4, 4})), 128);               // touching in a face
  expect_volume(joined(a, box({4, 4, 4}, {8, 8, 8})), 128);               // in a vertex
  expect_volume(joined(a, flipped(box({5, 0, 0}, {8, 4, 4}))), 64 + 48);  // one inside out
  expect_volume(unwelded(joined(a, b)), 64 + 64 - 8);
}

TEST(FromMesh, TouchingBoxesLeaveOneSpan) {
  const Volume v =
      from_mesh(joined(box({0, 0, 0}, {4, 4, 4}), box({0, 0, 4}, {4, 4, 7})), {{Vec3(-1), Vec3(8)}, 0.25, "z"});
  for (int i = 4; i < 20; ++i) EXPECT_EQ(v.reference().ray(i, 10).size(), 1);
  EXPECT_EQ(v.reference().ray(10, 10)[0], (Span{0, 7}));
}

TEST(FromMesh, RandomClosedMeshesAgreeWithTheirWindingNumber) {
  // Turned at random, snapped to the rays' lattice so that many rays pass through vertices and edges.
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  const double pitch = 0.5;
  for (int round = 0; round < 12; ++round) {
    Mesh mesh = sphere({0, 0, 0}, 6, 7);
    for (Vec3& p : mesh.vertices) p *= 1 + 0.5 * uniform(random);
    mesh = joined(mesh, moved(box({-2, -3, -1}, {3, 2, 2}), rotation(vector(), 3 * uniform(random)), 3.0 * vector()));
    mesh = moved(mesh, rotation(vector(), 3 * uniform(random)), round % 3 == 0 ? 1e5 * vector() : vector());
    const Vec3 corner = glm::floor(box_of(mesh).lower) - 1.0;
    if (round % 2 == 1)  // onto the rays
      for (Vec3& p : mesh.vertices) p = corner + (glm::round((p - corner) / pitch - 0.5) + 0.5) * pitch;
    const Volume volume = from_mesh(mesh, {{corner, corner + 26.0}, pitch, "xyz"});
    expect_sound(volume);
    int different = 0, tested = 0;
    for (const Grid& grid : volume.grids())
      for (int k = 0; k < 600; ++k) {
        const int i = static_cast<int>(random() % grid.nu()), j = static_cast<int>(random() % grid.nv());
        const double z = grid.box().lower.z + 13 * (1 + uniform(random));
        // A shade off the ray, where the half-open rule puts it; |w| is then an integer.
        const Vec3 p = to_world(grid.axis(), Vec3(grid.u(i) + 1e-7, grid.v(j) + 3e-6, z));
        const double w = std::abs(winding_number(mesh, p));
        if (std::abs(w - std::round(w)) > 0.01) continue;  // on the surface
        ++tested, different += inside(grid, i, j, z) != (w > 0.5);
      }
    EXPECT_EQ(different, 0) << round;
    EXPECT_GT(tested, 1700);
  }
}

TEST(FromMesh, SameBytesForAnyNumberOfThreadsAndInstructionSet) {
  const Mesh mesh = joined(sphere({0, 0, 0}, 10, 50), box({5, 5, 5}, {12, 12, 12}));
  expect_same_everywhere(mesh, frame_of(mesh, test::kSanitized ? 40 : 150, "xyz"));
  const Mesh open = open_box({0, 0, 0}, {10, 8, 6});
  expect_same_everywhere(open, frame_of(open, test::kSanitized ? 30 : 100, "xyz", 3));
  Mesh torn = mesh;
  std::mt19937_64 random(3);
  std::erase_if(torn.triangles, [&](const Vec3i&) { return random() % 30 == 0; });
  expect_same_everywhere(torn, frame_of(torn, test::kSanitized ? 40 : 80, "xyz", 1));
  // Crossings at one place, and rays on edges and vertices.
  const Mesh twice = joined(box({0, 0, 0}, {8, 8, 8}), box({0, 0, 0}, {8, 4, 8}));
  expect_same_everywhere(twice, Frame{{Vec3(-1.5), Vec3(9.5)}, 1, "xyz"});
}

TEST(FromMesh, TheBoxMayBeSmallerOrElsewhere) {
  const Mesh ball = sphere({0, 0, 0}, 10, 60);
  const Volume whole = from_mesh(ball, {{Vec3(-12), Vec3(12)}, 0.5, "z"});
  const Volume clipped = from_mesh(ball, {{Vec3(-4, 0, -3), Vec3(3, 12, 5)}, 0.5, "z"});
  const Grid &w = whole.reference(), &c = clipped.reference();
  for (int i = 0; i < c.nu(); ++i)
    for (int j = 0; j < c.nv(); ++j) {
      const auto expected = w.ray(i + 16, j + 24);
      ASSERT_EQ(c.ray(i, j).size(), expected.size());
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_NEAR(c.ray(i, j)[k].near, std::max(expected[k].near, -3.0), 1e-12);
        EXPECT_NEAR(c.ray(i, j)[k].far, std::min(expected[k].far, 5.0), 1e-12);
      }
    }
  EXPECT_EQ(from_mesh(ball, {{Vec3(20), Vec3(24)}, 0.5, "z"}).volume(), 0);
  // A mesh 4000 times as large as the box.
  const Mesh huge = moved(box(Vec3(-1e4), Vec3(1e4)), rotation({1, 2, 3}, 0.7), Vec3(0));
  EXPECT_NEAR(from_mesh(huge, {{Vec3(-2.5), Vec3(2.5)}, 0.1, "xyz"}).volume(), 125, 1e-9);
}

TEST(FromMesh, HugeMeshesKeepTheirSlopes) {
  // A plane through the small box, from vertices 1e6 mm away: span ends against the plane's equation.
  const Mesh huge = moved(box(Vec3(-1e6, -1e6, -1e6), Vec3(1e6, 1e6, 0)), rotation({3, 1, 0}, 0.4), Vec3(0));
  const Vec3 normal = rotation({3, 1, 0}, 0.4) * Vec3(0, 0, 1);
  const Volume v = from_mesh(huge, {{Vec3(-5), Vec3(5)}, 0.1, "z"});
  const Grid& grid = v.reference();
  for (int i = 0; i < grid.nu(); i += 7)
    for (int j = 0; j < grid.nv(); j += 5) {
      const double z = -(normal.x * grid.u(i) + normal.y * grid.v(j)) / normal.z;
      EXPECT_NEAR(grid.ray(i, j)[0].far, std::min(z, 5.0), 1e-7);
    }
}

TEST(FromMesh, MeshesWithoutVolumeAreRefused) {
  const Frame frame{{Vec3(-1), Vec3(11)}, 0.25, "z"};
  const auto refused = [&](const Mesh& mesh) { EXPECT_THROW(from_mesh(mesh, frame), std::invalid_argument); };
  Mesh sheet;
  sheet.vertices = {{0, 0, 0}, {10, 0, 1}, {10, 10, 3}, {0, 10, 2}};
  refused({});
  refused({sheet.vertices, {}});
  refused({sheet.vertices, {{0, 1, 4}}});
  refused({sheet.vertices, {{0, 1, 2}}});
  refused({sheet.vertices, {{0, 1, 2}, {0, 2, 3}}});
  refused({sheet.vertices, {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}}});  // both sides
  refused({sheet.vertices, {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}}});  // both sides, other diagonals
  refused({sheet.vertices, {{0, 0, 1}}});
  const Mesh solid = box({0, 0, 0}, {5, 5, 5});
  refused(joined(solid, flipped(solid)));
  refused(moved(joined(solid, flipped(solid)), rotation({1, 2, 3}, 1), Vec3(3)));
  Mesh broken = solid;
  broken.vertices[3].y = std::numeric_limits<double>::quiet_NaN();
  refused(broken);
  // With volume, but between the rays: empty, not refused. Two parts of which one is inside out: neither.
  EXPECT_EQ(from_mesh(box({3.01, 0, 0}, {3.02, 5, 5}), frame).volume(), 0);
  EXPECT_EQ(
      from_mesh(moved(joined(solid, flipped(moved(solid, Mat3(1), Vec3(7, 0, 0)))), Mat3(1), Vec3(30)), frame).volume(),
      0);
}

TEST(FromMesh, CancelsAndReports) {
  const Mesh ball = sphere({0, 0, 0}, 10, 50);
  const Frame frame = frame_of(ball, 200, "xyz");
  EXPECT_THROW(from_mesh(ball, frame, [](double share) { return share < 0.5; }), Cancelled);
  double last = 0;
  Volume volume = from_mesh(ball, frame, [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1);
  EXPECT_GT(volume.take_stats().triangles_tested, 0);
}

}  // namespace
}  // namespace riffler::dexel::from_mesh_test
