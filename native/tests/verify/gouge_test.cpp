// How deep under a part's surface a cut goes, compared with the closed form of a box.
#include "verify/gouge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mesh/shapes.hpp"

namespace riffler::verify::gouge_test {
namespace {

const Vec3 kLower{0, 0, 0}, kUpper{20, 14, 9};

/// mm under the box's surface.
double depth(const Vec3& p) {
  const Vec3 least = glm::min(p - kLower, kUpper - p);
  return std::min({least.x, least.y, least.z});
}

double densest(const Vec3& a, const Vec3& b) {
  double most = 0;
  for (int k = 0; k <= 4000; ++k) most = std::max(most, depth(a + (k / 4000.0) * (b - a)));
  return most;
}

TEST(PartSurface, TheDeepestOfManyPiecesIsThatOfDensePointsToAPercent) {
  const PartSurface surface(subdivided(mesh::box_mesh(kLower, kUpper), 2), 0.05);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 200; ++k) {
    PartSurface::Deepest worst;
    double most = 0;
    for (int n = 0; n < 12; ++n) {  // shallow ones after deep ones, and deep ones after shallow ones
      const auto point = [&] { return kLower + Vec3(share(random), share(random), share(random)) * (kUpper - kLower); };
      const Vec3 a = point(), b = n % 3 == 0 ? a : point();
      surface.look_deeper(a, b, worst);
      most = std::max(most, densest(a, b));
      ASSERT_GE(worst.depth, most / 1.01 - 1e-9);
      ASSERT_LE(worst.depth, most + 0.01);  // dense points are up to 0.003 mm apart
      ASSERT_NEAR(depth(worst.point), worst.depth, 1e-9);
    }
  }
}

TEST(PartSurface, RaysThatEndOnAPlaneAreAsDeepAsItIs) {
  const PartSurface surface(mesh::box_mesh(kLower, kUpper), 0.05);
  PartSurface::Deepest worst;
  for (double x = 6; x <= 14; x += 0.25) surface.look_deeper({x, 7, 9}, {x, 7, 6.5}, worst);
  EXPECT_DOUBLE_EQ(worst.depth, 2.5);
  surface.look_deeper({6, 7, 9}, {6, 7, 6.499}, worst);  // by less than a percent
  EXPECT_NEAR(worst.depth, 2.501, 1e-12);
}

TEST(PartSurface, SpansWithoutLengthHaveTheDepthOfTheirPoint) {
  const PartSurface surface(mesh::box_mesh(kLower, kUpper), 0.05);
  PartSurface::Deepest worst;
  surface.look_deeper({3, 3, 9}, {3, 3, 9}, worst);
  EXPECT_EQ(worst.depth, 0);
  surface.look_deeper({3, 3, 8.75}, {3, 3, 8.75}, worst);
  EXPECT_DOUBLE_EQ(worst.depth, 0.25);
}

}  // namespace
}  // namespace riffler::verify::gouge_test
