// A session that adds, or that cuts next to what is protected: what may be cut and what is shown, strokes on disk,
// undo.
#include "session/masked_stock.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

#include "dexel/volumes.hpp"
#include "riffler/dexel/boolean.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/session/journal_file.hpp"
#include "riffler/session/replay.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "session/sculpt_bench.hpp"
#include "support/error_of.hpp"

namespace riffler::session::masked_stock_test {
namespace {

const Box3 kBox{{0, 0, 0}, {40, 30, 12}};
const Tool kBall = cutters::ball(6, 30);
const std::vector<Pose> kMasked{{{5, 15, 8}, {0, 0, 1}}, {{35, 16, 9}, {0, 0, 1}}};

std::vector<Pose> wander(std::mt19937& random, int rows) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  std::vector<Pose> out{{Vec3(20, 15, 11) + Vec3(15, 10, 1) * any(), {0, 0, 1}}};
  while (static_cast<int>(out.size()) < rows)
    out.push_back({out.back().tip + 0.8 * any(), glm::normalize(out.back().axis + 0.1 * any())});
  return out;
}

Volume masked(const char* directions) {
  Volume mask(dexel::Frame{kBox, 0.4, directions});
  sweep::CarveOptions add;
  add.mode = sweep::CarveMode::Add;
  sweep::carve(mask, kBall, kMasked, add);
  return mask;
}

/// Its material within the mask.
Volume within(Volume volume, const Volume& mask) {
  apply(dexel::Boolean::Intersect, volume, mask);
  return volume;
}

/// What material is put on: the block's lower part.
const std::vector<Pose> kLowered{{{-15, 15, 7}, {0, 0, 1}}, {{55, 15, 7}, {0, 0, 1}}};
const Tool kPlane = cutters::flat(60, 30);
const std::map<int, Tool> kTools{{1, kBall}, {2, kPlane}};

Volume stock_for(sweep::CarveMode mode, const char* directions) {
  Volume out = Volume::block({kBox, 0.4, directions});
  if (mode == sweep::CarveMode::Add) sweep::carve(out, kPlane, kLowered);
  return out;
}

enum class Masked { Yes, No };

/// Cuts move by move, shows now and then, as a session does.
struct Bench {
  Bench(const char* directions, sweep::CarveMode mode, Masked masks = Masked::Yes)
      : Bench(stock_for(mode, directions), mode, masks) {}
  Bench(const Volume& begin, sweep::CarveMode mode, Masked masks = Masked::Yes)
      : stock(begin),
        mask(masked(begin.frame().directions.c_str())),
        cuttable(stock, mode, masks == Masked::Yes ? &mask : nullptr),
        left(cuttable.volume()),
        carver(left, kBall, {}),
        shown(stock) {}

  void stroke(const std::vector<Pose>& poses, int look_every) {
    std::vector<TileExchange::Place> places;
    for (std::size_t k = 1; k < poses.size(); ++k) {
      carver.move(poses[k - 1], poses[k], 1e-3);
      places.insert(places.end(), carver.replaced().begin(), carver.replaced().end());
      if (k % static_cast<std::size_t>(look_every) != 0 && k + 1 != poses.size()) continue;
      cuttable.show(left, places, shown);
      places.clear();
    }
  }

  Volume stock, mask;
  MaskedStock cuttable;
  Volume left;
  sweep::MoveCarver carver;
  Volume shown;
};

/// Volumes and modes of the tests.
template <class Test>
void for_each_kind(const Test& test) {
  for (const char* directions : {"z", "xyz"})
    for (const sweep::CarveMode mode : {sweep::CarveMode::Remove, sweep::CarveMode::Add}) {
      SCOPED_TRACE(std::string(directions) + (mode == sweep::CarveMode::Add ? ", add" : ", remove"));
      test(directions, mode);
    }
}

StrokeMode stroke_mode(sweep::CarveMode mode) {
  return mode == sweep::CarveMode::Add ? StrokeMode::Build : StrokeMode::Beside;
}

JournalStroke stroke_of(StrokeMode mode, const std::vector<Pose>& poses, int tool = 1) {
  return {tool, 0.01, "", poses, {}, {}, {}, mode};
}

/// Begins with what a bench does.
Journal journal(const char* directions, sweep::CarveMode mode, Masked masks = Masked::Yes) {
  Journal j;
  j.set_stock({kBox, 0.4, directions, ""});
  j.add_tool(1, "{}");
  j.add_tool(2, "{}");
  if (mode == sweep::CarveMode::Add) j.add_stroke(stroke_of(StrokeMode::Remove, kLowered, 2));
  if (masks == Masked::Yes) j.add_stroke(stroke_of(StrokeMode::Mask, kMasked));
  return j;
}

TEST(MaskedStock, MaskedMaterialStaysToTheBitAndTheRestEqualsAPlainCarve) {
  for_each_kind([](const char* directions, sweep::CarveMode mode) {
    std::mt19937 random(11);
    Bench bench(directions, mode);
    const std::vector<Pose> poses = wander(random, 200);
    bench.stroke(poses, 7);
    EXPECT_TRUE(test::same_spans(within(bench.shown, bench.mask), within(bench.stock, bench.mask)));
    EXPECT_GT((bench.shown.volume() - bench.stock.volume()) * (mode == sweep::CarveMode::Add ? 1 : -1), 20);
    Volume carved = bench.stock;
    sweep::CarveOptions options;
    options.mode = mode, options.protect = &bench.mask;
    sweep::carve(carved, kBall, poses, options);
    EXPECT_TRUE(test::same_spans(bench.shown, carved));
  });
}

TEST(MaskedStock, TheShownStateDoesNotDependOnTheNumberOfQueries) {
  for_each_kind([](const char* directions, sweep::CarveMode mode) {
    std::mt19937 random(12);
    Bench often(directions, mode), seldom(directions, mode);
    for (int k = 0; k < 4; ++k) {
      const std::vector<Pose> poses = wander(random, 80);
      often.stroke(poses, 1), seldom.stroke(poses, 33);
    }
    EXPECT_EQ(to_bytes(often.shown), to_bytes(seldom.shown));
    EXPECT_EQ(to_bytes(often.shown), to_bytes(often.cuttable.whole(often.left)));
  });
}

TEST(MaskedStock, AReplayOfAnyNumberOfStrokesHasTheSameBytes) {
  for_each_kind([](const char* directions, sweep::CarveMode mode) {
    std::mt19937 random(13);
    Bench bench(directions, mode);
    Journal j = journal(directions, mode);
    std::vector<std::vector<std::uint8_t>> states{to_bytes(bench.shown)};
    for (int k = 0; k < 5; ++k) {
      const JournalStroke stroke = stroke_of(stroke_mode(mode), wander(random, 80));
      bench.stroke(stroke.poses, 9);
      j.add_stroke(stroke);
      states.push_back(to_bytes(bench.shown));
    }
    j = parse_journal(to_bytes(j), "j");
    for (std::size_t k = states.size(); k-- > 0;) {
      EXPECT_EQ(to_bytes(replay(j, kTools)), states[k]) << k;
      if (k > 0) j.undo();
    }
  });
}

TEST(MaskedStock, WithoutAMaskTheReplayOfAddedMaterialHasTheSameBytesToo) {
  for (const char* directions : {"z", "xyz"}) {
    std::mt19937 random(15);
    Bench bench(directions, sweep::CarveMode::Add, Masked::No);
    Journal j = journal(directions, sweep::CarveMode::Add, Masked::No);
    for (int k = 0; k < 3; ++k) {
      const std::vector<Pose> poses = wander(random, 80);
      bench.stroke(poses, 11);
      j.add_stroke(stroke_of(StrokeMode::Build, poses));
    }
    EXPECT_EQ(to_bytes(replay(j, kTools)), to_bytes(bench.shown)) << directions;
    EXPECT_GT(bench.shown.volume(), bench.stock.volume() + 20);
    EXPECT_LE(bench.shown.volume(), Volume::block(bench.stock.frame()).volume()) << "the box is full then";
  }
}

/// Why such strokes have a kind of their own: a carve that adds starts over, and what is thinner than 1e-9 h is lost.
TEST(MaskedStock, AStrokeThatGoesDeeperByATinyAmountIsInTheReplay) {
  for (const char* directions : {"z", "xyz"}) {
    std::mt19937 random(17);
    Bench bench(directions, sweep::CarveMode::Add, Masked::No);
    std::vector<Pose> poses = wander(random, 60);
    for (Pose& pose : poses) pose.axis = {0, 0, 1};
    Journal built = journal(directions, sweep::CarveMode::Add, Masked::No), added = built;
    for (int k = 0; k < 2; ++k) {
      bench.stroke(poses, 7);
      built.add_stroke(stroke_of(StrokeMode::Build, poses));
      added.add_stroke(stroke_of(StrokeMode::Add, poses));
      for (Pose& pose : poses) pose.tip.z -= 2e-10;
    }
    EXPECT_EQ(to_bytes(replay(built, kTools)), to_bytes(bench.shown)) << directions;
    EXPECT_NE(to_bytes(replay(added, kTools)), to_bytes(bench.shown)) << directions;
  }
}

TEST(MaskedStock, RunsOfStrokesOfTheTwoModesBeginWithTheResultOfTheLastOne) {
  for (const char* directions : {"z", "xyz"}) {
    std::mt19937 random(16);
    Journal j = journal(directions, sweep::CarveMode::Add);
    Volume whole = stock_for(sweep::CarveMode::Add, directions);
    for (const sweep::CarveMode mode : {sweep::CarveMode::Add, sweep::CarveMode::Remove, sweep::CarveMode::Add}) {
      Bench run(whole, mode);
      for (int k = 0; k < 2; ++k) {
        const std::vector<Pose> poses = wander(random, 50);
        run.stroke(poses, 8);
        j.add_stroke(stroke_of(stroke_mode(mode), poses));
      }
      whole = run.shown;
    }
    EXPECT_EQ(to_bytes(replay(j, kTools)), to_bytes(whole)) << directions;
  }
}

TEST(MaskedStock, StrokesOfOtherKindsBeginWithTheWholeVolume) {
  std::mt19937 random(14);
  for (const sweep::CarveMode mode : {sweep::CarveMode::Remove, sweep::CarveMode::Add}) {
    Bench bench("xyz", mode);
    const std::vector<Pose> first = wander(random, 40), second = wander(random, 40);
    bench.stroke(first, 5);
    sweep::CarveOptions add;
    add.mode = sweep::CarveMode::Add, add.protect = &bench.mask;
    sweep::carve(bench.shown, kBall, second, add);
    Journal j = journal("xyz", mode);
    j.add_stroke(stroke_of(stroke_mode(mode), first));
    j.add_stroke(stroke_of(StrokeMode::Add, second));
    EXPECT_EQ(to_bytes(replay(j, kTools)), to_bytes(bench.shown));
  }
}

TEST(MaskedStock, AMaskOnAnotherGridIsRefused) {
  const Volume stock = Volume::block({kBox, 0.4, "z"});
  const Volume mask(dexel::Frame{kBox, 0.5, "z"});
  for (const sweep::CarveMode mode : {sweep::CarveMode::Remove, sweep::CarveMode::Add})
    EXPECT_NE(test::error_of([&] { MaskedStock(stock, mode, &mask); }).find("protect"), std::string::npos);
}

}  // namespace
}  // namespace riffler::session::masked_stock_test
