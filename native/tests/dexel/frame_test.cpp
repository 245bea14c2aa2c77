// Boxes and pitches that make no sense: refused by everything that makes a volume, with field, value and remedy.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "riffler/dexel/from_mesh/from_mesh.hpp"
#include "riffler/dexel/volume.hpp"
#include "support/error_of.hpp"

namespace riffler::dexel::frame_test {
namespace {

std::string said(const Vec3& size, double pitch, const Vec3& lower = Vec3(0.0)) {
  const Frame frame{{lower, lower + size}, pitch, "xyz"};
  const std::string text = test::error_of([&] { Volume volume(frame); });
  EXPECT_EQ(test::error_of([&] { Volume::block(frame); }), text);
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_EQ(text.empty() ? "" : test::error_of([&] { from_mesh(mesh, frame); }), text);
  return text;
}

TEST(Frame, InvalidOnesAreRefusedEverywhere) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Vec3 block{100, 60, 30};
  EXPECT_EQ(said(block, 0), "pitch must be a positive length in mm, not 0");
  EXPECT_EQ(said(block, -2), "pitch must be a positive length in mm, not -2");
  EXPECT_EQ(said(block, NAN), "pitch must be a positive length in mm, not nan");
  EXPECT_EQ(said(block, kInfinity), "pitch must be a positive length in mm, not inf");
  EXPECT_EQ(said(block, 1000),
            "pitch 1000 mm is longer than every side of the box, 100 × 60 × 30 mm: take a finer pitch");
  EXPECT_EQ(said({-5, 60, 30}, 1), "lower must be less than upper; along x they are 0 and -5 mm");
  EXPECT_EQ(said({100, 0, 30}, 1), "lower must be less than upper; along y they are 0 and 0 mm");
  EXPECT_EQ(said({100, 60, NAN}, 1), "upper must be finite, not nan along z");
  EXPECT_EQ(said(block, 1, {0, -kInfinity, 0}), "lower must be finite, not -inf along y");
  EXPECT_EQ(said({2e9, 60, 30}, 1e6),
            "the box is 2e+09 mm long along x, and may be 1e+07 mm at most: give its size in millimetres");
  EXPECT_NE(said(block, 1e-9).find(" for the rays of this box, 100 × 60 × 30 mm, and "), std::string::npos);
  EXPECT_NE(said(block, 1e-5, Vec3(1e12)).find("rays would coincide"), std::string::npos);
}

TEST(Frame, AtItsLimitsIsAccepted) {
  EXPECT_EQ(said({100, 60, 30}, 100), "");
  EXPECT_NE(said({100, 60, 30}, std::nextafter(100, 101)), "");
  EXPECT_EQ(said({1e7, 1, 1}, 1e5), "");
  EXPECT_NE(said({1.01e7, 1, 1}, 1e5), "");
  EXPECT_EQ(said({1e-6, 1e-6, 1e-6}, 1e-6), "");
  EXPECT_EQ(said({10, 0.4, 10}, 1), "");  // a lone row of rays stands for it
}

}  // namespace
}  // namespace riffler::dexel::frame_test
