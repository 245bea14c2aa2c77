#include "verify/slab_packets.hpp"

#include <gtest/gtest.h>

#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/effort.hpp"
#include "verify/toolset.hpp"

namespace riffler::verify::slab_packets_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Vec3 kUp(0, 0, 1);

Volume cut_block(const char* directions) {
  Volume volume = Volume::block({{{0, 0, -10}, {20, 14, 0}}, 0.2, directions});
  const Vec3 tilted = glm::normalize(Vec3(0.3, -0.2, 1));
  sweep::carve(volume, cutters::ball(4, 30),
               std::vector<Pose>{{{1, 2, -2}, kUp}, {{18, 11, -6}, kUp}, {{3, 9, -1}, tilted}});
  sweep::carve(volume, cutters::flat(3, 60), std::vector<Pose>{{{10, 7, -40}, kUp}, {{10, 7, -30}, kUp}});
  return volume;
}

bool same(const dexel::Tile& a, const dexel::Tile& b) {
  return a.offset == b.offset && a.spans == b.spans && a.normals == b.normals && a.reach == b.reach;
}

TEST(SlabPackets, TilesArriveUnchanged) {
  for (const char* directions : {"x", "z", "xyz"}) {
    const Volume volume = cut_block(directions);
    for (const Slab& slab : slabs_of(volume)) {
      SlabTiles tiles = tiles_of(volume.grids()[slab.grid], slab);
      const SlabTask sent{2, slab, true, 77, tiles, SlabTiles(3, base::make_shared_block<const dexel::Tile>())};
      const SlabTask came = task_of(to_packet(sent));
      EXPECT_EQ(came.fixture, 2);
      EXPECT_EQ(came.slab.place(volume.grids()[slab.grid], 1), slab.place(volume.grids()[slab.grid], 1));
      EXPECT_TRUE(came.probed);
      EXPECT_EQ(came.strikes, 77U);
      ASSERT_EQ(came.tiles.size(), tiles.size());
      for (std::size_t k = 0; k < tiles.size(); ++k) EXPECT_TRUE(same(*came.tiles[k], *tiles[k]));
      ASSERT_EQ(came.part.size(), 3U);
      EXPECT_TRUE(came.part[1]->spans.empty());
    }
  }
}

TEST(SlabPackets, ResultsArriveUnchangedAndUnchangedTilesAreNull) {
  const Volume volume = cut_block("z");
  const Slab slab = slabs_of(volume).front();
  SlabResult sent{tiles_of(volume.grids()[0], slab), {}, {}};
  sent.tiles[0] = nullptr;
  sent.report.removed = {{1, 0.1}, {7, 1e-300}, {std::int64_t{1} << 40, 3.25}};
  sent.report.events = {{Kind::Unknown, Member::Beyond, 3, 9, -0.0, 1e5, Vec3(1, -2, 1e5)},
                        {Kind::Rapid, Member::Cutter, -1, 4, 2, 3, Vec3(0)}};
  sent.report.strikes = 5;
  sent.stats.probes = 8, sent.stats.skipped = 9;
  const SlabResult came = result_of(to_packet(sent));
  EXPECT_EQ(came.tiles[0], nullptr);
  EXPECT_TRUE(same(*came.tiles[1], *sent.tiles[1]));
  EXPECT_EQ(came.report.removed, sent.report.removed);
  EXPECT_EQ(came.report.events, sent.report.events);
  EXPECT_EQ(came.report.strikes, 5U);
  EXPECT_EQ(came.stats.probes, 8U);
  EXPECT_EQ(came.stats.skipped, 9U);
}

TEST(SlabPackets, MovesArriveBitForBitAndSharedPosesTravelOnce) {
  const ToolShapes shapes(cutters::ball(4, 30), 0.01, 100, 0.2);
  std::vector<Pose> poses{{{0, 0, 0}, kUp}};
  for (int k = 1; k < 200; ++k) poses.push_back({{0.1 * k, std::sin(k), -0.0}, glm::normalize(Vec3(0, 0.001 * k, 1))});
  Moves moves(poses, 1, {&shapes, 1}, 50);
  for (int k = 1; k < 200; ++k) moves.add(1'000'000'000'000 + k, 0, k % 3 == 0);
  moves.finish();
  std::vector<std::uint32_t> all, some;
  for (std::uint32_t k = 0; k < 199; ++k) {
    all.push_back(k);
    if (k % 5 < 2) some.push_back(k);
  }
  SlabMoves came;
  const Bytes whole = to_packet(moves, all);
  add_moves(whole, came), add_moves(to_packet(moves, some), came);
  ASSERT_EQ(came.row.size(), all.size() + some.size());
  std::size_t at = 0;
  for (const auto* chosen : {&all, &some})
    for (const std::uint32_t k : *chosen) {
      EXPECT_EQ(came.row[at], moves.row(k));
      EXPECT_EQ(came.tool[at], 0U);
      EXPECT_EQ(came.rapid[at] != 0, moves.rapid(k));
      EXPECT_EQ(std::memcmp(&came.poses[2 * at], &moves.from(k), sizeof(Pose)), 0);
      EXPECT_EQ(std::memcmp(&came.poses[2 * at + 1], &moves.to(k), sizeof(Pose)), 0);
      ++at;
    }
  EXPECT_LT(whole.size(), all.size() * sizeof(Pose));
}

TEST(SlabPackets, ContextsArriveUnchanged) {
  const Mesh mesh{{{0, 0, 0}, {1e5, 0, 0}, {0, 1, 0.1}}, {{0, 1, 2}}};
  const Tool tool = cutters::fillet(8, 1, 30).with_shank({{30, 3, 40, 3}}).with_holder({{40, 10, 60, 12}});
  const SlabContext sent{{{{{0, 0, -10}, {20, 14, 0}}, 0.2, "xyz"}, {{{1, 2, 3}, {4, 5, 6}}, 0.5, "z"}},
                         {tool, cutters::flat(3, 10)},
                         100,
                         0.01,
                         0.05,
                         25,
                         std::make_shared<const Mesh>(mesh)};
  const SlabContext came = context_of(to_packet(sent));
  EXPECT_TRUE(came.frames == sent.frames);
  ASSERT_EQ(came.tools.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_TRUE(same_shape(came.tools[k], sent.tools[k]));
  EXPECT_EQ(came.reach, 100);
  EXPECT_EQ(came.tolerance, 0.01);
  EXPECT_EQ(came.gouge_tolerance, 0.05);
  EXPECT_EQ(came.top, 25);
  EXPECT_EQ(came.part->vertices, mesh.vertices);
  EXPECT_EQ(came.part->triangles, mesh.triangles);
}

TEST(SlabPackets, EveryTruncationAndEveryChangedBitIsDetected) {
  const Volume volume = cut_block("xyz");
  const Slab slab = slabs_of(volume).front();
  const Bytes good = to_packet(SlabTask{-1, slab, true, 0, tiles_of(volume.grids()[0], slab), {}});
  for (std::size_t n = 0; n < good.size(); n += 1 + n / 64)
    EXPECT_THROW(task_of(std::span(good).first(n)), FormatError) << n;
  for (std::size_t at = 0; at < good.size(); at += 1 + at / 64) {
    Bytes bad = good;
    bad[at] ^= static_cast<std::uint8_t>(1U << (at % 8));
    EXPECT_THROW(task_of(bad), FormatError) << at;
  }
  EXPECT_THROW(result_of(good), FormatError);
}

/// With a checksum that fits, as no accident makes it: still an error, or a task, but no crash.
TEST(SlabPackets, DamageUnderARightChecksumDoesNotCrash) {
  const Volume volume = cut_block("xyz");
  const Slab slab = slabs_of(volume).front();
  const Bytes good = to_packet(SlabTask{-1, slab, true, 0, tiles_of(volume.grids()[0], slab), {}});
  int refused = 0;
  for (std::size_t at = 4; at + 4 < good.size(); at += (test::kSanitized ? 4 : 1) * (1 + at / 256))
    for (const unsigned by : {0x01U, 0x80U, 0xFFU}) {
      Bytes bad = good;
      bad[at] ^= static_cast<std::uint8_t>(by);
      const std::uint32_t crc = base::checksum(std::span(bad).first(bad.size() - 4));
      std::memcpy(bad.data() + bad.size() - 4, &crc, sizeof crc);
      try {
        task_of(bad);
      } catch (const FormatError&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace riffler::verify::slab_packets_test
