#include "marching/to_mesh.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "marching/audit.hpp"
#include "marching/scenes.hpp"

namespace riffler {
namespace {

using namespace testing;

Frame frame_at(const Vec3& lower, const Vec3& size, double pitch, const char* directions) {
  return {{lower, lower + size}, pitch, directions};
}

/// Every promise about any mesh, at once; an empty mesh passes.
void expect_clean(const Volume& volume, const std::string& what) {
  const Audit result = audit(to_mesh(volume));
  EXPECT_TRUE(result.clean()) << what << ": " << result;
}

constexpr double kOffsets[] = {0, 0, 17.3, -250, 5e3, -4.9e5, 5e5};

TEST(ToMesh, IsCleanForGridsThatContradictEachOther) {
  for (unsigned seed = 0; seed < 600; ++seed) {
    Dice dice(seed);
    const char* directions = seed % 3 ? "xyz" : "z";
    const Vec3 size{dice.real(0.1, 2.2), dice.real(0.1, 2.2), dice.real(0.1, 2.2)};
    Volume volume(
        frame_at(Vec3(kOffsets[seed % 7], kOffsets[seed / 7 % 7], kOffsets[seed / 49 % 7]), size, 0.25, directions));
    const double fill_share = dice.real(0.2, 1);
    const bool random_normals = dice.chance(0.7);
    fill(volume, [&](const Grid& grid, int, int) { return wild_cuts(dice, grid, fill_share, random_normals); });
    expect_clean(volume, "seed " + std::to_string(seed));
  }
}

/// Signs drawn point by point, as all three grids see them: every pattern of a cell and its neighbours comes up.
TEST(ToMesh, IsCleanForRandomSigns) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    Dice dice(1000 + seed);
    const double h = seed % 2 ? 0.25 : 0.1, share = dice.real(0.05, 0.95);
    const int n = 9;
    Volume volume(frame_at(Vec3(seed % 5 == 0 ? 1e5 : 0.0), Vec3(n * h), h, seed % 4 ? "xyz" : "z"));
    std::vector<bool> inside(n * n * n);
    const bool checkerboard = seed < 8;
    for (int a = 0; a < n * n * n; ++a)
      inside[a] = checkerboard ? (a / (n * n) / (1 + seed / 4) + a / n % n / (1 + seed / 4) + a % n) % 2 == 0
                               : dice.chance(share);
    const double cut = dice.chance(0.5) ? 0.5 : dice.real(0.01, 0.99);
    fill(volume, [&](const Grid& grid, int i, int j) {
      Cuts cuts;
      const Vec3 along = to_world(grid.axis(), Vec3(0, 0, 1));
      for (int k = 0; k < n; ++k) {
        const Vec3 p = to_world(grid.axis(), Vec3(i, j, k));
        if (!inside[static_cast<int>(p.x) * n * n + static_cast<int>(p.y) * n + static_cast<int>(p.z)]) continue;
        const double at = grid.box().lower.z + (k + 0.5) * h;
        if (!cuts.empty() && std::abs(cuts.back().far - (at - cut * h)) < 1e-9)
          cuts.back().far = at + (1 - cut) * h;
        else
          cuts.push_back({at - cut * h, at + (1 - cut) * h, -along, along});
      }
      // The other end of a span may be cut a little later, so that neighbours overlap; drop what touches.
      for (std::size_t m = 1; m < cuts.size(); ++m)
        cuts[m].near = std::max(cuts[m].near, std::nextafter(cuts[m - 1].far, 1e30));
      return cuts;
    });
    expect_clean(volume, "seed " + std::to_string(seed));
  }
}

Solid random_solid(Dice& dice, const Vec3& lower, const Vec3& size, double h) {
  const auto point = [&] { return lower + Vec3(dice.real(0, 1), dice.real(0, 1), dice.real(0, 1)) * size; };
  const auto snapped = [&] {
    const Vec3 p = (point() - lower) / (h / 2);
    return lower + Vec3(std::round(p.x), std::round(p.y), std::round(p.z)) * (h / 2);
  };
  switch (dice.whole(0, 4)) {
    case 0:
      return sphere(point(), dice.real(0.3, 4) * h);
    case 1:
      return half_space(dice.direction(), 0);  // replaced below: through a point of the box
    case 2:
      return turned_box(point(), Vec3(dice.real(0.05, 4), dice.real(0.5, 4), dice.real(0.5, 4)) * h, dice.turn());
    case 3: {
      const Vec3 a = snapped(), b = snapped();
      return box(glm::min(a, b), glm::max(a, b) + Vec3(dice.whole(1, 3)) * (h / 2));
    }
    default: {  // a plate thinner than the pitch, along an axis
      const Vec3 a = point();
      Vec3 side = size;
      side[dice.whole(0, 2)] = dice.real(0.01, 0.9) * h;
      return box(a, a + side);
    }
  }
}

TEST(ToMesh, IsCleanForSolidsOfAllKinds) {
  for (unsigned seed = 0; seed < 800; ++seed) {
    Dice dice(5000 + seed);
    const double h = 0.25, offset = kOffsets[seed % 7];
    const Vec3 lower{offset, -offset, offset / 3}, size{dice.real(0.2, 3), dice.real(0.2, 3), dice.real(0.2, 3)};
    Solid solid = random_solid(dice, lower, size, h);
    for (int n = dice.whole(1, 5); n > 0; --n) {
      const Solid other = random_solid(dice, lower, size, h);
      const int rule = dice.whole(0, 2);
      solid = rule == 0 ? unite(solid, other) : rule == 1 ? subtract(solid, other) : unite(other, solid);
    }
    const char* directions[] = {"xyz", "xyz", "z", "x", "y"};
    expect_clean(solid_volume(frame_at(lower, size, h, directions[seed % 5]), solid), "seed " + std::to_string(seed));
  }
}

TEST(ToMesh, HandlesSingleRaysAndIsolatedColumns) {
  for (const char* directions : {"z", "xyz", "x", "y"})
    for (const double size : {0.01, 0.1, 0.125, 0.25, 0.3, 0.374, 0.6}) {
      const Frame frame = frame_at({1, 2, 3}, Vec3(size), 0.25, directions);
      const Mesh mesh = to_mesh(Volume::block(frame));
      EXPECT_TRUE(audit(mesh).clean()) << directions << ' ' << size;
      EXPECT_FALSE(mesh.empty()) << directions << ' ' << size;
    }
  Dice dice(7);
  Volume volume(frame_at(Vec3(0.0), Vec3(5, 5, 5), 0.25, "z"));
  fill(volume,
       [&](const Grid&, int, int) { return dice.chance(0.1) ? Cuts{{1, dice.real(1.01, 4), {}, {}}} : Cuts{}; });
  expect_clean(volume, "columns");
}

TEST(ToMesh, GivesNothingForNothing) {
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

TEST(ToMesh, KeepsABlocksBoxWhereverItsFacesLieBetweenRays) {
  for (const double h : {0.25, 0.3, 1.0 / 3, 0.7})
    for (double extra = -0.5; extra < 0.5; extra += 0.0625) {
      const Vec3 size{(8 + extra) * h, (5 - 0.7 * extra) * h, (11 + 0.4 * extra) * h};
      const Frame frame = frame_at({-1.1, 20.05, 3}, size, h, "xyz");
      const Mesh mesh = to_mesh(Volume::block(frame));
      EXPECT_TRUE(audit(mesh).clean()) << h << ' ' << extra;
      expect_box(box_of(mesh), frame.box, 2e-5);
      EXPECT_NEAR(enclosed(mesh), size.x * size.y * size.z, 2e-4 * size.x * size.y * size.z);
    }
}

TEST(ToMesh, KeepsTheFacesOfASheetThinnerThanThePitch) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double thin : {0.01, 0.1, 0.125, 0.2, 0.37}) {
      Vec3 size(3.0);
      size[axis] = thin;
      const Frame frame = frame_at({1, -2, 0.5}, size, 0.25, "xyz");
      const Mesh mesh = to_mesh(Volume::block(frame));
      EXPECT_TRUE(audit(mesh).clean()) << axis << ' ' << thin;
      expect_box(box_of(mesh), frame.box, 2e-5);
    }
}

TEST(ToMesh, PutsWallsOfOneDirectionHalfAPitchFromTheirRays) {
  const Frame frame = frame_at({-5, 3, 0}, {10, 6, 3.1}, 0.25, "z");
  const Mesh mesh = to_mesh(Volume::block(frame));
  expect_box(box_of(mesh), frame.box, 2e-5);
  EXPECT_NEAR(enclosed(mesh), Volume::block(frame).volume(), 1e-2);
  for (const char* directions : {"x", "y"}) {
    const Mesh turned = to_mesh(Volume::block(frame_at({-5, 3, 0}, {10, 6, 3}, 0.25, directions)));
    expect_box(box_of(turned), {{-5, 3, 0}, {5, 9, 3}}, 2e-5);
  }
}

TEST(ToMesh, KeepsFloorsThinnerThanThePitchInOneDirection) {
  const Frame frame = frame_at(Vec3(0.0), {5, 5, 3}, 0.25, "z");
  for (const double floor : {0.01, 0.06, 0.1, 0.13, 0.24})
    for (const double bottom : {0.0, 0.04, 0.5, 1.3}) {
      const Solid part = subtract(box({-1, -1, bottom}, {9, 9, 9}), box({1, 1, bottom + floor}, {4, 4, 9}));
      const Volume volume = solid_volume(frame, part);
      const Mesh mesh = to_mesh(volume);
      EXPECT_TRUE(audit(mesh).clean()) << floor << ' ' << bottom;
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
      Dice dice(9000 + seed);
      Volume volume(frame_at(Vec3(0x1p21 * h - 2, 0, -0x1p21 * h + 1), Vec3(1.0), h, directions));
      fill(volume, [&](const Grid& grid, int, int) { return wild_cuts(dice, grid, 0.8, true); });
      expect_clean(volume, "seed " + std::to_string(seed));
    }
}

TEST(ToMesh, IsTheSameForAnyNumberOfThreads) {
  Dice dice(3);
  const Frame frame = frame_at(Vec3(0.0), {20, 14, 9}, 0.25, "xyz");
  const Solid part = subtract(turned_box({10, 7, 4}, {8, 6, 3}, dice.turn()), sphere({8, 8, 6}, 3.3));
  Volume rough(frame_at(Vec3(0.0), {9, 9, 9}, 0.25, "xyz"));
  fill(rough, [&](const Grid& grid, int, int) { return wild_cuts(dice, grid, 0.5, true); });
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

TEST(ToMesh, ReportsProgressAndStopsWhenAsked) {
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
}  // namespace riffler
