// Brushes with falloff against surfaces in closed form, displaced by formulas of this file's own, and on what they must
// not change.
#include "riffler/brush/brush_dabs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "dexel/ends.hpp"
#include "dexel/solids.hpp"
#include "dexel/volumes.hpp"
#include "riffler/base/error.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/dexel/boolean.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/dexel/quadrics.hpp"
#include "support/error_of.hpp"

namespace riffler::brush::brush_dabs_test {
namespace {

using dexel::Frame;
using dexel::Grid;
using dexel::Span;
using test::error_of;
using test::expect_sound;
using test::for_each_end;

constexpr Kind kAll[] = {Kind::Clay, Kind::Inflate,   Kind::Flatten, Kind::Scrape, Kind::Fill,
                         Kind::Grab, Kind::SnakeHook, Kind::Pinch,   Kind::Crease, Kind::Twist};

struct Case {
  Kind kind;
  Vec3 centre, axis, target;
  double radius, strength, amount;
  Falloff falloff = Falloff::Smooth;

  std::vector<Pose> dabs() const {
    std::vector<Pose> out{{centre, axis}};
    if (pulls()) out.push_back({target, axis});
    return out;
  }
  bool pulls() const { return kind == Kind::Grab || kind == Kind::SnakeHook; }
  BrushOptions options() const { return {kind, radius, strength, amount, falloff, nullptr, {}}; }
  BrushResult apply(Volume& volume) const { return brush_dabs(volume, dabs(), options()); }
  /// Distance from where the brush acts: negative inside.
  double outside(const Vec3& p) const {
    const Vec3 d = pulls() ? target - centre : Vec3(0);
    const double s = glm::dot(d, d) > 0 ? std::clamp(glm::dot(p - centre, d) / glm::dot(d, d), 0.0, 1.0) : 0;
    return glm::distance(p, centre + s * d) - radius;
  }
  /// The displacement of a point with a normal, as the header has it. Not for brushes with a plane.
  Vec3 moved_by(const Vec3& p, const Vec3& n) const {
    const double x = std::max(0.0, 1 - glm::distance(p, centre) / radius);
    const double f =
        strength * (falloff == Falloff::Smoother ? x * x * x * (x * (6 * x - 15) + 10) : x * x * (3 - 2 * x));
    const double s = std::clamp(2 * glm::dot(n, axis), 0.0, 1.0), faces = 3 * s * s - 2 * s * s * s;
    const Vec3 r = p - centre, along = glm::dot(r, axis) * axis, off = r - along;
    switch (kind) {
      case Kind::Clay:
        return f * amount * faces * axis;
      case Kind::Inflate:
        return f * amount * n;
      case Kind::Grab:
      case Kind::SnakeHook:
        return f * (target - centre);
      case Kind::Pinch:
        return -f / 2 * off;
      case Kind::Crease:
        return -f / 2 * off + f * f / strength * amount * faces * axis;
      case Kind::Twist: {  // Rodrigues
        const double a = f * amount;
        return off * std::cos(a) + glm::cross(axis, off) * std::sin(a) - off;
      }
      default:
        return Vec3(0);
    }
  }
};

/// A case of each brush at a place of a surface.
Case case_of(Kind kind, const Vec3& centre, const Vec3& axis, double radius) {
  const double size = kind == Kind::Twist ? 0.9 : kind == Kind::Crease ? -0.15 * radius : 0.15 * radius;
  const Vec3 side = glm::normalize(glm::cross(axis, Vec3(0.3, 0.5, 0.8)));
  return {kind, centre, axis, centre + radius * (0.25 * axis + 0.2 * side), radius, 0.8, size};
}

/// The ends of all rays outside of where a case acts are the same bits, in the same order.
void expect_same_outside(const Volume& a, const Volume& b, const Case& c) {
  std::vector<double> ends[2];
  std::vector<dexel::PackedNormal> normals[2];
  for (int k = 0; k < 2; ++k)
    for (const Grid& grid : (k == 0 ? a : b).grids())
      for (int i = 0; i < grid.nu(); ++i)
        for (int j = 0; j < grid.nv(); ++j)
          for (std::size_t s = 0; s < grid.ray(i, j).size(); ++s)
            for (const bool far : {false, true}) {
              const Span& span = grid.ray(i, j)[s];
              const double w = far ? span.far : span.near;
              if (c.outside(to_world(grid.axis(), {grid.u(i), grid.v(j), w})) < 1e-9 * c.radius) continue;
              ends[k].push_back(w);
              normals[k].push_back(far ? grid.ray_normals(i, j)[s].far : grid.ray_normals(i, j)[s].near);
            }
  EXPECT_EQ(ends[0], ends[1]);
  EXPECT_EQ(normals[0], normals[1]);
}

/// A surface in closed form: its nearest point, and the normal there.
struct Surface {
  std::function<Vec3(const Vec3&)> nearest, normal;
};

Surface sphere_surface(const Vec3& centre, double radius) {
  return {[=](const Vec3& p) { return centre + radius * glm::normalize(p - centre); },
          [=](const Vec3& p) { return glm::normalize(p - centre); }};
}

Surface plane_surface(const Vec3& point, const Vec3& normal) {
  return {[=](const Vec3& p) { return p - glm::dot(p - point, normal) * normal; }, [=](const Vec3&) { return normal; }};
}

/// Distance of `p` from the displaced surface, along the surface's normal: the point q of it that moves to p is a fixed
/// point.
double deviation(const Vec3& p, const Surface& surface, const Case& c) {
  Vec3 q = surface.nearest(p);
  for (int step = 0; step < 300; ++step) {
    const Vec3 next = surface.nearest(p - c.moved_by(q, surface.normal(q)));
    if (glm::distance(next, q) < 1e-13 * c.radius) break;
    q = 0.5 * (q + next);
  }
  return glm::distance(p, q + c.moved_by(q, surface.normal(q)));
}

double largest_deviation(const Volume& volume, const Surface& surface, const Case& c) {
  double most = 0;
  for_each_end(volume, [&](const Vec3& p, const Vec3&) {
    if (c.outside(p) < 0) most = std::max(most, deviation(p, surface, c));
  });
  return most;
}

TEST(BrushDabs, MoveASphereAsTheirFormulasDo) {
  const Vec3 centre(0.03, -0.02, 0.05);
  const Vec3 axis = glm::normalize(Vec3(0.2, 0.3, 0.9)), aside = glm::normalize(axis + Vec3(0.2, -0.1, 0));
  for (const Kind kind : kAll) {
    if (kind == Kind::Flatten || kind == Kind::Scrape || kind == Kind::Fill) continue;
    for (const double h : {0.5, 0.25}) {
      // Twist about an axis that is not the sphere's own, or nothing would change.
      Case c = case_of(kind, centre + 12.0 * axis, kind == Kind::Twist ? aside : axis, 6);
      c.falloff = Falloff::Smoother;  // its curvature has no jump at the rim
      Volume volume = dexel::sphere({centre, 12}, {{Vec3(-16), Vec3(16)}, h, "xyz"});
      const Volume before = volume;
      c.apply(volume);
      // The curvature of the sphere, and of the falloff: at most 5.8 / R² of the largest displacement.
      const double size = c.pulls() ? glm::distance(c.target, c.centre) : 0.15 * c.radius;
      const double curvature = 1.0 / 12 + 5.8 * size / (c.radius * c.radius);
      EXPECT_LT(largest_deviation(volume, sphere_surface(centre, 12), c), 0.25 * h * h * curvature)
          << "of kind " << static_cast<int>(kind);
      expect_same_outside(before, volume, c);
      if (h == 0.5) expect_sound(volume);
    }
  }
}

TEST(BrushDabs, RaiseATiltedPlaneByTheVolumeOfTheFalloffAlsoFarFromTheOrigin) {
  for (const Vec3& origin : {Vec3(0), Vec3(1e5, -1e5, 1e5)})
    for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0.1, 0.2, 1), Vec3(-0.4, 0.7, 0.9)}) {
      const Vec3 normal = glm::normalize(direction), middle = origin + Vec3(10.03, 9.98, 10.01);
      Volume volume = test::convex({{origin, origin + Vec3(20)}, 0.25, "xyz"}, {test::HalfSpace::at(middle, normal)});
      const Volume before = volume;
      const Case c{Kind::Clay, middle, normal, middle, 5, 1, 0.7};
      const BrushResult made = c.apply(volume);
      // At the rim the curvature jumps by 6 amount / R²: a pitch across it misses an eighth of h² times that.
      EXPECT_LT(largest_deviation(volume, plane_surface(middle, normal), c), 2 * 0.25 * 0.25 / 8 * 6 * 0.7 / 25);
      // ∫ of 3p² − 2p³ over the disc: 0.3 π R².
      const double expected = 0.7 * 0.3 * std::numbers::pi * 25;
      EXPECT_NEAR(made.added / expected, 1, 2e-3);
      EXPECT_NEAR(made.added - made.removed, volume.volume() - before.volume(), 1e-6 * expected);
      EXPECT_LT(made.removed, 1e-5 * expected);
      expect_same_outside(before, volume, c);
    }
}

TEST(BrushDabs, AddUpOverManyDabsAndKeepDetailAsFineAsThePitch) {
  // Clay along z on a floor with grooves of a pitch: every ray along z rises as its own end does.
  constexpr double h = 0.5, radius = 5, amount = 0.05;
  constexpr int dabs = 50;
  const Frame frame{{Vec3(0), Vec3(20, 20, 12)}, h, "xyz"};
  for (const bool rough : {false, true}) {
    Volume volume = test::convex(frame, {test::HalfSpace::at(Vec3(0, 0, 6.1), Vec3(0, 0, 1))});
    if (rough)
      for (double x = 0.4; x < 20; x += 1.7)
        dexel::apply(dexel::Boolean::Subtract, volume,
                     test::convex(frame, {test::HalfSpace::at(Vec3(x, 0, 0), Vec3(-1, 0, 0)),
                                          test::HalfSpace::at(Vec3(x + 0.8, 0, 0), Vec3(1, 0, 0)),
                                          test::HalfSpace::at(Vec3(0, 0, 5.8), Vec3(0, 0, -1))}));
    const Volume before = volume;
    const Vec3 centre(10.1, 9.9, 6.1);
    const Case c{Kind::Clay, centre, Vec3(0, 0, 1), Vec3(0), radius, 1, amount};
    for (int k = 0; k < dabs; ++k) c.apply(volume);
    expect_sound(volume);
    double most = 0, sum = 0;
    int count = 0;
    const Grid &a = *before.grid(Axis::Z), &b = *volume.grid(Axis::Z);
    for (int i = 0; i < a.nu(); ++i)
      for (int j = 0; j < a.nv(); ++j) {
        ASSERT_FALSE(a.ray(i, j).empty());
        double z = a.ray(i, j).back().far;
        for (int k = 0; k < dabs; ++k) z += c.moved_by({a.u(i), a.v(j), z}, Vec3(0, 0, 1)).z;
        const double off = std::abs(b.ray(i, j).back().far - z);
        most = std::max(most, off), sum += off, ++count;
      }
    EXPECT_LT(most, (rough ? 0.8 : 0.02) * h);
    EXPECT_LT(sum / count, 0.01 * h);
  }
}

TEST(BrushDabs, FlattenACapToItsMeanPlane) {
  const Vec3 axis = glm::normalize(Vec3(0.1, -0.2, 1));
  constexpr double size = 15, radius = 7, h = 0.25;
  // The plane's height: mean over the cap, weighted by the falloff, in rings of the polar angle; it faces the axis.
  double weights = 0, heights = 0;
  for (double a = 0.0005; a < 1; a += 0.001) {
    const double x = 1 - 2 * size * std::sin(a / 2) / radius;
    if (x <= 0) break;
    const double w = x * x * (3 - 2 * x) * std::sin(a);
    weights += w, heights += w * size * std::cos(a);
  }
  const double plane = heights / weights;
  for (const Kind kind : {Kind::Flatten, Kind::Scrape, Kind::Fill}) {
    Volume volume = dexel::sphere({Vec3(0), size}, {{Vec3(-17), Vec3(17)}, h, "xyz"});
    const Volume before = volume;
    const Case c{kind, size * axis, axis, Vec3(0), radius, 1, 0};
    const BrushResult made = c.apply(volume);
    expect_same_outside(before, volume, c);
    expect_sound(volume);
    double above = -1e300;
    for_each_end(volume, [&](const Vec3& p, const Vec3&) {
      if (glm::distance(p, size * axis) < 0.2 * radius) above = std::max(above, glm::dot(p, axis) - plane);
    });
    if (kind == Kind::Fill)
      EXPECT_GT(above, 0.9 * (size - plane)) << "the top stays";
    else
      EXPECT_LT(std::abs(above), 0.1 * (size - plane)) << "the middle is flat";
    EXPECT_LT(kind == Kind::Fill ? made.removed : 0, 0.01 * made.added + 1e-3);
    EXPECT_LT(kind == Kind::Scrape ? made.added : 0, 0.01 * made.removed + 1e-3);
    EXPECT_GT(made.added + made.removed, 1);
  }
}

/// A block with edges, grooves and a thin wall.
Volume workpiece(double h = 0.5) {
  const Frame frame{{Vec3(0), Vec3(30, 24, 20)}, h, "xyz"};
  const auto slab = [&](const Vec3& lower, const Vec3& upper) {
    std::vector<test::HalfSpace> sides;
    for (int k = 0; k < 3; ++k) {
      Vec3 n(0);
      n[k] = 1;
      sides.push_back(test::HalfSpace::at(upper, n)), sides.push_back(test::HalfSpace::at(lower, -n));
    }
    return test::convex(frame, sides);
  };
  Volume out = slab(Vec3(3.1, 3.1, -1), Vec3(27.2, 20.9, 12.3));
  dexel::apply(dexel::Boolean::Subtract, out, slab(Vec3(8, -1, 10.1), Vec3(11.4, 30, 30)));
  dexel::apply(dexel::Boolean::Add, out, slab(Vec3(20, 6, 12), Vec3(22.3, 18, 17)));
  dexel::apply(dexel::Boolean::Add, out, slab(Vec3(15.55, 6, 12), Vec3(15.9, 18, 16)));  // a wall of 0.7 h
  return out;
}

TEST(BrushDabs, ChangeNothingOutsideAndKeepTheMeshClosedOnEdgesGroovesAndWalls) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> d(-1, 1);
  const Volume whole = workpiece();
  for (int round = 0; round < 4; ++round)
    for (const Kind kind : kAll) {
      const Vec3 centre = Vec3(15, 12, 12) + Vec3(11, 9, 4) * Vec3(d(random), d(random), d(random));
      Case c = case_of(kind, centre, glm::normalize(Vec3(d(random), d(random), 1.2)), 2.5 + 2 * d(random));
      c.falloff = static_cast<Falloff>(random() % kFalloffs);
      Volume volume = whole;
      const BrushResult made = c.apply(volume);
      expect_same_outside(whole, volume, c);
      expect_sound(volume);
      EXPECT_NEAR(made.added - made.removed, volume.volume() - whole.volume(), 1e-6);
      EXPECT_EQ(made.lost > 0, made.lost > 1e-9);
    }
}

TEST(BrushDabs, MakeTheSameBytesForAnyNumberOfThreads) {
  std::vector<std::uint8_t> bytes;
  const int before = base::thread_count();
  for (const int threads : {1, 2, 4}) {
    base::set_thread_count(threads);
    Volume volume = workpiece();
    for (const Kind kind : kAll) case_of(kind, Vec3(14, 12, 12.3), Vec3(0, 0, 1), 4).apply(volume);
    const std::vector<std::uint8_t> now = dexel::to_bytes(volume);
    if (bytes.empty()) bytes = now;
    EXPECT_EQ(now, bytes);
  }
  base::set_thread_count(before);
}

TEST(BrushDabs, DoNothingAtTheDegenerateLimits) {
  const Volume whole = workpiece();
  for (const Kind kind : kAll) {
    const auto unchanged = [&](Case c) {
      Volume volume = whole;
      const BrushResult made = c.apply(volume);
      EXPECT_EQ(volume.revision(), whole.revision()) << "kind " << static_cast<int>(kind);
      EXPECT_EQ(made.added + made.removed + made.lost, 0);
    };
    Case c = case_of(kind, Vec3(14, 12, 12.3), Vec3(0, 0, 1), 4);
    Case still = c, weak = c, far = c, below = c, inside = c;
    still.amount = 0, still.target = still.centre;
    weak.strength = 0;
    far.centre += Vec3(1e4), far.target += Vec3(1e4);
    below.centre = Vec3(14, 12, -30), below.target = Vec3(14, 12, -31);
    inside.centre = Vec3(17, 12, 5), inside.target = Vec3(17.2, 12, 5.2), inside.radius = 2;
    for (const Case& k : {weak, far, below, inside}) unchanged(k);
    if (kind == Kind::Clay || kind == Kind::Inflate || kind == Kind::Twist || c.pulls()) unchanged(still);
    Volume tiny = whole;
    Case small = c;
    small.radius = 0.01;
    small.apply(tiny);
    EXPECT_NEAR(tiny.volume(), whole.volume(), 1e-3);
    expect_sound(tiny);
  }
}

TEST(BrushDabs, KeepAWallThinnerThanThePitchWhereItMovesAlongItsNormal) {
  const Volume whole = workpiece();
  Volume volume = whole;
  const Case c{Kind::Clay, Vec3(15.7, 12, 12), Vec3(0, 0, 1), Vec3(0), 5, 1, 0.1};
  const BrushResult made = c.apply(volume);
  EXPECT_EQ(made.lost, 0);
  EXPECT_GT(made.added, 0);
  double before = 0, after = 0;  // of the wall, along x
  const Grid &a = *whole.grid(Axis::X), &b = *volume.grid(Axis::X);
  for (int i = 0; i < a.nu(); ++i)
    for (int j = 0; j < a.nv(); ++j)
      for (const auto& [grid, sum] : {std::pair{&a, &before}, std::pair{&b, &after}})
        for (const Span& s : grid->ray(i, j))
          if (grid->v(j) > 13 && s.length() < 0.5) *sum += s.length();
  EXPECT_NEAR(after / before, 1, 0.02);
}

TEST(BrushDabs, LeaveProtectedMaterialUnchanged) {
  const Volume whole = workpiece();
  const Volume kept = test::convex(whole.frame(), {test::HalfSpace::at(Vec3(14, 0, 0), Vec3(1, 0, 0))});
  for (const Kind kind : kAll) {
    Volume volume = whole;
    const Case c = case_of(kind, Vec3(14, 12, 12.3), Vec3(0, 0, 1), 5);
    BrushOptions options = c.options();
    options.protect = &kept;
    brush_dabs(volume, c.dabs(), options);
    Volume a = volume, b = whole;
    dexel::apply(dexel::Boolean::Intersect, a, kept), dexel::apply(dexel::Boolean::Intersect, b, kept);
    EXPECT_TRUE(test::same_spans(a, b)) << "kind " << static_cast<int>(kind);
  }
}

TEST(BrushDabs, ReportMaterialThatTheBoxCutsOff) {
  const Frame frame{{Vec3(0), Vec3(20, 20, 10)}, 0.5, "xyz"};
  Volume volume = Volume::block(frame);
  const double full = volume.volume();
  const BrushResult made = Case{Kind::Clay, Vec3(10, 10, 10), Vec3(0, 0, 1), Vec3(0), 4, 1, 1}.apply(volume);
  EXPECT_TRUE(made.clipped);
  EXPECT_NEAR(volume.volume(), full, 1e-9 * full);
  Volume dug = Volume::block(frame);
  EXPECT_FALSE((Case{Kind::Clay, Vec3(10, 10, 10), Vec3(0, 0, 1), Vec3(0), 4, 1, -1}.apply(dug).clipped));
  EXPECT_LT(dug.volume(), full);
  expect_sound(dug);
}

TEST(BrushDabs, RefuseBadArguments) {
  Volume volume = workpiece(1), flat = Volume::block({{Vec3(0), Vec3(10)}, 1, "z"});
  const Volume other = workpiece(0.8);
  const auto refused = [&](Volume& v, Pose pose, auto&& change) {
    BrushOptions options;
    change(options);
    const std::uint64_t revision = v.revision();
    const std::string why = error_of([&] { brush_dabs(v, std::vector<Pose>{{}, pose}, options); });
    EXPECT_EQ(v.revision(), revision);
    return why;
  };
  const auto nothing = [](BrushOptions&) {};
  EXPECT_EQ(refused(flat, {}, nothing),
            "brush needs a volume of directions \"xyz\", whose ends have normals; this one has \"z\"");
  EXPECT_EQ(refused(volume, {Vec3(NAN, 0, 0), Vec3(0, 0, 1)}, nothing), "dabs, row 1: not finite");
  EXPECT_EQ(refused(volume, {Vec3(0), Vec3(0, 0, 2)}, nothing), "dabs, row 1: the axis must be a unit vector");
  EXPECT_EQ(refused(volume, {}, [](auto& o) { o.radius = 0; }), "radius must be a positive length in mm");
  EXPECT_EQ(refused(volume, {}, [](auto& o) { o.strength = 1.1; }), "strength must be from 0 to 1");
  EXPECT_NE(refused(volume, {}, [](auto& o) { o.amount = INFINITY; }), "");
  EXPECT_NE(refused(volume, {}, [&](auto& o) { o.protect = &other; }), "");
}

TEST(BrushDabs, LeaveTheVolumeUnchangedWhenCancelled) {
  Volume volume = workpiece();
  const std::uint64_t revision = volume.revision();
  BrushOptions options;
  options.radius = 4, options.amount = 1;
  int calls = 0;
  options.progress = [&](double) { return ++calls < 2; };
  const std::vector<Pose> dabs(4, Pose{Vec3(14, 12, 12.3), Vec3(0, 0, 1)});
  EXPECT_THROW(brush_dabs(volume, dabs, options), base::Cancelled);
  EXPECT_EQ(volume.revision(), revision);
}

}  // namespace
}  // namespace riffler::brush::brush_dabs_test
