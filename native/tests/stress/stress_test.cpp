#include <gtest/gtest.h>

#include "riffler/tool/cutters.hpp"
#include "stress/run.hpp"
#include "support/effort.hpp"

namespace riffler::stress::stress_test {
namespace {

/// The stress run of every cutter, short and always the same.
class Stress : public testing::TestWithParam<const char*> {};

TEST_P(Stress, HoldsInTheDegenerateLimits) {
  Options options;
  options.compare_every = 4;
  const int moves = test::cases(200);
  const Results results = run(options, GetParam(), moves);
  for (const Failure& f : results.failures)
    ADD_FAILURE() << "move " << f.move << ": " << f.text << "\nagain: " << reproducer(f);
  const Tally total = results.total();
  EXPECT_GE(total.moves, moves);
  EXPECT_GT(total.ends, moves) << "hardly anything was compared";
  EXPECT_GT(total.points, 10 * moves);
  EXPECT_GT(results.thread_checks, 0);
}

std::string test_name(const testing::TestParamInfo<const char*>& info) {
  std::string out = info.param;
  std::erase(out, '-');
  return out;
}

INSTANTIATE_TEST_SUITE_P(Cutter, Stress, testing::ValuesIn(cutter_names().begin(), cutter_names().end()), test_name);

// The checks themselves: each must find what it is there for.

Stage stage() {
  return {Setting::Usual, {{{0, 0, 0}, {20, 19, 14}}, 1, "xyz"}, cutters::fillet(6, 1, 30), 0.01, 0.1};
}

const Move kTurning{Kind::Turning, {{6, 9, 6}, {0, 0, 1}}, {{14, 10, 7}, {0.6, 0, 0.8}}, 0.01};
const Move kStraight{Kind::Straight, {{6, 9, 6}, {0, 0, 1}}, {{14, 10, 7}, {0, 0, 1}}, 0.01};

Volume carved(const Move& move, const Vec3& shift = Vec3(0)) {
  const Stage s = stage();
  Volume volume = Volume::block(s.frame);
  sweep::CarveOptions options;
  options.tolerance = move.tolerance;
  const Pose from{move.from.tip + shift, move.from.axis}, to{move.to.tip + shift, move.to.axis};
  sweep::carve(volume, s.tool, std::vector<Pose>{from, to}, options);
  return volume;
}

Comparison compared(const Move& move, const Volume& after) {
  Random random(1);
  return compare_with_reference(random, stage(), move, Volume::block(stage().frame), after, 400);
}

TEST(StressChecks, TheReferenceAgreesWithTheCut) {
  for (const Move& move : {kTurning, kStraight}) {
    const Comparison c = compared(move, carved(move));
    EXPECT_EQ(c.problem, "");
    EXPECT_GT(c.ends, 300);
    EXPECT_LT(c.worst, 1);
  }
}

TEST(StressChecks, TheReferenceFindsACutThatIsOff) {
  const double off = 1.5 * kTurning.tolerance;
  for (const Vec3& shift : {Vec3(0, 0, off), Vec3(0, 0, -off), Vec3(0, off, 0)})
    EXPECT_NE(compared(kTurning, carved(kTurning, shift)).problem, "");
  for (const Vec3& shift : {Vec3(0, 0, 1e-7), Vec3(0, 0, -1e-7)})
    EXPECT_NE(compared(kStraight, carved(kStraight, shift)).problem, "");
}

/// `volume` with the spans of the ray in the middle of its first grid replaced.
Volume with_ray(const Volume& volume, const std::vector<dexel::Span>& spans) {
  Volume out = volume;
  dexel::Grid& grid = out.grids()[0];
  const int middle = dexel::Grid::ray_index(grid.nu() / 2, grid.nv() / 2);
  dexel::TileBuilder builder(grid.has_normals());
  for (int r = 0; r < dexel::kTileRays; ++r) {
    const auto ray = grid.tile(0).ray(r);
    for (const dexel::Span& s : r == middle ? std::span<const dexel::Span>(spans) : ray) builder.add(s);
    builder.next_ray();
  }
  grid.set_tile(0, builder.finish());
  out.touch();
  return out;
}

TEST(StressChecks, TheReferenceFindsASliverLeftBehindAndOneTaken) {
  const Volume after = carved(kTurning);
  const dexel::Grid& grid = after.grids()[0];  // along x
  const auto ray = grid.ray(grid.nu() / 2, grid.nv() / 2);
  ASSERT_EQ(ray.size(), 2U);
  const double inside = (ray[0].far + ray[1].near) / 2;
  const Volume left = with_ray(after, {ray[0], {inside, inside + 1e-6}, ray[1]});
  EXPECT_NE(compared(kTurning, left).problem, "");
  const double solid = (ray[1].near + ray[1].far) / 2;
  const Volume taken = with_ray(after, {ray[0], {ray[1].near, solid}, {solid + 1e-6, ray[1].far}});
  EXPECT_NE(compared(kTurning, taken).problem, "");
}

/// `volume` with all normals turned by some angle about z.
Volume with_turned_normals(const Volume& volume, double angle) {
  Volume out = volume;
  for (dexel::Grid& grid : out.grids())
    for (std::size_t t = 0; t < grid.tile_count(); ++t) {
      const dexel::Tile& tile = grid.tile(t);
      dexel::TileBuilder builder(true);
      const auto turned = [&](const dexel::PackedNormal& packed) {
        const Vec3 n = packed.unpack();
        return dexel::PackedNormal::pack(
            {n.x * std::cos(angle) - n.y * std::sin(angle), n.x * std::sin(angle) + n.y * std::cos(angle), n.z});
      };
      for (int r = 0; r < dexel::kTileRays; ++r) {
        for (std::size_t k = 0; k < tile.ray(r).size(); ++k)
          builder.add(tile.ray(r)[k], {turned(tile.ray_normals(r)[k].near), turned(tile.ray_normals(r)[k].far)});
        builder.next_ray();
      }
      grid.set_tile(t, builder.finish());
    }
  out.touch();
  return out;
}

TEST(StressChecks, TheReferenceFindsNormalsThatAreOff) {
  const Volume after = carved(kStraight);
  EXPECT_EQ(compared(kStraight, with_turned_normals(after, 0)).problem, "");
  for (const double angle : {3e-4, -3e-4, 0.1, 1.5})
    EXPECT_NE(compared(kStraight, with_turned_normals(after, angle)).problem.find("normal"), std::string::npos)
        << angle;
}

TEST(StressChecks, SpansOutOfOrderAreFound) {
  const Volume block = Volume::block(stage().frame);
  const double nan = std::nan("");
  EXPECT_EQ(check_spans(block), "");
  EXPECT_EQ(check_spans(with_ray(block, {{1, 2}, {3, 4}}), &block), "");
  const std::vector<std::vector<dexel::Span>> wrong{{{1, 1}},         {{2, 1}},   {{3, 4}, {1, 2}},
                                                    {{1, 3}, {2, 4}}, {{-1, 4}},  {{1, 20.000001}},
                                                    {{nan, 2}},       {{1, nan}}, {{1, 2}, {2, 3}}};
  for (const auto& spans : wrong) EXPECT_NE(check_spans(with_ray(block, spans)), "") << spans[0].near;
  const Volume less = with_ray(block, {{1, 2}, {3, 4}});
  EXPECT_NE(check_spans(with_ray(block, {{1, 2.5}, {3, 4}}), &less), "");
  EXPECT_NE(check_spans(with_ray(block, {{2.2, 2.5}}), &less), "");
}

TEST(StressChecks, VolumesThatDoNotAddUpAreFound) {
  const Volume block = Volume::block(stage().frame), after = carved(kStraight);
  sweep::Cut cut{{block.volume() - after.volume()}, {Vec3(0)}, {Vec3(0)}};
  EXPECT_EQ(check_removed(block, after, cut), "");
  EXPECT_NE(check_removed(after, block, cut), "") << "it grew";
  cut.removed[0] *= 1 + 1e-8;
  EXPECT_NE(check_removed(block, after, cut), "");
  cut.removed[0] = std::nan("");
  EXPECT_NE(check_removed(block, after, cut), "");
}

TEST(StressChecks, OtherBytesAreFound) {
  const Volume block = Volume::block(stage().frame);
  EXPECT_EQ(check_same_bytes(carved(kTurning), carved(kTurning)), "");
  EXPECT_NE(check_same_bytes(block, with_ray(block, {{0, std::nextafter(20.0, 0)}})), "");
}

TEST(StressChecks, ASessionIsTheSameEveryTime) {
  for (const int every : {1, 3}) {
    Options options;
    options.compare_every = every;
    Results a, b;
    run_session(options, "fillet", 5, a);
    run_session(options, "fillet", 5, b);
    for (std::size_t k = 0; k < a.kinds.size(); ++k) {
      EXPECT_EQ(a.kinds[k].moves, b.kinds[k].moves);
      EXPECT_EQ(a.kinds[k].ends, b.kinds[k].ends);
    }
  }
  // What is compared must not change what is carved, or a failure could not be seen again.
  Options often, never;
  often.compare_every = 1, never.compare_every = 0;
  Results a, b;
  run_session(often, "ball", 3, a);
  run_session(never, "ball", 3, b);
  for (std::size_t k = 0; k < a.kinds.size(); ++k) EXPECT_EQ(a.kinds[k].moves, b.kinds[k].moves);
}

}  // namespace
}  // namespace riffler::stress::stress_test
