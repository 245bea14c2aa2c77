// Real parts: closed ones against the divergence theorem, broken ones against sampled winding numbers.
#include <gtest/gtest.h>

#include <random>

#include "dexel/shapes.hpp"
#include "riffler/dexel/from_mesh/from_mesh.hpp"

namespace riffler::dexel::from_mesh_models_test {
namespace {

using namespace shapes;

class ClosedModel : public testing::TestWithParam<const char*> {};
class OpenModel : public testing::TestWithParam<const char*> {};

TEST_P(ClosedModel, KeepsItsVolume) {
  const Mesh mesh = read_model(GetParam());
  if (mesh.empty()) GTEST_SKIP() << model_path(GetParam()) << " is absent";
  const double exact = signed_volume(mesh);
  Frame frame = frame_of(mesh, 256, "xyz");
  // A whole number of cells on every side, so that the sum over rays has no cut cells.
  frame.box.upper = frame.box.lower + glm::ceil(frame.box.size() / frame.pitch) * frame.pitch;
  const Volume volume = from_mesh(mesh, frame);
  // Flat faces along the rays of a grid are off by up to half a cell there.
  EXPECT_NEAR(volume.volume() / exact, 1, 3e-3);
  for (const Grid& grid : volume.grids()) EXPECT_NEAR(grid.volume() / exact, 1, 5e-3) << int(grid.axis());
}

TEST_P(OpenModel, KeepsItsVolumeByWindingNumber) {
  const Mesh mesh = read_model(GetParam());
  if (mesh.empty()) GTEST_SKIP() << model_path(GetParam()) << " is absent";
  const Frame frame = frame_of(mesh, 256, "z", 1);
  const Volume volume = from_mesh(mesh, frame);
  // A jittered grid of points; each counts inside where |w| > ½ by the sum over all triangles.
  const int budget = static_cast<int>(1e8 / static_cast<double>(mesh.triangles.size()));
  const int side = std::clamp(static_cast<int>(std::cbrt(budget / 3.0)), 6, 22);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const Vec3 cell = frame.box.size() / static_cast<double>(side);
  double ours = 0, theirs = 0;
  int different = 0;
  const Grid& grid = volume.reference();
  for (int a = 0; a < side; ++a)
    for (int b = 0; b < side; ++b)
      for (int c = 0; c < side; ++c) {
        const Vec3 p = frame.box.lower + cell * Vec3(a + uniform(random), b + uniform(random), c + uniform(random));
        const int i = std::clamp(static_cast<int>((p.x - frame.box.lower.x) / frame.pitch), 0, grid.nu() - 1);
        const int j = std::clamp(static_cast<int>((p.y - frame.box.lower.y) / frame.pitch), 0, grid.nv() - 1);
        const Vec3 on_ray(grid.u(i), grid.v(j), p.z);
        const double w = std::abs(winding_number(mesh, on_ray));
        theirs += w > 0.5, ours += inside(grid, i, j, p.z);
        different += (w > 0.5) != inside(grid, i, j, p.z) && std::abs(w - 0.5) > 1e-4;
      }
  EXPECT_EQ(different, 0);
  // Sampling error of the reference: below that of independent samples.
  const double n = side * side * side, box_volume = frame.box.size().x * frame.box.size().y * frame.box.size().z;
  const double share = theirs / n, error = std::sqrt(share * (1 - share) / n) / share;
  EXPECT_NEAR(volume.volume() / (share * box_volume), 1, 0.02 + 2 * error) << "error of the reference " << error;
  EXPECT_NEAR(ours / theirs, 1, 0.02);
}

INSTANTIATE_TEST_SUITE_P(FromMesh, ClosedModel,
                         testing::Values("fandisk", "rocker-arm", "spot", "ktoolcav", "ktoolcor"));
INSTANTIATE_TEST_SUITE_P(FromMesh, OpenModel, testing::Values("stanford-bunny", "suzanne", "teapot", "spider"));

}  // namespace
}  // namespace riffler::dexel::from_mesh_models_test
