// Moves one by one, as a pen makes them: the same as `carve`, without asking the system for memory.
#include "riffler/sweep/move_carver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

#include "dexel/volumes.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/allocations.hpp"
#include "support/effort.hpp"

namespace riffler::sweep::move_carver_test {
namespace {

/// A spiral at cutting depth whose turns overlap, 0.5 mm a step; with `lean`, the axis wobbles.
Pose on_spiral(int k, double lean) {
  const double way = 0.5 * k, radius = 16 - 0.02 * way, angle = way / 14;
  const double tilt = lean * std::sin(0.07 * k);
  return {{30 + radius * std::cos(angle), 30 + radius * std::sin(angle), 12 + 2 * std::sin(0.05 * k)},
          {std::sin(tilt), 0, std::cos(tilt)}};
}

const Box3 kBox{{0, 0, 0}, {60, 60, 20}};

TEST(MoveCarver, GivesTheVolumeAndResultOfCarveForEachMove) {
  for (const char* directions : {"z", "xyz"})
    for (const double lean : {0.0, 0.6})
      for (const Tool& tool : {cutters::ball(20, 40), cutters::fillet(12, 2, 40), cutters::flat(10, 30)}) {
        Volume by_moves = Volume::block({kBox, 0.5, directions}), by_calls = by_moves;
        MoveCarver carver(by_moves, tool, {});
        for (int k = 0; k < 40; ++k) {
          const std::vector<Pose> poses{on_spiral(3 * k, lean), on_spiral(3 * k + 3, lean)};
          const MoveCarver::Taken taken = carver.move(poses[0], poses[1], 0.001);
          const Cut cut = carve(by_calls, tool, poses, {.tolerance = 0.01, .dt = {0.001}, .progress = {}});
          ASSERT_EQ(taken.removed, cut.removed[0]);
          ASSERT_EQ(taken.force, cut.force[0]);
          ASSERT_EQ(taken.torque, cut.torque[0]);
        }
        EXPECT_TRUE(test::same_rays(by_moves, by_calls)) << directions << lean << tool.kind();
        EXPECT_LT(by_moves.volume(), kBox.size().x * kBox.size().y * kBox.size().z - 1000);
      }
}

TEST(MoveCarver, DeferredGivesTheSameBitsForAnyTimesOfPublishing) {
  for (const char* directions : {"z", "xyz"})
    for (const double lean : {0.0, 0.6})
      for (const Tool& tool : {cutters::ball(20, 40), cutters::fillet(12, 2, 40), cutters::flat(10, 30)}) {
        if (test::kSanitized && (*directions == 'z') != (lean == 0)) continue;
        Volume at_once = Volume::block({kBox, 0.5, directions}), deferred = at_once;
        MoveCarver now(at_once, tool, {}), later(deferred, tool, {.deferred = true});
        for (int k = 0; k < 120; ++k) {
          // Now and then the tool is somewhere else, and comes back.
          const int at = k % 40 < 30 ? 3 * k : 3 * k + 700;
          const MoveCarver::Taken a = now.move(on_spiral(at, lean), on_spiral(at + 3, lean), 0.001);
          const MoveCarver::Taken b = later.move(on_spiral(at, lean), on_spiral(at + 3, lean), 0.001);
          ASSERT_EQ(a.removed, b.removed);
          ASSERT_EQ(a.force, b.force);
          ASSERT_EQ(a.torque, b.torque);
          ASSERT_TRUE(later.cut_something() || !now.cut_something());
          if (k % 17 != 16) continue;
          later.publish();
          ASSERT_TRUE(test::same_rays(at_once, deferred)) << directions << lean << tool.kind() << k;
        }
        later.publish();
        EXPECT_TRUE(test::same_rays(at_once, deferred)) << directions << lean << tool.kind();
        later.publish();
        EXPECT_TRUE(later.replaced().empty());
      }
}

TEST(MoveCarver, DropsUnpublishedCuts) {
  Volume volume = Volume::block({kBox, 0.5, "xyz"});
  MoveCarver carver(volume, cutters::ball(20, 40), {.deferred = true});
  carver.move(on_spiral(0, 0), on_spiral(20, 0), 0.001);
  carver.publish();
  const Volume published = volume;
  carver.move(on_spiral(20, 0), on_spiral(40, 0), 0.001);
  EXPECT_TRUE(carver.cut_something());
  carver.forget();
  carver.publish();
  EXPECT_TRUE(test::same_rays(volume, published));
  // The carver's tiles are still open; it opens those of the restored volume instead.
  carver.move(on_spiral(20, 0), on_spiral(40, 0), 0.001);
  carver.publish();
  const Volume cut = volume;
  volume.restore(published);
  carver.move(on_spiral(20, 0), on_spiral(40, 0), 0.001);
  carver.publish();
  EXPECT_TRUE(test::same_rays(volume, cut));
}

TEST(MoveCarver, PublishesEarlierCutsInParts) {
  for (const char* directions : {"z", "xyz"})
    for (const double lean : {0.0, 0.6}) {
      if (test::kSanitized && (*directions == 'z') != (lean == 0)) continue;
      Volume at_once = Volume::block({kBox, 0.5, directions}), deferred = at_once, wanted = at_once;
      MoveCarver now(at_once, cutters::ball(20, 40), {}), later(deferred, cutters::ball(20, 40), {.deferred = true});
      int published = 0;
      bool asked = false;
      for (int k = 0; k < 400; ++k) {
        // The tool stands still for a while, leaves the stock, comes back, and continues.
        const int at = k < 150 ? k : (k < 200 ? 150 : k - 50);
        const Vec3 lift(0, 0, k >= 250 && k < 300 ? 40 : 0);
        Pose from = on_spiral(at, lean), to = on_spiral(at + 1, lean);
        from.tip += lift, to.tip += lift;
        now.move(from, to, 0.001), later.move(from, to, 0.001);
        ASSERT_TRUE(later.cut_something() || !now.cut_something());
        const bool long_in_the_air = k == 299;
        ASSERT_FALSE(long_in_the_air && later.cut_something());
        asked = asked || k % 29 == 28;
        if (!asked) continue;
        if (!later.publishing()) wanted = at_once;
        asked = !later.publish_part();
        if (asked) continue;
        ++published;
        ASSERT_TRUE(test::same_rays(wanted, deferred)) << directions << lean << k;
      }
      EXPECT_GE(published, 10);
      while (!later.publish_part()) {
      }
      EXPECT_TRUE(test::same_rays(at_once, deferred)) << directions << lean;
    }
}

TEST(MoveCarver, DropsAPublicationInParts) {
  Volume volume = Volume::block({kBox, 0.5, "xyz"});
  MoveCarver carver(volume, cutters::ball(20, 40), {.deferred = true});
  const Volume before = volume;
  for (int k = 0; k < 40; ++k) carver.move(on_spiral(k, 0), on_spiral(k + 1, 0), 0.001);
  EXPECT_FALSE(carver.publish_part());
  EXPECT_FALSE(carver.publish_part());
  EXPECT_TRUE(carver.publishing());
  carver.forget();
  EXPECT_FALSE(carver.publishing());
  volume.restore(before);
  while (!carver.publish_part()) {
  }
  EXPECT_TRUE(test::same_rays(volume, before));
  Volume other = before;
  MoveCarver at_once(other, cutters::ball(20, 40), {});
  for (int k = 0; k < 40; ++k) {
    carver.move(on_spiral(k, 0), on_spiral(k + 1, 0), 0.001);
    at_once.move(on_spiral(k, 0), on_spiral(k + 1, 0), 0.001);
  }
  carver.publish();
  EXPECT_TRUE(test::same_rays(volume, other));
}

/// Calls of operator new in moves from `warm` on. Between them another thread does what a display does every fifty
/// milliseconds: it looks at a snapshot, and makes memory ready for tiles that are cut for the first time.
std::uint64_t allocations(Volume& volume, double lean, int moves, int warm, bool deferred) {
  MoveCarver carver(volume, cutters::ball(20, 40), {.deferred = deferred});
  base::BlockReserve reserve;
  std::uint64_t count = 0;
  bool asked = false;
  for (int k = 0; k < moves; ++k) {
    if (k % 50 == 0)
      std::thread([&reserve, seen = volume.snapshot()] {
        EXPECT_GT(seen.volume(), 0);
        reserve.fill(1 << 15, 128);
      }).join();
    const std::uint64_t before = test::allocations();
    carver.move(on_spiral(k, lean), on_spiral(k + 1, lean), 0.001);
    asked = asked || (deferred && k % 50 == 49);
    if (asked) asked = !carver.publish_part();
    if (k >= warm) count += test::allocations() - before;
  }
  return count;
}

TEST(MoveCarver, AllocatesNothingOnceItIsWarm) {
  for (const bool deferred : {false, true})
    for (const char* directions : {"z", "xyz"})
      for (const double lean : {0.0, 0.6}) {
        if (test::kSanitized && *directions == 'z') continue;
        Volume volume = Volume::block({kBox, directions[1] ? 0.4 : 0.1, directions});
        const double before = volume.volume();
        EXPECT_EQ(allocations(volume, lean, 400, 100, deferred), 0U) << directions << ' ' << lean << deferred;
        EXPECT_LT(volume.volume(), before - 1000);
      }
}

TEST(MoveCarver, BadInputChangesNothing) {
  Volume volume = Volume::block({kBox, 0.5, "z"});
  EXPECT_THROW(MoveCarver(volume, cutters::ball(20, 40), {.tolerance = 0}), std::invalid_argument);
  MoveCarver carver(volume, cutters::ball(20, 40), {});
  const Pose good = on_spiral(0, 0);
  EXPECT_THROW(carver.move(good, good, 0), std::invalid_argument);
  EXPECT_THROW(carver.move(good, {{std::nan(""), 0, 0}, {0, 0, 1}}, 0.001), std::invalid_argument);
  EXPECT_THROW(carver.move(good, {good.tip, {0, 0, -1}}, 0.001), std::invalid_argument);
  EXPECT_EQ(volume.volume(), 60 * 60 * 20);
  EXPECT_GT(carver.move(good, good, 0.001).removed, 0);
  EXPECT_EQ(carver.move(good, good, 0.001).removed, 0);
}

}  // namespace
}  // namespace riffler::sweep::move_carver_test
