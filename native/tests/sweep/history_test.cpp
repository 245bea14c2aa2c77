// Histories of strokes: every edit gives the bytes of a replay, and costs only where its stroke is.
#include "riffler/sweep/history.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "dexel/volumes.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/history_session.hpp"
#include "stress/thread_count.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"
#include "sweep/touched_tiles.hpp"

namespace riffler::sweep::history_test {
namespace {

constexpr Vec3 kUp{0, 0, 1};

/// 7 × 5 tiles seen from above.
Volume block(const char* directions = "xyz") {
  return Volume::block({{{0, 0, 0}, {100, 75, 20}}, 0.5, directions});
}

HistoryStroke groove(Vec3 from, Vec3 to, double diameter = 6) {
  return {cutters::ball(diameter, 40), {{from, kUp}, {to, kUp}}};
}

HistoryStroke turning(Vec3 from, Vec3 to) {
  return {cutters::flat(5, 40), {{from, kUp}, {to, glm::normalize(Vec3(0.5, 0.2, 1))}}};
}

HistoryStroke adding(HistoryStroke stroke) {
  stroke.mode = CarveMode::Add;
  return stroke;
}

Volume carved(Volume volume, const std::vector<HistoryStroke>& strokes) {
  for (const HistoryStroke& s : strokes) {
    CarveOptions options;
    options.tolerance = s.tolerance, options.mode = s.mode;
    if (s.protect) options.protect = &*s.protect;
    carve(volume, s.tool, s.poses, options);
  }
  return volume;
}

::testing::AssertionResult is(const History& history, const std::vector<HistoryStroke>& strokes) {
  if (dexel::to_bytes(history.volume()) == dexel::to_bytes(carved(history.base(), strokes)))
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "not the bytes of a replay of " << strokes.size() << " strokes";
}

TEST(History, RandomEditsGiveTheBytesOfAReplayForAnyNumberOfThreads) {
  stress::HistoryOptions options;
  options.seed = 20;
  const int edits = test::cases(80, 3);
  const stress::HistoryResults results = stress::run_histories(options, edits);
  for (const stress::HistoryFailure& f : results.failures)
    ADD_FAILURE() << "edit " << f.edit << ": " << f.text << "\nagain: " << reproducer(f);
  EXPECT_GE(results.edits, edits);
  EXPECT_GT(results.cancelled, edits / 20);
  EXPECT_LT(2 * results.unchanged, results.edits);
  EXPECT_LT(2 * results.tiles_run, results.tiles_in_all);
}

TEST(History, AllEditsGiveTheBytesOfAReplay) {
  for (const char* directions : {"z", "y", "xyz"}) {
    const HistoryStroke a = groove({-5, 20, 16}, {105, 25, 15}), b = turning({30, -5, 18}, {35, 80, 14}),
                        c = adding(groove({20, 20, 17}, {60, 30, 16})), d = groove({5, 5, 12}, {95, 70, 14}, 9);
    History h(block(directions));
    const StrokeId ka = h.add(a), kc = h.add(c), kb = h.insert(b, kc);
    EXPECT_EQ(h.ids(), (std::vector<StrokeId>{ka, kb, kc}));
    EXPECT_TRUE(is(h, {a, b, c}));
    h.replace(kb, d);
    EXPECT_TRUE(is(h, {a, d, c}));
    h.move(kc, ka);
    EXPECT_TRUE(is(h, {c, a, d}));
    h.move(kc, std::nullopt);
    EXPECT_TRUE(is(h, {a, d, c}));
    h.enable(kb, false);
    EXPECT_FALSE(h.enabled(kb));
    EXPECT_TRUE(is(h, {a, c}));
    h.replace(kb, b);  // while it is disabled
    EXPECT_TRUE(is(h, {a, c}));
    h.move(kb, ka);
    h.enable(kb, true);
    EXPECT_TRUE(is(h, {b, a, c}));
    h.remove(ka);
    EXPECT_TRUE(is(h, {b, c}));
    h.remove(kb), h.remove(kc);
    EXPECT_TRUE(is(h, {}));
    EXPECT_EQ(h.stats().versions, 0U);
  }
}

TEST(History, RunsOnlyStrokesThatTouchTheTilesOfTheEditedOne) {
  const HistoryStroke left = groove({8, 8, 16}, {12, 60, 16}), right = groove({80, 8, 16}, {84, 60, 16}),
                      across = groove({40, 8, 16}, {90, 10, 15});
  History h(block("z"));
  const StrokeId k = h.add(left);
  for (int n = 0; n < 5; ++n) h.add(right);
  const StrokeId last = h.add(across);
  h.replace(k, groove({8, 8, 15}, {12, 60, 15}));
  EXPECT_EQ(h.stats().strokes_run, 1U);
  EXPECT_EQ(h.stats().tiles_run, 4U);  // 5 to 15 mm by 5 to 63 mm, tiles of 16 mm
  EXPECT_EQ(h.stats().tiles_restored, h.stats().tiles_run);
  h.enable(k, false);
  EXPECT_EQ(h.stats().strokes_run, 0U);
  EXPECT_EQ(h.stats().tiles_changed, 4U);
  const StrokeId first = h.insert(groove({82, 20, 17}, {82, 21, 17}), k);
  EXPECT_LE(h.stats().strokes_run, 7U);
  h.move(last, first);
  EXPECT_TRUE(is(h, {across, groove({82, 20, 17}, {82, 21, 17}), right, right, right, right, right}));
}

TEST(History, StopsAtALaterStrokeThatRemovesEverything) {
  const HistoryStroke wide{cutters::flat(40, 40), {{{-30, 37, 10}, kUp}, {{130, 37, 10}, kUp}}};
  const HistoryStroke fine = groove({20, 37, 18}, {60, 37, 18}, 4), late = groove({-5, 37, 8}, {105, 37, 8});
  History h(block());
  const StrokeId k = h.add(fine);
  h.add(wide);
  for (int n = 0; n < 10; ++n) h.add(late);
  const Volume before = h.volume();
  h.replace(k, groove({20, 38, 18}, {60, 38, 17}, 4));
  EXPECT_EQ(h.stats().strokes_run, 2U);  // after the wide one, all tiles are as before
  EXPECT_EQ(h.stats().tiles_changed, 0U);
  EXPECT_EQ(h.volume().revision(), before.revision());
}

TEST(History, StrokesOffTheBlockAndSinglePosesChangeNothing) {
  History h(block());
  const HistoryStroke off = groove({500, 500, 500}, {600, 500, 500}),
                      single{cutters::ball(6, 40), {{{50, 30, 10}, kUp}}}, inside = groove({20, 20, 15}, {40, 20, 15});
  const auto revision = h.volume().revision();
  const StrokeId a = h.add(off), b = h.add(single);
  EXPECT_EQ(h.stats().tiles_run, 0U);
  EXPECT_EQ(h.volume().revision(), revision);
  h.add(inside);
  h.move(a, std::nullopt), h.replace(b, off), h.enable(a, false), h.remove(a);
  EXPECT_TRUE(is(h, {inside}));
}

TEST(History, TheSameStrokeTwiceAndAMoveToItsOwnPlaceChangeNothing) {
  const HistoryStroke s = groove({10, 10, 15}, {60, 50, 13});
  History h(block());
  const StrokeId a = h.add(s), b = h.add(s);
  const auto revision = h.volume().revision();
  h.move(a, a), h.move(b, b), h.move(a, b), h.move(b, std::nullopt);
  EXPECT_EQ(h.stats().strokes_run, 0U);
  h.move(b, a);
  EXPECT_EQ(h.volume().revision(), revision);
  h.remove(a);
  EXPECT_EQ(h.volume().revision(), revision);
  EXPECT_TRUE(is(h, {s}));
}

TEST(History, StrokesThatTouchAtAFaceOrABorderOfTilesAreExact) {
  // Walls on rays, on the tiles' border at 16 mm, and flush with each other; added material meets what was removed.
  const Tool flat = cutters::flat(8, 40);
  const auto pocket = [&](double x, double z) { return HistoryStroke{flat, {{{x, 12, z}, kUp}, {{x, 40, z}, kUp}}}; };
  std::vector<HistoryStroke> strokes{pocket(12, 10), pocket(20, 10), adding(pocket(12, 10)), pocket(16.25, 10),
                                     adding(pocket(28, 10))};
  for (const char* directions : {"z", "xyz"}) {
    History h(block(directions));
    std::vector<StrokeId> ids;
    for (const HistoryStroke& s : strokes) ids.push_back(h.add(s));
    EXPECT_TRUE(is(h, strokes));
    h.move(ids[4], ids[0]);
    EXPECT_TRUE(is(h, {strokes[4], strokes[0], strokes[1], strokes[2], strokes[3]}));
    h.remove(ids[0]);
    EXPECT_TRUE(is(h, {strokes[4], strokes[1], strokes[2], strokes[3]}));
  }
}

TEST(History, ProtectedRegionsBelongToTheirStrokes) {
  const Volume base = test::wavy_volume(block().frame());
  Volume mask(base.frame());
  CarveOptions add;
  add.mode = CarveMode::Add;
  carve(mask, cutters::ball(20, 40), std::vector<Pose>{{{30, 30, 5}, kUp}, {{60, 40, 5}, kUp}}, add);
  HistoryStroke masked = groove({10, 30, 8}, {90, 40, 9}, 10), filled = adding(groove({10, 35, 12}, {90, 35, 12}));
  masked.protect = filled.protect = mask;
  const HistoryStroke plain = groove({40, 5, 12}, {50, 70, 10});
  History h(base);
  const StrokeId a = h.add(masked), b = h.add(plain);
  h.add(filled);
  EXPECT_TRUE(is(h, {masked, plain, filled}));
  h.move(b, a);
  EXPECT_TRUE(is(h, {plain, masked, filled}));
  h.remove(b);
  EXPECT_TRUE(is(h, {masked, filled}));
}

TEST(History, KeepsFewerVersionsBeyondItsMemoryLimit) {
  constexpr int kStrokes = 60;
  std::vector<HistoryStroke> strokes;
  for (int n = 0; n < kStrokes; ++n)
    strokes.push_back(groove({20 + 0.3 * n, 20, 16 - 0.1 * n}, {60, 40 - 0.3 * n, 15}));
  History all(block()), few(block(), 2'000'000), none(block(), 0);
  for (History* h : {&all, &few, &none}) {
    for (const HistoryStroke& s : strokes) h->add(s);
    EXPECT_TRUE(is(*h, strokes));
  }
  EXPECT_EQ(all.stats().stride, 1U);
  EXPECT_GT(all.stats().version_bytes, 4'000'000U);
  EXPECT_LE(few.stats().version_bytes, 2'000'000U);
  EXPECT_GT(few.stats().stride, 1U);
  EXPECT_LT(none.stats().version_bytes, few.stats().version_bytes);
  const StrokeId k = all.ids()[40];
  for (History* h : {&all, &few, &none}) h->remove(k);
  EXPECT_EQ(all.stats().strokes_run, 19U);
  EXPECT_GT(few.stats().strokes_run, 19U);
  EXPECT_EQ(none.stats().strokes_run, 59U);
  strokes.erase(strokes.begin() + 40);
  for (History* h : {&all, &few, &none}) EXPECT_TRUE(is(*h, strokes));
}

TEST(History, TheBaseIsASnapshotAndVolumesAreToo) {
  Volume base = block();
  const Volume before = base;
  History h(base);
  carve(base, cutters::ball(10, 40), std::vector<Pose>{{{50, 30, 10}, kUp}, {{60, 30, 10}, kUp}});
  Volume now = h.volume();
  carve(now, cutters::ball(10, 40), std::vector<Pose>{{{50, 30, 10}, kUp}, {{60, 30, 10}, kUp}});
  const HistoryStroke s = groove({20, 20, 15}, {70, 40, 15});
  h.add(s);
  EXPECT_EQ(dexel::to_bytes(h.volume()), dexel::to_bytes(carved(before, {s})));
}

TEST(History, RefusesWhatCarveRefusesAndStaysUnchanged) {
  const HistoryStroke s = groove({20, 20, 15}, {70, 40, 15});
  History h(block());
  const StrokeId k = h.add(s);
  const auto revision = h.volume().revision();
  const auto error = [](auto&& call) { return test::error_of(call); };
  EXPECT_EQ(error([&] { h.remove(7); }), "stroke 7 is not in the history; its strokes are 1");
  EXPECT_EQ(error([&] { h.insert(s, 9); }), "stroke 9 is not in the history; its strokes are 1");
  EXPECT_EQ(error([&] { h.move(k, 3); }), "stroke 3 is not in the history; its strokes are 1");
  EXPECT_EQ(error([] { History(block()).enable(1, false); }), "stroke 1 is not in the history, which has no strokes");
  HistoryStroke bad = s;
  bad.poses.clear();
  EXPECT_EQ(error([&] { h.add(bad); }), "poses: a stroke needs at least one pose");
  bad.poses = {{{0, 0, 0}, kUp}, {{1, 0, 0}, kUp}, {{2, 0, 0}, -kUp}};
  EXPECT_EQ(error([&] { h.replace(k, bad); }).substr(0, 60),
            "poses, row 2: the axis is exactly opposite to that of the ro");
  bad = s, bad.tolerance = 0;
  EXPECT_NE(error([&] { h.replace(k, bad); }).find("tolerance"), std::string::npos);
  bad = s, bad.protect = Volume({{{0, 0, 0}, {100, 75, 20}}, 0.25, "xyz"});
  EXPECT_EQ(error([&] { h.insert(bad, k); }), "protect must have the same grid as the volume, but its pitch differs");
  EXPECT_EQ(h.volume().revision(), revision);
  EXPECT_EQ(h.ids(), std::vector<StrokeId>{k});
  EXPECT_TRUE(is(h, {s}));
}

TEST(History, ReportsProgressAndCanBeCancelledAnywhere) {
  const HistoryStroke a = turning({10, 10, 15}, {60, 50, 13}), b = groove({-5, 30, 14}, {105, 40, 14});
  for (const char* count : {"1", "2"}) {
    const stress::ThreadCount threads(count);
    History h(block());
    const StrokeId k = h.add(a);
    h.add(b);
    double last = 0;
    int reports = 0;
    h.replace(k, b, [&](double share) {
      EXPECT_GE(share, last);
      EXPECT_LE(share, 1);
      last = share, ++reports;
      return true;
    });
    EXPECT_EQ(last, 1);
    h.replace(k, a);
    for (int stop = 0; stop < reports; stop += test::kSanitized ? 3 : 1) {
      int left = stop;
      try {
        h.replace(k, b, [&](double) { return left-- > 0; });
        h.replace(k, a);  // with fewer reports than before
      } catch (const Cancelled&) {
      }
      ASSERT_TRUE(is(h, {a, b}));
    }
  }
}

/// Judges touched_tiles by `carve`: no other tile changes, and moves outside the runs of a tile leave it alone.
TEST(TouchedTiles, ContainsAllThatChanges) {
  const std::vector<Pose> poses{{{10, 10, 12}, kUp},
                                {{90, 70, 12}, kUp},
                                {{90, 10, 15}, glm::normalize(Vec3(1, 1, 2))},
                                {{20, 60, 15}, glm::normalize(Vec3(-1, 1, 2))}};
  const Tool tool = cutters::ball(6, 60);
  const std::vector<ConvexGroup> cutter = convex_groups(tool.cutter());
  const Volume before = block();
  for (std::size_t g = 0; g < 3; ++g) {
    const dexel::Grid& grid = before.grids()[g];
    const TouchedTiles touched = touched_tiles(grid, cutter, poses, 0.01);
    for (std::uint32_t m = 0; m + 1 < poses.size(); ++m) {
      Volume after = before;
      carve(after, tool, std::span(poses).subspan(m, 2));
      for (std::size_t t = 0; t < grid.tile_count(); ++t) {
        if (after.grids()[g].shared_tile(t) == grid.shared_tile(t)) continue;
        const std::size_t k = touched.index(t);
        ASSERT_TRUE(k < touched.tiles.size() && touched.tiles[k] == t);
        bool listed = false;
        for (const MoveRun& run : touched.of(k)) listed = listed || (run.first <= m && m < run.end);
        EXPECT_TRUE(listed) << "move " << m << ", tile " << t;
      }
    }
  }
  // A long diagonal move passes over 7 × 5 tiles, but touches only those at its line.
  const TouchedTiles diagonal = touched_tiles(block("z").grids()[0], cutter, std::span(poses).first(2), 0.01);
  EXPECT_LT(diagonal.tiles.size(), 20U);
}

}  // namespace
}  // namespace riffler::sweep::history_test
