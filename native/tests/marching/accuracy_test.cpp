// The mesh against the true surface of solids whose rays were computed exactly.
#include <gtest/gtest.h>

#include "bench/mesh_distance.hpp"
#include "geom/math.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "stress/float_audit.hpp"
#include "stress/random.hpp"
#include "stress/solids.hpp"
#include "support/effort.hpp"

namespace riffler::marching::accuracy_test {
namespace {

using namespace stress;

constexpr double kPitch = 0.25;

struct Errors {
  double worst = 0, sum = 0;
  std::size_t count = 0;
  void add(double e) { worst = std::max(worst, std::abs(e)), sum += std::abs(e), ++count; }
  double mean() const { return sum / static_cast<double>(count); }
};

TEST(ToMeshAccuracy, OfASphereIsWithinTheBound) {
  const Vec3 centre{10.03, 9.96, 10.11};
  const double radius = 8;
  const Volume volume = solid_volume({{Vec3(0.0), Vec3(20.0)}, kPitch, "xyz"}, sphere(centre, radius));
  const Mesh mesh = to_mesh(volume);
  EXPECT_TRUE(float_audit(mesh).clean());
  Errors errors;
  for (const Vec3& v : mesh.vertices) errors.add(glm::length(v - centre) - radius);
  RecordProperty("max", std::to_string(errors.worst));
  EXPECT_LT(errors.worst, 1.2e-3);
  EXPECT_LT(errors.mean(), 1e-4);
  const double exact = 4.0 / 3 * kPi * radius * radius * radius;
  EXPECT_NEAR(enclosed(mesh), exact, 1e-3 * exact);  // chords of flat triangles: h²/R² ≈ 1e-3
}

TEST(ToMeshAccuracy, OfTheEdgesOfBoxesTurnedAtRandomIsWithinTheBound) {
  Errors edges, corners, vertices;
  for (int seed = 0; seed < test::cases(30, 15); ++seed) {
    Random random(static_cast<unsigned>(seed));
    const Vec3 centre = Vec3(10.0) + 0.3 * random.direction(), half{4.3, 3.7, 5.1};
    const Mat3 turn = random_turn(random);
    const Volume volume = solid_volume({{Vec3(0.0), Vec3(20.0)}, kPitch, "xyz"}, turned_box(centre, half, turn));
    const Mesh mesh = to_mesh(volume);
    const FloatAudit result = float_audit(mesh);
    EXPECT_TRUE(result.clean()) << result;
    EXPECT_NEAR(enclosed(mesh), 8 * half.x * half.y * half.z, 0.25);
    for (const Vec3& v : mesh.vertices) {
      const Vec3 q = glm::abs(glm::transpose(turn) * (v - centre)) - half;
      const double outside = glm::length(glm::max(q, Vec3(0.0))), inside = std::min(std::max({q.x, q.y, q.z}), 0.0);
      vertices.add(outside + inside);
    }
    const bench::MeshDistance nearest(mesh);
    for (int c = 0; c < 8; ++c)
      corners.add(nearest(centre + turn * (half * Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1))));
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 4; ++side)
        for (double s = -half[axis] + 0.6; s < half[axis] - 0.6; s += 0.05) {  // corners apart
          Vec3 q;
          q[axis] = s;
          q[(axis + 1) % 3] = (side & 1 ? 1 : -1) * half[(axis + 1) % 3];
          q[(axis + 2) % 3] = (side & 2 ? 1 : -1) * half[(axis + 2) % 3];
          edges.add(nearest(centre + turn * q));
        }
  }
  RecordProperty("mean", std::to_string(edges.mean()));
  RecordProperty("max", std::to_string(edges.worst));
  RecordProperty("corners_mean", std::to_string(corners.mean()));
  RecordProperty("corners_max", std::to_string(corners.worst));
  RecordProperty("vertices_max", std::to_string(vertices.worst));
  RecordProperty("vertices_mean", std::to_string(vertices.mean()));
  EXPECT_LT(edges.mean(), 2e-5);
  EXPECT_LT(edges.worst, 0.015);
  EXPECT_LT(vertices.worst, 0.015);
  // A corner may lie in a cell that no face crosses: its vertex is a neighbour's, which has to leave its own.
  EXPECT_LT(corners.mean(), 5e-5);
  EXPECT_LT(corners.worst, 0.02);
}

}  // namespace
}  // namespace riffler::marching::accuracy_test
