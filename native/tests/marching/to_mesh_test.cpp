#include "riffler/marching/to_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/float_audit.hpp"
#include "stress/mesh_scenes.hpp"
#include "stress/random.hpp"
#include "stress/solids.hpp"
#include "support/effort.hpp"

namespace riffler::marching::to_mesh_test {
namespace {

using namespace stress;

dexel::Frame frame_at(const Vec3& lower, const Vec3& size, double pitch, const char* directions) {
  return {{lower, lower + size}, pitch, directions};
}

/// Every promise about any mesh, at once; an empty mesh passes.
void expect_clean(const Volume& volume, const std::string& what) {
  const FloatAudit result = float_audit(to_mesh(volume));
  EXPECT_TRUE(result.clean()) << what << ": " << result;
}

TEST(ToMesh, HandlesSingleRaysAndIsolatedColumns) {
  for (const char* directions : {"z", "xyz", "x", "y"})
    for (const double size : {0.01, 0.1, 0.125, 0.25, 0.3, 0.374, 0.6}) {
      for (const int longest : {0, 1, 2}) {
        Vec3 sides(size);
        sides[longest] = std::max(size, 0.25);  // a pitch longer than every side is refused
        const Mesh mesh = to_mesh(Volume::block(frame_at({1, 2, 3}, sides, 0.25, directions)));
        EXPECT_TRUE(float_audit(mesh).clean()) << directions << ' ' << size;
        EXPECT_FALSE(mesh.empty()) << directions << ' ' << size;
      }
    }
  Random random(7);
  Volume volume(frame_at(Vec3(0.0), Vec3(5, 5, 5), 0.25, "z"));
  fill(volume, [&](const dexel::Grid&, int, int) {
    return random.one_in(10) ? SolidSpans{{1, random.uniform(1.01, 4), {}, {}}} : SolidSpans{};
  });
  expect_clean(volume, "columns");
}

TEST(ToMesh, IsEmptyForAnEmptyVolume) {
  for (const char* directions : {"z", "xyz"}) {
    const Mesh mesh = to_mesh(Volume(frame_at(Vec3(0.0), Vec3(10.0), 0.5, directions)));
    EXPECT_TRUE(mesh.vertices.empty());
    EXPECT_TRUE(mesh.triangles.empty());
  }
}

void expect_box(const Box3& box, const Box3& expected, double tolerance) {
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(box.lower[a], expected.lower[a], tolerance) << "axis " << a;
    EXPECT_NEAR(box.upper[a], expected.upper[a], tolerance) << "axis " << a;
  }
}

TEST(ToMesh, KeepsABlocksBoxForAnyPlaceOfItsFacesBetweenRays) {
  for (const double h : {0.25, 0.3, 1.0 / 3, 0.7})
    for (double extra = -0.5; extra < 0.5; extra += 0.0625) {
      const Vec3 size{(8 + extra) * h, (5 - 0.7 * extra) * h, (11 + 0.4 * extra) * h};
      const dexel::Frame frame = frame_at({-1.1, 20.05, 3}, size, h, "xyz");
      const Mesh mesh = to_mesh(Volume::block(frame));
      EXPECT_TRUE(float_audit(mesh).clean()) << h << ' ' << extra;
      expect_box(box_of(mesh), frame.box, 2e-5);
      EXPECT_NEAR(enclosed(mesh), size.x * size.y * size.z, 2e-4 * size.x * size.y * size.z);
    }
}

TEST(ToMesh, KeepsTheFacesOfASheetThinnerThanThePitch) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double thin : {0.01, 0.1, 0.125, 0.2, 0.37}) {
      Vec3 size(3.0);
      size[axis] = thin;
      const dexel::Frame frame = frame_at({1, -2, 0.5}, size, 0.25, "xyz");
      const Mesh mesh = to_mesh(Volume::block(frame));
      EXPECT_TRUE(float_audit(mesh).clean()) << axis << ' ' << thin;
      expect_box(box_of(mesh), frame.box, 2e-5);
    }
}

TEST(ToMesh, StaysInTheBoxIfFlanksOfARidgeWouldMeetAboveIt) {
  const Tool engraver = cutters::taper(0.1, glm::radians(30.0), 3.175, 12);
  for (const double h : {0.2, 0.25, 0.3, 0.4})
    for (const double turn : {0.0, 0.05, 0.3, 0.7}) {
      if (test::kSanitized && h < 0.4) continue;
      const Vec3 along(std::cos(turn), std::sin(turn), 0), across(-along.y, along.x, 0), up(0, 0, 1);
      Volume volume = Volume::block(frame_at(Vec3(0.0), {60, 60, 9.93}, h, "xyz"));
      for (const double gap : {0.0, 1.0}) {  // two grooves that run into each other
        const Vec3 a = Vec3(10, 8, 9.3) + 2.6 * gap * across, b = Vec3(10, 8, 9.3) + 40.0 * along;
        const Pose poses[] = {{a, up}, {b, up}};
        sweep::carve(volume, engraver, poses);
      }
      const Mesh mesh = to_mesh(volume);
      EXPECT_TRUE(float_audit(mesh).clean()) << h << ' ' << turn;
      expect_box(box_of(mesh), volume.frame().box, 2e-5);
    }
}

TEST(ToMesh, PutsWallsOfOneDirectionHalfAPitchFromTheirRays) {
  const dexel::Frame frame = frame_at({-5, 3, 0}, {10, 6, 3.1}, 0.25, "z");
  const Mesh mesh = to_mesh(Volume::block(frame));
  expect_box(box_of(mesh), frame.box, 2e-5);
  EXPECT_NEAR(enclosed(mesh), Volume::block(frame).volume(), 1e-2);
  for (const char* directions : {"x", "y"}) {
    const Mesh turned = to_mesh(Volume::block(frame_at({-5, 3, 0}, {10, 6, 3}, 0.25, directions)));
    expect_box(box_of(turned), {{-5, 3, 0}, {5, 9, 3}}, 2e-5);
  }
}

TEST(ToMesh, KeepsFloorsThinnerThanThePitchInOneDirection) {
  const dexel::Frame frame = frame_at(Vec3(0.0), {5, 5, 3}, 0.25, "z");
  for (const double floor : {0.01, 0.06, 0.1, 0.13, 0.24})
    for (const double bottom : {0.0, 0.04, 0.5, 1.3}) {
      const Solid part = subtract(box({-1, -1, bottom}, {9, 9, 9}), box({1, 1, bottom + floor}, {4, 4, 9}));
      const Volume volume = solid_volume(frame, part);
      const Mesh mesh = to_mesh(volume);
      EXPECT_TRUE(float_audit(mesh).clean()) << floor << ' ' << bottom;
      // No hole: a sheet with one would leave out its share of 9 mm² twice; here the outline is all there is.
      const Vec3 middle{2.5, 2.5, bottom + floor};
      double nearest = 1e9;
      for (const Vec3& v : mesh.vertices) nearest = std::min(nearest, glm::length(v - middle));
      EXPECT_LT(nearest, 0.26) << floor << ' ' << bottom;
      EXPECT_NEAR(enclosed(mesh), volume.volume(), 0.25 * 9) << floor << ' ' << bottom;
    }
}

TEST(ToMesh, RefusesABoxThatFloat32CannotResolve) {
  EXPECT_THROW(to_mesh(Volume::block(frame_at({0x1p19, 0, 0}, Vec3(2.0), 0.25, "xyz"))), std::invalid_argument);
  EXPECT_NO_THROW(to_mesh(Volume::block(frame_at({0x1p19 - 3, 0, 0}, Vec3(2.0), 0.25, "xyz"))));
  // The last place that works, with a pitch that is no power of two: a cell is then little more than four steps.
  const double h = 0.1300001;
  for (const char* directions : {"xyz", "z"})
    for (unsigned seed = 0; seed < 40; ++seed) {
      Random random(9000 + seed);
      Volume volume(frame_at(Vec3(0x1p21 * h - 2, 0, -0x1p21 * h + 1), Vec3(1.0), h, directions));
      fill_at_random(volume, random, 0.8, true);
      expect_clean(volume, "seed " + std::to_string(seed));
    }
}

TEST(ToMesh, IsTheSameForAnyNumberOfThreads) {
  Random random(3);
  const dexel::Frame frame = frame_at(Vec3(0.0), {20, 14, 9}, 0.25, "xyz");
  const Solid part = subtract(turned_box({10, 7, 4}, {8, 6, 3}, random_turn(random)), sphere({8, 8, 6}, 3.3));
  Volume rough(frame_at(Vec3(0.0), {9, 9, 9}, 0.25, "xyz"));
  fill_at_random(rough, random, 0.5, true);
  for (const Volume& volume : {solid_volume(frame, part), rough}) {
    setenv("RIFFLER_THREADS", "1", 1);
    const Mesh one = to_mesh(volume);
    for (const char* threads : {"2", "4"}) {
      setenv("RIFFLER_THREADS", threads, 1);
      const Mesh many = to_mesh(volume);
      EXPECT_TRUE(one.vertices == many.vertices);
      EXPECT_TRUE(one.triangles == many.triangles);
    }
    unsetenv("RIFFLER_THREADS");
  }
}

TEST(ToMesh, ReportsProgressAndCanBeCancelled) {
  const Volume volume = Volume::block(frame_at(Vec3(0.0), Vec3(8.0), 0.25, "xyz"));
  double last = 0;
  to_mesh(volume, [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1);
  for (const double stop : {0.0, 0.3, 0.6, 0.9})
    EXPECT_THROW(to_mesh(volume, [&](double share) { return share < stop; }), Cancelled);
}

}  // namespace
}  // namespace riffler::marching::to_mesh_test
