// A session beside what is protected: what may be cut and what is shown, strokes on disk, undo.
#include "session/protection.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "dexel/boolean.hpp"
#include "dexel/file.hpp"
#include "dexel/volumes.hpp"
#include "session/journal_file.hpp"
#include "session/replay.hpp"
#include "session/sculpt_bench.hpp"
#include "support/error_of.hpp"
#include "sweep/carve.hpp"
#include "tool/cutters.hpp"

namespace riffler {
namespace {

const Box3 kBox{{0, 0, 0}, {40, 30, 12}};
const Tool kBall = cutters::ball(6, 30);

std::vector<Pose> wander(std::mt19937& random, int rows) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  std::vector<Pose> out{{Vec3(20, 15, 11) + Vec3(15, 10, 1) * any(), {0, 0, 1}}};
  while (static_cast<int>(out.size()) < rows)
    out.push_back({out.back().tip + 0.8 * any(), glm::normalize(out.back().axis + 0.1 * any())});
  return out;
}

Volume masked(const char* directions) {
  Volume mask(Frame{kBox, 0.4, directions});
  CarveOptions add;
  add.mode = CarveMode::Add;
  carve(mask, kBall, std::vector<Pose>{{{5, 15, 8}, {0, 0, 1}}, {{35, 16, 9}, {0, 0, 1}}}, add);
  return mask;
}

/// Its material within the mask.
Volume within(Volume volume, const Volume& mask) {
  apply(Boolean::Intersect, volume, mask);
  return volume;
}

/// Cuts move by move, shows now and then, as a session does.
struct Bench {
  explicit Bench(const char* directions)
      : stock(Volume::block({kBox, 0.4, directions})),
        mask(masked(directions)),
        protection(stock, mask),
        left(protection.cuttable()),
        carver(left, kBall, {}),
        shown(stock) {}

  void stroke(const std::vector<Pose>& poses, int look_every) {
    std::vector<TileExchange::Place> places;
    for (std::size_t k = 1; k < poses.size(); ++k) {
      carver.move(poses[k - 1], poses[k], 1e-3);
      places.insert(places.end(), carver.replaced().begin(), carver.replaced().end());
      if (k % static_cast<std::size_t>(look_every) != 0 && k + 1 != poses.size()) continue;
      protection.show(left, places, shown);
      places.clear();
    }
  }

  Volume stock, mask;
  Protection protection;
  Volume left;
  MoveCarver carver;
  Volume shown;
};

TEST(Protection, WhatLiesInTheMaskStaysAsItIsToTheBitAndTheRestIsCutAsACarveBesideItCutsIt) {
  for (const char* directions : {"z", "xyz"}) {
    std::mt19937 random(11);
    Bench bench(directions);
    const std::vector<Pose> poses = wander(random, 200);
    bench.stroke(poses, 7);
    EXPECT_TRUE(test::same_spans(within(bench.shown, bench.mask), within(bench.stock, bench.mask)));
    EXPECT_LT(bench.shown.volume(), bench.stock.volume() - 20);
    Volume carved = bench.stock;
    CarveOptions options;
    options.protect = &bench.mask;
    carve(carved, kBall, poses, options);
    EXPECT_TRUE(test::same_spans(bench.shown, carved)) << directions;
  }
}

TEST(Protection, WhatIsShownDoesNotDependOnHowOftenSomebodyLooks) {
  for (const char* directions : {"z", "xyz"}) {
    std::mt19937 random(12);
    Bench often(directions), seldom(directions);
    for (int k = 0; k < 4; ++k) {
      const std::vector<Pose> poses = wander(random, 80);
      often.stroke(poses, 1), seldom.stroke(poses, 33);
    }
    EXPECT_EQ(to_bytes(often.shown), to_bytes(seldom.shown));
    EXPECT_EQ(to_bytes(often.shown), to_bytes(often.protection.whole(often.left)));
  }
}

TEST(Protection, AReplayOfItsStrokesHasTheSameBytesHoweverManyCount) {
  for (const char* directions : {"z", "xyz"}) {
    std::mt19937 random(13);
    Bench bench(directions);
    const JournalStroke mask{1,  0.01, "", {{{5, 15, 8}, {0, 0, 1}}, {{35, 16, 9}, {0, 0, 1}}},
                             {}, {},   {}, StrokeMode::Mask};
    Journal j;
    j.set_stock({kBox, 0.4, directions, ""});
    j.add_tool(1, "{}");
    j.add_stroke(mask);
    std::vector<std::vector<std::uint8_t>> states{to_bytes(bench.shown)};
    for (int k = 0; k < 5; ++k) {
      JournalStroke stroke{1, 0.01, "", wander(random, 80)};
      stroke.mode = StrokeMode::Beside;
      bench.stroke(stroke.poses, 9);
      j.add_stroke(stroke);
      states.push_back(to_bytes(bench.shown));
    }
    j = parse_journal(to_bytes(j), "j");
    for (std::size_t k = states.size(); k-- > 0;) {
      EXPECT_EQ(to_bytes(replay(j, {{1, kBall}})), states[k]) << directions << k;
      if (k > 0) j.take_back();
    }
  }
}

TEST(Protection, StrokesOfOtherKindsBeginWithTheWhole) {
  std::mt19937 random(14);
  Bench bench("xyz");
  const std::vector<Pose> first = wander(random, 40), second = wander(random, 40);
  bench.stroke(first, 5);
  CarveOptions add;
  add.mode = CarveMode::Add, add.protect = &bench.mask;
  carve(bench.shown, kBall, second, add);
  Journal j;
  j.set_stock({kBox, 0.4, "xyz", ""});
  j.add_tool(1, "{}");
  const auto stroke = [&](StrokeMode mode, const std::vector<Pose>& poses) {
    j.add_stroke({1, 0.01, "", poses, {}, {}, {}, mode});
  };
  stroke(StrokeMode::Mask, {{{5, 15, 8}, {0, 0, 1}}, {{35, 16, 9}, {0, 0, 1}}});
  stroke(StrokeMode::Beside, first);
  stroke(StrokeMode::Add, second);
  EXPECT_EQ(to_bytes(replay(j, {{1, kBall}})), to_bytes(bench.shown));
}

TEST(Protection, AMaskOnAnotherGridIsRefused) {
  const Volume stock = Volume::block({kBox, 0.4, "z"});
  const Volume mask(Frame{kBox, 0.5, "z"});
  EXPECT_NE(test::error_of([&] { Protection(stock, mask); }).find("protect"), std::string::npos);
}

}  // namespace
}  // namespace riffler
