#include "riffler/sweep/carve.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <random>

#include "dexel/volumes.hpp"
#include "reference/swept_distance.hpp"
#include "riffler/sweep/move_carver.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::sweep::carve_test {
namespace {

struct Named {
  const char* name;
  Tool tool;
};

/// A flank of radius 20 whose centre lies beyond the axis.
Tool barrel() {
  const Vec2 from{1, 0}, to{3, 6}, chord = to - from, across = glm::normalize(Vec2(-chord.y, chord.x));
  const Vec2 centre = (from + to) / 2.0 + across * std::sqrt(400 - glm::dot(chord, chord) / 4);
  return cutters::profile({{from, {}}, {to, centre}, {{3.2, 8}, {}}}, 20);
}

std::vector<Named> cutters_under_test() {
  return {{"ball", cutters::ball(6, 30)},
          {"flat", cutters::flat(6, 30)},
          {"fillet", cutters::fillet(8, 1, 30)},
          {"taper with ball tip", cutters::taper(0.5, 0.2, 8, 40)},
          {"taper with flat tip", cutters::taper(1, 0.4, 8, 40, true)},
          {"cone end", cutters::cone_end(1.0, 1, 0.4, 8, 40)},
          {"short ball", cutters::ball(6, 3)},
          {"barrel", barrel()},
          {"corner rounder", cutters::profile({{{1, 0}, {}}, {{1, 1}, {}}, {{4, 4}, Vec2(4, 1)}}, 12)}};
}

struct Path {
  const char* name;
  Pose from, to;
};

Vec3 unit(double x, double y, double z) {
  return glm::normalize(Vec3(x, y, z));
}

std::vector<Path> straight_paths() {
  const Vec3 up{0, 0, 1}, tilted = unit(0.3, -0.5, 1), flat = {1, 0, 0}, down = unit(0.2, 0.1, -1);
  return {{"no motion", {{10.1, 9.3, 4}, up}, {{10.1, 9.3, 4}, up}},
          {"no motion, tilted", {{10.1, 9.3, 4}, tilted}, {{10.1, 9.3, 4}, tilted}},
          {"level", {{4, 9.3, 4}, up}, {{15, 11, 4}, up}},
          {"plunge", {{10.1, 9.3, 12}, up}, {{10.1, 9.3, 4}, up}},
          {"ramp", {{4, 9.3, 9}, up}, {{15, 11, 4}, up}},
          {"along a tilted axis", {Vec3(10, 9, 4) + 6.0 * tilted, tilted}, {{10, 9, 4}, tilted}},
          {"tilted, level", {{4, 9.3, 4}, tilted}, {{15, 11, 4}, tilted}},
          {"tilted, upwards", {{4, 9.3, 4}, tilted}, {{9, 8, 11}, tilted}},
          {"axis level", {{4, 9.3, 6}, flat}, {{5, 14, 8}, flat}},
          {"axis level, along it", {{4, 9.3, 6}, flat}, {{9, 9.3, 6}, flat}},
          {"axis level, in its plane", {{4, 9.3, 6}, flat}, {{7, 9.3, 11}, flat}},
          {"spindle below", {{9, 9.3, 6}, down}, {{12, 9, 9}, down}},
          // So near to the floor that of some cutters only the lowest piece is in the stock.
          {"spindle below, shallow", {{6, 9.3, 4}, down}, {{15, 11, 5}, down}},
          {"upside down, shallow", {{6, 9.3, 5}, -up}, {{15, 11, 5}, -up}},
          {"tiny", {{10, 9, 4}, tilted}, {{10 + 1e-12, 9, 4}, tilted}}};
}

std::vector<Path> turning_paths() {
  const Vec3 up{0, 0, 1};
  const auto about = [](double angle) { return Vec3(std::sin(angle), 0, std::cos(angle)); };
  const Vec3 pivot{10, 9, 54};
  return {{"1e-12 rad", {{9, 9, 4}, up}, {{12, 10, 4}, unit(1e-12, 0, 1)}},
          {"1e-9 rad", {{9, 9, 4}, up}, {{12, 10, 4}, unit(1e-9, 0, 1)}},
          {"rotation about the tip, 10°", {{10, 9, 4}, up}, {{10, 9, 4}, about(0.1745)}},
          {"rotation about the tip, 60°", {{10, 9, 4}, about(-0.5)}, {{10, 9, 4}, about(0.547)}},
          {"rotation about the tip, 120°", {{10, 9, 4}, about(-1)}, {{10, 9, 4}, about(1.0944)}},
          {"rotation about a pivot 50 mm up",
           {pivot - 50.0 * about(-0.1), about(-0.1)},
           {pivot - 50.0 * about(0.1), about(0.1)}},
          {"translation with rotation", {{4, 9, 4}, unit(-0.2, 0.1, 1)}, {{15, 11, 5}, unit(0.3, 0.2, 1)}},
          {"plunge with rotation", {{10, 9, 10}, unit(-0.2, 0.1, 1)}, {{10, 9, 3}, unit(0.1, 0.2, 1)}}};
}

/// Every interval end of the carved block and points all along the rays, against the reference. Where the surface is
/// not nearly parallel to the ray the end is also measured along the ray.
void expect_carved_right(const Tool& tool, const Path& path, double tolerance, double along_tolerance, double concave) {
  const dexel::Frame frame{{{0, 0, 0}, {20, 19, 14}}, 1.37, "xyz"};
  Volume volume = Volume::block(frame);
  const std::vector<Pose> poses{path.from, path.to};
  CarveOptions options;
  options.tolerance = along_tolerance > 0 ? along_tolerance : 0.01;
  carve(volume, tool, poses, options);
  const reference::SweptDistance swept(tool.profile(), Motion(path.from, path.to));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  const double exact = along_tolerance > 0 ? tolerance : tolerance + concave;
  for (const dexel::Grid& grid : volume.grids()) {
    const double lower = grid.box().lower.z, upper = grid.box().upper.z;
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        const auto distance = [&](double s) {  // no closer than the comparisons ask
          return swept.bracket(to_world(grid.axis(), {grid.u(i), grid.v(j), s}), exact / 50, 4 * exact).upper;
        };
        const std::span<const dexel::Span> ray = grid.ray(i, j);
        std::vector<double> ends;
        for (const dexel::Span& s : ray) {
          ASSERT_LT(s.near, s.far);
          if (s.near > lower) ends.push_back(s.near);
          if (s.far < upper) ends.push_back(s.far);
        }
        for (const double s : ends) {
          const double off = distance(s);
          ASSERT_LE(std::abs(off), exact) << path.name << ": end " << s << " of ray " << i << ", " << j;
        }
        for (int k = 0; k < 3; ++k) {
          const double s = lower + share(random) * (upper - lower);
          const bool solid =
              std::any_of(ray.begin(), ray.end(), [&](const dexel::Span& x) { return s >= x.near && s <= x.far; });
          const double off = distance(s);
          if (std::abs(off) <= exact) continue;
          ASSERT_EQ(solid, off > 0) << path.name << ": point " << s << " of ray " << i << ", " << j << " is " << off
                                    << " mm outside of the swept volume";
        }
      }
  }
}

TEST(Carve, StraightMovesAreExactForEveryCutter) {
  for (const Named& c : cutters_under_test())
    for (const Path& path : straight_paths()) {
      SCOPED_TRACE(c.name);
      const double concave = std::string(c.name) == "corner rounder" ? tool::Profile::kConcaveTolerance : 0;
      expect_carved_right(c.tool, path, 3e-9, 0, concave);
    }
}

TEST(Carve, TurningMovesKeepTheToleranceForEveryCutter) {
  for (const Named& c : cutters_under_test())
    for (const Path& path : turning_paths())
      for (const double tolerance : {0.1, 0.01}) {
        SCOPED_TRACE(c.name);
        expect_carved_right(c.tool, path, tolerance, tolerance, 0);
      }
}

TEST(Carve, RemovedSumsToTheLossOfVolume) {
  for (const char* directions : {"z", "xyz", "x", "y"}) {
    Volume volume = Volume::block({{{0, 0, 0}, {30, 20, 10}}, 0.5, directions});
    const double before = volume.volume();
    std::vector<Pose> poses;
    for (int k = 0; k <= 20; ++k)
      poses.push_back({{2 + 1.3 * k, 10 + 3 * std::sin(k), 4 + std::cos(k)}, unit(0.1 * std::sin(k), 0.1, 1)});
    const Cut cut = carve(volume, cutters::fillet(4, 0.5, 20), poses);
    double sum = 0;
    for (const double r : cut.removed) sum += r;
    EXPECT_GT(sum, 100);
    EXPECT_NEAR(sum, before - volume.volume(), 1e-9 * before);
  }
}

/// B200 of the benchmark jobs: the volume that is left when a ball end mill that reaches out of the block has passed.
TEST(Carve, TheRampingJobLeavesTheKnownVolume) {
  Volume volume = Volume::block({{{0, 0, 0}, {100, 60, 30}}, 0.25, "z"});
  std::vector<Pose> poses;
  for (int k = 0; k <= 200; ++k) {
    const double a = k / 200.0;
    poses.push_back({{10 + 80 * a, 30 + 15 * std::sin(12 * a), 27 - 2 * a}, {0, 0, 1}});
  }
  carve(volume, cutters::ball(6, 30), poses);
  EXPECT_NEAR(volume.volume(), 177055.25, 1.0);
}

TEST(Carve, GivesTheSameBytesForAnyNumberOfThreads) {
  std::vector<Pose> poses;
  for (int k = 0; k <= 100; ++k)
    poses.push_back({{5 + 0.3 * k, 20 + 10 * std::sin(0.05 * k), 5 + std::cos(0.1 * k)},
                     unit(0.3 * std::sin(0.07 * k), 0.2 * std::cos(0.03 * k), 1)});
  std::vector<Volume> volumes;
  std::vector<Cut> cuts;
  for (const char* threads : {"1", "2", "4"}) {
    setenv("RIFFLER_THREADS", threads, 1);
    volumes.push_back(Volume::block({{{0, 0, 0}, {40, 40, 12}}, 0.3, "xyz"}));
    CarveOptions options;
    options.dt.assign(100, 0.001);
    cuts.push_back(carve(volumes.back(), cutters::fillet(5, 1, 20), poses, options));
  }
  unsetenv("RIFFLER_THREADS");
  for (int k = 1; k < 3; ++k) {
    EXPECT_EQ(cuts[0].removed, cuts[k].removed);
    EXPECT_EQ(cuts[0].force, cuts[k].force);
    EXPECT_EQ(cuts[0].torque, cuts[k].torque);
    for (int g = 0; g < 3; ++g)
      for (std::size_t t = 0; t < volumes[0].grids()[g].tile_count(); ++t) {
        EXPECT_EQ(volumes[0].grids()[g].tile(t).spans, volumes[k].grids()[g].tile(t).spans);
        EXPECT_EQ(volumes[0].grids()[g].tile(t).normals, volumes[k].grids()[g].tile(t).normals);
        EXPECT_EQ(volumes[0].grids()[g].tile(t).offset, volumes[k].grids()[g].tile(t).offset);
      }
  }
}

TEST(Carve, GivesTheSameBytesForBothSignsOfZero) {
  for (const Vec3& axis : {Vec3(0, 0, 1), unit(0.3, 0, 1), unit(0, -0.2, 1)}) {
    std::vector<Volume> volumes;
    for (const double zero : {0.0, -0.0}) {
      Vec3 signed_axis = axis;
      for (int i = 0; i < 3; ++i)
        if (axis[i] == 0) signed_axis[i] = zero;
      volumes.push_back(Volume::block({{{0, 0, 0}, {30, 30, 10}}, 0.5, "xyz"}));
      const std::vector<Pose> poses{
          {{5, zero, 8}, signed_axis}, {{20, 18, 7}, signed_axis}, {{zero, 9, 8.5}, signed_axis}};
      carve(volumes.back(), cutters::flat(3, 30), poses);
    }
    EXPECT_TRUE(test::same_rays(volumes[0], volumes[1])) << axis.x << ' ' << axis.y;
  }
}

TEST(Carve, WorkFollowsTheFootprintAndNotTheGrid) {
  std::uint64_t tested[2];
  int k = 0;
  for (const double side : {102.4, 409.6}) {  // 1024² and 4096² rays
    Volume volume = Volume::block({{{0, 0, 0}, {side, side, 10}}, 0.1, "z"});
    const std::vector<Pose> poses{{{50, 50, 8}, {0, 0, 1}}, {{52, 50, 8}, {0, 0, 1}}};
    carve(volume, cutters::ball(6, 30), poses);
    tested[k++] = volume.take_stats().rays_tested;
  }
  EXPECT_EQ(tested[0], tested[1]);
  EXPECT_GT(tested[0], 1000);
}

TEST(Carve, ForceDoesNotDependOnTheSamplingRateOrThePitch) {
  // A slot of known cross-section at constant speed: removal rate × constant, against the motion.
  const Tool tool = cutters::flat(6, 20);
  for (const double pitch : {0.4, 0.2, 0.1})
    for (const int rate : {100, 500, 1000}) {
      Volume volume = Volume::block({{{0, 0, 0}, {40, 20, 10}}, pitch, "z"});
      const int moves = rate / 10;  // 0.1 s at 50 mm/s: 5 mm
      std::vector<Pose> poses;
      for (int k = 0; k <= moves; ++k) poses.push_back({{15 + 5.0 * k / moves, 10, 8}, {0, 0, 1}});
      const std::vector<Pose> lead_in{{{10, 10, 8}, {0, 0, 1}}, {{15, 10, 8}, {0, 0, 1}}};
      carve(volume, tool, lead_in);
      CarveOptions options;
      options.dt.assign(moves, 1.0 / rate);
      options.removal_constant = 0.05;
      const Cut cut = carve(volume, tool, poses, options);
      Vec3 mean{0};
      for (const Vec3& f : cut.force) mean += f / static_cast<double>(moves);
      const double expected = 0.05 * 6 * 2 * 50;  // k · width · depth · speed
      EXPECT_NEAR(mean.x, -expected, 0.05 * expected) << pitch << " mm, " << rate << " Hz";
      EXPECT_NEAR(mean.y, 0, 1e-9 * expected);
      EXPECT_NEAR(mean.z, 0, 1e-9 * expected);
    }
}

TEST(Carve, ForceActsAgainstThePlungeAndTorqueAboutTheTip) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.2, "z"});
  const std::vector<Pose> poses{{{10, 10, 12}, {0, 0, 1}}, {{10, 10, 5}, {0, 0, 1}}};
  CarveOptions options;
  options.dt = {0.1};
  const Cut cut = carve(volume, cutters::flat(6, 20), poses, options);
  EXPECT_NEAR(cut.force[0].z, 0.05 * cut.removed[0] / 0.1, 1e-9);
  EXPECT_NEAR(cut.torque[0].x, 0, 1e-6);
  EXPECT_NEAR(cut.torque[0].y, 0, 1e-6);
}

/// Fills the stack below, where the kernels have their places next.
[[gnu::noinline]] double fill_stack(double value) {
  volatile double places[1 << 16];
  for (volatile double& place : places) place = value;
  return places[1];
}

TEST(Carve, ForceComesOnlyFromRaysThatAreCut) {
  // As a time, this takes one coordinate of the tool beyond all numbers, and none of the others.
  const double never = 8e307;
  const std::vector<Pose> poses{{{3, 7, 6}, glm::normalize(Vec3(0.1, 0.2, 1))},
                                {{11, 7.005, 5.999}, glm::normalize(Vec3(0.3, -0.2, 1))}};
  for (const Tool& tool : {cutters::flat(6, 0.3), cutters::fillet(6, 1, 30)}) {
    Volume volume = Volume::block({{{0, 0, 0}, {15, 15, 10}}, 0.7, "z"});
    CarveOptions options;
    options.dt = {0.001};
    EXPECT_EQ(fill_stack(never), never);
    const Cut cut = carve(volume, tool, poses, options);
    EXPECT_GT(cut.removed[0], 1);
    EXPECT_TRUE(geom::finite(cut.force[0]) && geom::finite(cut.torque[0])) << tool.kind();
  }
}

TEST(Carve, StandingToolThatRemovesMaterialIsPushedOutAlongItsAxis) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.5, "z"});
  const Pose pose{{10, 10, 5}, {0, 0, 1}};
  CarveOptions options;
  options.dt = {0.1};
  const Cut cut = carve(volume, cutters::ball(6, 20), std::vector<Pose>{pose, pose}, options);
  EXPECT_GT(cut.removed[0], 0);
  EXPECT_GT(cut.force[0].z, 0);
}

TEST(Carve, BadInputNamesTheRowAndChangesNothing) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.5, "z"});
  const auto revision = volume.revision();
  const Tool tool = cutters::ball(6, 20);
  const Pose good{{10, 10, 5}, {0, 0, 1}};
  const double nan = std::nan("");
  const auto refused = [&](std::vector<Pose> poses, const std::string& words, CarveOptions options = {}) {
    try {
      carve(volume, tool, poses, options);
      ADD_FAILURE() << words;
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
  };
  refused({good, {{nan, 0, 0}, {0, 0, 1}}}, "row 1");
  refused({good, good, {{0, 0, 0}, {0, 0, 0}}}, "row 2");
  refused({good, {{10, 10, 5}, {0, 0, -1}}}, "opposite");
  refused({good, good}, "tolerance", {.tolerance = 0, .dt = {}, .removal_constant = 0.05, .progress = {}});
  refused({good, good}, "dt", {.tolerance = 0.01, .dt = {0.0}, .removal_constant = 0.05, .progress = {}});
  EXPECT_EQ(volume.revision(), revision);
  EXPECT_EQ(volume.volume(), 4000);
}

TEST(Carve, CancellingLeavesTheVolumeUnchanged) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 10}}, 0.5, "xyz"});
  const auto revision = volume.revision();
  CarveOptions options;
  options.progress = [](double share) { return share < 0.5; };
  const std::vector<Pose> poses{{{5, 10, 5}, {0, 0, 1}}, {{15, 10, 5}, unit(0.5, 0, 1)}};
  EXPECT_THROW(carve(volume, cutters::ball(6, 20), poses, options), Cancelled);
  EXPECT_EQ(volume.revision(), revision);
  EXPECT_EQ(volume.volume(), 4000);
}

TEST(Carve, KeepsItsAccuracyFarFromTheOrigin) {
  const Vec3 far{1e5, -1e5, 1e5};
  const dexel::Frame near_frame{{{0, 0, 0}, {20, 20, 10}}, 0.5, "z"};
  Volume a = Volume::block(near_frame),
         b = Volume::block({{near_frame.box.lower + far, near_frame.box.upper + far}, 0.5, "z"});
  const std::vector<Pose> poses{{{5, 9, 5}, unit(0.2, 0.1, 1)}, {{15, 11, 6}, unit(0.2, 0.1, 1)}};
  std::vector<Pose> far_poses = poses;
  for (Pose& p : far_poses) p.tip += far;
  carve(a, cutters::fillet(6, 1, 20), poses);
  carve(b, cutters::fillet(6, 1, 20), far_poses);
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      const auto ra = a.grids()[0].ray(i, j), rb = b.grids()[0].ray(i, j);
      ASSERT_EQ(ra.size(), rb.size());
      for (std::size_t k = 0; k < ra.size(); ++k) {
        EXPECT_NEAR(ra[k].near + far.z, rb[k].near, 1e-7);
        EXPECT_NEAR(ra[k].far + far.z, rb[k].far, 1e-7);
      }
    }
}

/// The flat end of a tool that moves along itself: its rim, where a ray may enter, sweeps the same plane.
TEST(Carve, NormalsOfAFlatEndPointIntoTheToolOnLevelMoves) {
  const dexel::Frame frame{{{3.9488098799917686, 2.7637360331994647, 2.2442817433757969},
                            {13.563640305515396, 8.1720781475565047, 12.159575619697037}},
                           0.30046345079761333,
                           "xyz"};
  Volume volume = Volume::block(frame);
  const double z = 8.3871605292757323;
  carve(volume, cutters::flat(3.0050820543096584, 0.15025410271548292),
        std::vector<Pose>{{{13.832509517550406, 3.9998577522044707, z}, {0, 0, 1}},
                          {{11.395255473252305, 5.3230355714018209, z}, {0, 0, 1}}});
  int ends = 0;
  for (const dexel::Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j)
        for (const dexel::SpanNormals& n : grid.ray_normals(i, j)) {
          const int along = static_cast<int>(grid.axis());
          EXPECT_LE(n.near.unpack()[along], 1e-4);
          EXPECT_GE(n.far.unpack()[along], -1e-4);
          ++ends;
        }
  EXPECT_GT(ends, 1000);
}

/// Times are stored in units of 2⁻³⁰, so on a long move an end at the rim is a little off both of its sides.
TEST(Carve, NormalsAtARimAreThoseOfTheSweptVolumeOnLongMoves) {
  Volume volume = Volume::block({{{0, 0, 0}, {27, 27, 32}}, 1, "xyz"});
  const Tool tool = cutters::taper(0.75, 0.42084511404081137, 6, 74.729512242486905, true);
  const Vec3 axis{0.10327472178603501, -0.70585172104732052, -0.70079075317426431}, way{6.4, 0, 0};
  const Pose from{{12.733683212308428, 13.7454958547758, -0.12149844987067659}, axis};
  const Pose to{from.tip + way, axis};
  carve(volume, tool, std::vector<Pose>{from, to});
  const dexel::Grid& grid = volume.grids()[2];
  const Vec3 normal = grid.ray_normals(16, 13)[0].near.unpack();
  const reference::SweptDistance swept(tool.profile(), Motion(from, to));
  const double step = 1e-3;
  const Vec3 p = Vec3(grid.u(16), grid.v(13), grid.ray(16, 13)[0].near) - 3 * step * normal;
  Vec3 gradient;
  for (int k = 0; k < 3; ++k) {
    Vec3 aside(0);
    aside[k] = step;
    gradient[k] = (swept(p + aside) - swept(p - aside)) / (2 * step);
  }
  EXPECT_LT(glm::length(gradient + normal), 1e-4);
}

/// Where a ball becomes its shank, both slide along themselves at the side of a move, but there is no edge.
TEST(Carve, NormalsWhereABallBecomesItsShankAreThoseOfBoth) {
  Volume volume = Volume::block({{{0, 0, 0}, {12, 12, 8}}, 0.5, "xyz"});
  // The shank begins at the height of rays.
  carve(volume, cutters::ball(6, 40), std::vector<Pose>{{{-100, 6, 1.25}, {0, 0, 1}}, {{110.3, 6, 1.25}, {0, 0, 1}}});
  const dexel::Grid& grid = volume.grids()[1];
  int ends = 0;
  for (int i = 0; i < grid.nu(); ++i)
    for (int j = 0; j < grid.nv(); ++j)
      for (std::size_t k = 0; k < grid.ray(i, j).size(); ++k) {
        const dexel::Span& s = grid.ray(i, j)[k];
        const dexel::SpanNormals& n = grid.ray_normals(i, j)[k];
        if (std::abs(s.far - 3) < 1e-6) {
          EXPECT_LT(glm::length(n.far.unpack() - Vec3(0, 1, 0)), 1e-4);
          ++ends;
        }
        if (std::abs(s.near - 9) < 1e-6) {
          EXPECT_LT(glm::length(n.near.unpack() - Vec3(0, -1, 0)), 1e-4);
          ++ends;
        }
      }
  EXPECT_EQ(ends, 2 * 24 * 8);
}

/// On a move as short as rounding, the time at which an end arises is rounding, too.
TEST(Carve, NormalsAfterAMoveAsShortAsRoundingAreThoseOfAToolAtRest) {
  const dexel::Frame frame{{{0, 0, 0}, {14, 9, 6.5}}, 0.5, "xyz"};
  const Vec3 axis{0.26333153762116751, -0.30169841442196088, 0.91631575782005759};
  const Pose from{{8.194890860363348, 4.81873976625797329, 2.0908207558097205}, axis};
  const Tool disc = cutters::flat(6, 0.06);
  Volume still = Volume::block(frame);
  carve(still, disc, std::vector<Pose>{from, from});
  int ends = 0;
  for (const double way : {1e-13, 1e-11, 1e-9, 1e-8})
    for (const Vec3& direction : {Vec3(0, 0, 1), unit(5, 0.2, 0.6), unit(-1, 2, 1), axis}) {
      Volume moved = Volume::block(frame);
      carve(moved, disc, std::vector<Pose>{from, {from.tip + way * direction, axis}});
      for (std::size_t g = 0; g < 3; ++g)
        for (int i = 0; i < still.grids()[g].nu(); ++i)
          for (int j = 0; j < still.grids()[g].nv(); ++j) {
            const auto a = still.grids()[g].ray(i, j), b = moved.grids()[g].ray(i, j);
            if (a.size() != 2 || b.size() != 2) continue;
            const auto at_rest = still.grids()[g].ray_normals(i, j), after = moved.grids()[g].ray_normals(i, j);
            for (const auto& [x, y] : {std::pair{at_rest[0].far, after[0].far}, {at_rest[1].near, after[1].near}}) {
              if (std::abs(glm::dot(x.unpack(), axis)) < 0.999) continue;  // the wall
              EXPECT_LT(glm::length(x.unpack() - y.unpack()), 1e-4) << way << ", grid " << g << ": " << i << ", " << j;
              ++ends;
            }
          }
    }
  EXPECT_GT(ends, 4000);
}

/// Rays in the plane of a flat end where its move starts meet its rim there, an edge of two sides, one of which the
/// move covers at once.
TEST(Carve, NormalsWhereAMoveStartsFaceBackwards) {
  Volume volume = Volume::block({{{0, 0, 0}, {12, 12, 12}}, 0.5, "xyz"});
  const Tool tool = cutters::flat(6, 30);
  const Vec3 axis{-1, 0, 0}, way{0.9, 0, 0.45};
  carve(volume, tool, std::vector<Pose>{{{6.25, 6.25, 6}, axis}, {Vec3(6.25, 6.25, 6) + way, axis}});
  const dexel::Grid& grid = volume.grids()[2];
  int ends = 0;
  for (int j = 0; j < grid.nv(); ++j) {  // x = 6.25
    const auto ray = grid.ray(12, j);
    if (ray.size() != 2) continue;
    const Vec3 out = -grid.ray_normals(12, j)[0].far.unpack();  // of the swept volume, where it begins
    EXPECT_LT(glm::dot(out, way), 1e-4) << j;
    ++ends;
  }
  EXPECT_GT(ends, 8);
}

TEST(Carve, NormalsOfNewSurfacesPointIntoTheTool) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 12}}, 0.5, "xyz"});
  const Vec3 axis = unit(0.2, 0.3, 1);
  const Pose pose{{10, 10, 4}, axis};
  carve(volume, cutters::ball(8, 30), std::vector<Pose>{pose, pose});
  const Vec3 centre = pose.tip + 4.0 * axis;
  int seen = 0;
  for (const dexel::Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        const auto ray = grid.ray(i, j);
        const auto normals = grid.ray_normals(i, j);
        ASSERT_EQ(ray.size(), normals.size());
        for (std::size_t k = 0; k < ray.size(); ++k)
          for (const bool near : {true, false}) {
            const Vec3 p = to_world(grid.axis(), {grid.u(i), grid.v(j), near ? ray[k].near : ray[k].far});
            if (glm::dot(p - centre, axis) > 0 || std::abs(glm::length(p - centre) - 4) > 1e-9) continue;
            const Vec3 expected = (centre - p) / 4.0, n = (near ? normals[k].near : normals[k].far).unpack();
            EXPECT_LT(glm::length(n - expected), 1e-4);
            ++seen;
          }
      }
  EXPECT_GT(seen, 200);
}

/// One move took minutes and gigabytes, or never ended, with these.
TEST(Carve, TolerancesAndTimesThatNeedEndlessWorkAreRefused) {
  const std::vector<Pose> turning{{{5, 5, 3}, {0, 0, 1}}, {{15, 5, 3}, glm::normalize(Vec3(1, 0, 1))}};
  for (const double tolerance : {1e-9, 1e-12, 1e-16, 1e-22, 5e-324}) {
    Volume volume = Volume::block({{{0, 0, 0}, {20, 10, 5}}, 0.5, "z"});
    const std::uint64_t revision = volume.revision();
    CarveOptions options;
    options.tolerance = tolerance;
    EXPECT_THROW(carve(volume, cutters::ball(6, 30), turning, options), std::invalid_argument);
    EXPECT_THROW(MoveCarver(volume, cutters::ball(6, 30), {tolerance, 0.05}), std::invalid_argument);
    EXPECT_EQ(volume.revision(), revision);
  }
  Volume volume = Volume::block({{{0, 0, 0}, {20, 10, 5}}, 0.5, "z"});
  CarveOptions options;
  options.tolerance = 1e-6;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_GT(carve(volume, cutters::ball(6, 30), turning, options).removed[0], 0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_THROW(carve(volume, cutters::ball(1e6, 2e6), turning, options), std::invalid_argument)
      << "too fine for the tool";
  options = {};
  options.dt = {5e-324};
  EXPECT_THROW(carve(volume, cutters::ball(6, 30), turning, options), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::sweep::carve_test
