// What from_mesh tells about a part, and parts that are hardly any.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "dexel/shapes.hpp"
#include "geom/math.hpp"
#include "riffler/dexel/from_mesh/from_mesh.hpp"
#include "support/effort.hpp"

namespace riffler::dexel::from_mesh_report_test {
namespace {

using namespace shapes;

MeshReport report_of(const Mesh& mesh, double pitch = 0.25) {
  MeshReport report;
  from_mesh(mesh, {box_of(mesh).grown(2 * pitch), pitch, "xyz"}, {}, &report);
  return report;
}

TEST(MeshReport, IsEmptyForGoodParts) {
  const Mesh a = box({0, 0, 0}, {4, 4, 4}), inner = box({1, 1, 1}, {3, 3, 3});
  for (const Mesh& mesh : {a, unwelded(a), sphere({0, 0, 0}, 5, 20), joined(a, flipped(inner)),
                           joined(a, moved(a, Mat3(1), Vec3(6, 0, 0))), joined(a, box({4, 0, 0}, {8, 4, 4}))}) {
    const MeshReport report = report_of(mesh);
    EXPECT_TRUE(report.clean());
    EXPECT_EQ(report.triangles, mesh.triangles.size());
  }
}

TEST(MeshReport, LeavesTheVolumeUnchanged) {
  const Mesh mesh = joined(open_box({0, 0, 0}, {10, 8, 6}), flipped(sphere({12, 3, 3}, 4, 12)));
  const Frame frame = frame_of(mesh, 60, "xyz", 1);
  MeshReport report;
  const Volume with = from_mesh(mesh, frame, {}, &report), without = from_mesh(mesh, frame);
  for (std::size_t g = 0; g < 3; ++g)
    for (int i = 0; i < with.grids()[g].nu(); ++i)
      for (int j = 0; j < with.grids()[g].nv(); ++j) {
        const auto a = with.grids()[g].ray(i, j), b = without.grids()[g].ray(i, j);
        ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
      }
  EXPECT_FALSE(report.clean());
}

TEST(MeshReport, CountsOpenings) {
  const Mesh cup = open_box({0.1, 0.1, 0.1}, {10, 8, 6});
  MeshReport report = report_of(cup);
  EXPECT_EQ(report.open_edges, 4);
  EXPECT_EQ(report.openings, 1);
  // All upright rays end in it, and none of the level ones.
  const double upright = 10 * 8, level = 10 * 6 + 8 * 6;
  EXPECT_NEAR(report.doubtful_rays, upright / (upright + level), 0.02);
  EXPECT_EQ(report.overlap + report.inside_out, 0);
  report = report_of(joined(unwelded(cup), moved(cup, Mat3(1), Vec3(20, 0, 0))));
  EXPECT_EQ(report.open_edges, 8);
  EXPECT_EQ(report.openings, 2);
}

TEST(MeshReport, NamesShellsThatFaceInwards) {
  const Mesh a = box({0, 0, 0}, {4, 4, 4}), b = box({6, 0, 0}, {9, 4, 4}), inner = box({1, 1, 1}, {3, 3, 3});
  MeshReport report = report_of(flipped(a));
  EXPECT_EQ(report.flipped_shells, 1);
  EXPECT_DOUBLE_EQ(report.inside_out, 1);
  report = report_of(unwelded(joined(a, flipped(b))));
  EXPECT_EQ(report.flipped_shells, 1);
  EXPECT_NEAR(report.inside_out, 48. / (64 + 48), 1e-9);
  EXPECT_EQ(report.overlap, 0);
  // A part with a cavity, all of it turned round.
  report = report_of(joined(flipped(a), inner));
  EXPECT_EQ(report.flipped_shells, 2);
  EXPECT_DOUBLE_EQ(report.inside_out, 1);
}

TEST(MeshReport, MeasuresOverlap) {
  const Mesh a = box({0, 0, 0}, {4, 4, 4}), b = box({2, 2, 2}, {6, 6, 6}), inner = box({1, 1, 1}, {3, 3, 3});
  EXPECT_NEAR(report_of(joined(a, b)).overlap, 8. / (64 + 64 - 8), 1e-9);
  EXPECT_NEAR(report_of(joined(a, inner)).overlap, 8. / 64, 1e-9);
  const MeshReport doubled = report_of(joined(a, a));
  EXPECT_DOUBLE_EQ(doubled.overlap, 1);
  EXPECT_EQ(doubled.duplicates, 0);  // by index these are two boxes
  Mesh twice = a;
  twice.triangles.insert(twice.triangles.end(), a.triangles.begin(), a.triangles.end());
  EXPECT_EQ(report_of(twice).duplicates, 12);
  EXPECT_EQ(report_of(twice).nonmanifold_edges, 18);
  EXPECT_EQ(report_of(flipped(twice)).flipped_shells, 1);
}

TEST(MeshReport, CountsTrianglesAndEdges) {
  Mesh mesh = box({0, 0, 0}, {4, 4, 4});
  mesh.triangles.emplace_back(0, 0, 1);
  EXPECT_EQ(report_of(mesh).degenerate, 1);
  mesh = box({0, 0, 0}, {4, 4, 4});
  std::swap(mesh.triangles[5].y, mesh.triangles[5].z);
  const MeshReport report = report_of(mesh);
  EXPECT_EQ(report.inconsistent_edges, 3);
  EXPECT_EQ(report.open_edges, 0);
  EXPECT_EQ(report.turned, 1);
  EXPECT_EQ(report.openings, 0);
}

/// A band around z, twisted by half a turn for each of `half_turns`.
Mesh band(int half_turns, int n, int across) {
  Mesh m;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= across; ++j) {
      const double a = 2 * kPi * i / n, turn = 0.5 * a * half_turns;
      const double s = 4.0 * j / across - 2, r = 10 + s * std::cos(turn);
      m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), s * std::sin(turn));
    }
  const auto id = [&](int i, int j) { return i < n ? i * (across + 1) + j : half_turns % 2 == 0 ? j : across - j; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < across; ++j) {
      m.triangles.emplace_back(id(i, j), id(i + 1, j), id(i + 1, j + 1));
      m.triangles.emplace_back(id(i, j), id(i + 1, j + 1), id(i, j + 1));
    }
  return m;
}

/// The figure-8 immersion of Klein's bottle.
Mesh klein_bottle(int n, int m) {
  Mesh mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double u = 2 * kPi * i / n, v = 2 * kPi * j / m;
      const double r = 10 + 4 * (std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v));
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u),
                                 4 * (std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v)));
    }
  // After a turn v has its sign changed.
  const auto id = [&](int i, int j) { return i < n ? i * m + j % m : (m - j % m) % m; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      mesh.triangles.emplace_back(id(i, j), id(i + 1, j), id(i + 1, j + 1));
      mesh.triangles.emplace_back(id(i, j), id(i + 1, j + 1), id(i, j + 1));
    }
  return mesh;
}

TEST(FromBadMesh, WithOneSideOnlyFollowsItsWindingNumber) {
  for (const Mesh& mesh : {band(1, 60, 6), band(3, 90, 6), klein_bottle(60, 40)}) {
    const Frame frame = frame_of(mesh, 50, "xyz", 2);
    MeshReport report;
    Volume volume(frame);
    try {
      volume = from_mesh(mesh, frame, {}, &report);
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("volume"), std::string::npos);
    }
    EXPECT_GT(report.inconsistent_edges, 0);
    const Agreement a = compare(mesh, volume, 500, 1);
    EXPECT_LE(a.different, 3);
    EXPECT_LT(a.worst, 1e-4);
  }
}

TEST(FromBadMesh, ErrorsNameTheFault) {
  const Frame frame{{Vec3(-1), Vec3(11)}, 0.5, "xyz"};
  const auto message = [&](const Mesh& mesh) -> std::string {
    try {
      from_mesh(mesh, frame);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  };
  const auto expect = [&](const Mesh& mesh, const std::string& part) {
    EXPECT_NE(message(mesh).find(part), std::string::npos) << message(mesh);
  };
  const Mesh solid = box({0, 0, 0}, {5, 5, 5});
  expect({}, "no triangles");
  expect({solid.vertices, {}}, "no triangles");
  for (const int bad : {8, -1, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    Mesh mesh = solid;
    mesh.triangles[7].y = bad;
    expect(mesh, "row 7");
  }
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e31}) {
    Mesh mesh = solid;
    mesh.vertices[3].z = bad;
    expect(mesh, "row 3");
  }
  expect({{{0, 0, 0}, {9, 0, 1}, {0, 9, 2}}, {{0, 1, 2}}}, "flat sheet");
  // A sheet of many triangles, level and tilted, far from the origin too.
  Mesh sheet;
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j <= 10; ++j) sheet.vertices.emplace_back(i, j, 0);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      sheet.triangles.emplace_back(11 * i + j, 11 * i + j + 11, 11 * i + j + 12);
      sheet.triangles.emplace_back(11 * i + j, 11 * i + j + 12, 11 * i + j + 1);
    }
  expect(sheet, "flat sheet");
  expect(moved(sheet, rotation({1, 2, 3}, 0.8), Vec3(1)), "flat sheet");
  expect(moved(sheet, rotation({1, 2, 3}, 0.8), Vec3(1e5, -1e5, 1e5)), "flat sheet");
}

TEST(FromBadMesh, TrianglesWithoutAreaDoNoHarm) {
  Mesh mesh = sphere({0.3, 0.2, 0.1}, 8, 16);
  const double exact = signed_volume(mesh);
  std::mt19937_64 random(2);
  const int n = static_cast<int>(mesh.vertices.size());
  for (int k = 0; k < 60; ++k) {
    const int a = static_cast<int>(random() % n), b = static_cast<int>(random() % n);
    // Needles from vertex to vertex, whose edges cancel or not.
    mesh.triangles.emplace_back(a, b, b);
    mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    const int middle = static_cast<int>(mesh.vertices.size()) - 1;
    mesh.triangles.emplace_back(a, middle, b);
  }
  MeshReport report;
  const Volume volume = from_mesh(mesh, frame_of(mesh, 80, "xyz", 1), {}, &report);
  EXPECT_GE(report.degenerate, 60);
  EXPECT_GT(report.open_edges, 0);
  for (const Grid& grid : volume.grids()) EXPECT_NEAR(grid.volume() / exact, 1, 2e-3);
}

class FromMovedMesh : public testing::TestWithParam<double> {};

TEST_P(FromMovedMesh, KeepsItsVolume) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  Mesh bowl = sphere({0, 0, 0}, 10, 24);
  bowl.triangles.erase(bowl.triangles.begin(), bowl.triangles.begin() + 300);  // without its top
  const double open = from_mesh(bowl, frame_of(bowl, 128, "z", 2)).volume();
  const Mesh brick = box({-7, -5, -3}, {7, 5, 3}), ball = sphere({0, 0, 0}, 9, 20);
  for (int round = 0; round < 8; ++round) {
    const Mat3 turn = rotation(vector(), 4 * uniform(random));
    const Vec3 shift = GetParam() * vector();
    const auto check = [&](const Mesh& mesh, double exact) {
      const Mesh there = moved(mesh, turn, shift);
      const Volume volume = from_mesh(there, frame_of(there, 128, "xyz", 2));
      for (const Grid& grid : volume.grids()) EXPECT_NEAR(grid.volume() / exact, 1, 2e-3) << round;
    };
    check(brick, signed_volume(brick));
    check(ball, signed_volume(ball));
    check(bowl, open);
  }
}

INSTANTIATE_TEST_SUITE_P(Property, FromMovedMesh, testing::Values(1.0, 1e3, 1e5));

TEST(FromOpenMesh, ColumnsThroughVerticesAndEdges) {
  // Vertices on the rays' lattice: columns through vertices, edges, coplanar walls, and boundaries of all of them.
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int round = 0; round < 6; ++round) {
    const double far = round % 2 == 1 ? 1e5 : 0;
    Mesh mesh = joined(sphere({0, 0, 0}, 8, 8), box({-3, -6, -2}, {5, 1, 9}));
    for (Vec3& p : mesh.vertices) p = glm::round(p * (1 + 0.2 * uniform(random))) + 0.5 + far;
    std::erase_if(mesh.triangles, [&](const Vec3i&) { return uniform(random) > 0.85; });
    const Vec3 corner = glm::floor(box_of(mesh).lower) - 1.0;
    const Agreement a = compare(mesh, from_mesh(mesh, {{corner, corner + 28.0}, 1, "xyz"}), 1500, round);
    EXPECT_LE(a.different, 2) << round;
    EXPECT_LT(a.worst, 1e-3) << round;
  }
}

TEST(FromOpenMesh, ReportsSmoothlyAndCancelsEverywhere) {
  Mesh mesh = sphere({0, 0, 0}, 10, 40);
  std::mt19937_64 random(5);
  std::erase_if(mesh.triangles, [&](const Vec3i&) { return random() % 20 == 0; });
  const Frame frame = frame_of(mesh, 80, "xyz", 1);
  std::vector<double> shares;
  MeshReport report;
  from_mesh(
      mesh, frame,
      [&](double share) {
        shares.push_back(share);
        return true;
      },
      &report);
  EXPECT_EQ(shares.back(), 1);
  EXPECT_GT(shares.size(), 300);
  for (std::size_t k = 1; k < shares.size(); ++k) {
    EXPECT_GE(shares[k], shares[k - 1]);
    EXPECT_LT(shares[k] - shares[k - 1], 0.12);
  }
  for (double limit = 0.02; limit < 1; limit += test::kSanitized ? 0.33 : 0.11)
    EXPECT_THROW(from_mesh(mesh, frame, [&](double share) { return share < limit; }), Cancelled) << limit;
}

}  // namespace
}  // namespace riffler::dexel::from_mesh_report_test
