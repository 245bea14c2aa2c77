#include "riffler/dexel/boolean.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "dexel/volumes.hpp"

namespace riffler::dexel::boolean_test {
namespace {

using namespace test;

const Boolean kAll[] = {Boolean::Subtract, Boolean::Add, Boolean::Intersect};

Cells reference(Boolean op, const Cells& a, const Cells& b) {
  return op == Boolean::Subtract ? a & ~b : op == Boolean::Add ? a | b : a & b;
}

Volume result(Boolean op, Volume a, const Volume& b) {
  apply(op, a, b);
  return a;
}

/// One ray of a 1 × 1 × 10 mm block with given spans; normals name the operand and the end.
Volume one_ray(const std::vector<Span>& spans, double tilt, const std::string& directions = "z") {
  Volume volume({{{0, 0, 0}, {1, 1, 10}}, 1, directions});
  Grid& grid = *const_cast<Grid*>(volume.grid(Axis::Z));
  TileBuilder builder(grid.has_normals());
  for (const Span& s : spans) builder.add(s, {PackedNormal::pack({tilt, 0, -1}), PackedNormal::pack({0, tilt, 1})});
  builder.next_ray();
  grid.set_tile(0, builder.finish());
  return volume;
}

std::vector<Span> rays_of(const Volume& v) {
  const auto ray = v.grid(Axis::Z)->ray(0, 0);
  return {ray.begin(), ray.end()};
}

using Spans = std::vector<Span>;

std::vector<Span> combine(Boolean op, const Spans& a, const Spans& b) {
  return rays_of(result(op, one_ray(a, 0.1), one_ray(b, 0.2)));
}

TEST(Boolean, AnEmptyOperandGivesTheOtherOrNothing) {
  const Spans some{{1, 2}, {3, 4}};
  EXPECT_EQ(combine(Boolean::Subtract, {}, some), Spans{});
  EXPECT_EQ(combine(Boolean::Subtract, some, {}), some);
  EXPECT_EQ(combine(Boolean::Add, {}, some), some);
  EXPECT_EQ(combine(Boolean::Add, some, {}), some);
  EXPECT_EQ(combine(Boolean::Intersect, {}, some), Spans{});
  EXPECT_EQ(combine(Boolean::Intersect, some, {}), Spans{});
}

TEST(Boolean, TouchingSpansJoinAndLeaveNothingBetween) {
  EXPECT_EQ(combine(Boolean::Add, {{1, 2}}, {{2, 3}}), (Spans{{1, 3}}));
  EXPECT_EQ(combine(Boolean::Add, {{1, 2}, {3, 4}}, {{2, 3}}), (Spans{{1, 4}}));
  EXPECT_EQ(combine(Boolean::Intersect, {{1, 2}}, {{2, 3}}), Spans{});
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 2}}, {{2, 3}}), (Spans{{1, 2}}));
}

TEST(Boolean, EqualEndsAndNestedSpansCombineExactly) {
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 5}}, {{1, 3}}), (Spans{{3, 5}}));
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 5}}, {{3, 5}}), (Spans{{1, 3}}));
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 5}}, {{1, 5}}), Spans{});
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 5}}, {{2, 3}}), (Spans{{1, 2}, {3, 5}}));
  EXPECT_EQ(combine(Boolean::Subtract, {{2, 3}}, {{1, 5}}), Spans{});
  EXPECT_EQ(combine(Boolean::Add, {{1, 5}}, {{2, 3}}), (Spans{{1, 5}}));
  EXPECT_EQ(combine(Boolean::Intersect, {{1, 5}}, {{2, 3}, {4, 5}}), (Spans{{2, 3}, {4, 5}}));
}

TEST(Boolean, SliversAndGapsBelowABillionthOfThePitchVanish) {
  const double thin = 0.5e-9, thick = 2e-9;
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 5}}, {{1 + thin, 5}}), Spans{});
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 5}}, {{1 + thick, 5}}), (Spans{{1, 1 + thick}}));
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 5}}, {{3, 3 + thin}}), (Spans{{1, 5}}));
  EXPECT_EQ(combine(Boolean::Subtract, {{1, 5}}, {{3, 3 + thick}}), (Spans{{1, 3}, {3 + thick, 5}}));
  EXPECT_EQ(combine(Boolean::Add, {{1, 2}}, {{2 + thin, 3}}), (Spans{{1, 3}}));
  EXPECT_EQ(combine(Boolean::Intersect, {{1, 2}}, {{2 - thin, 3}}), Spans{});
}

TEST(Boolean, EndsOfTheOtherOperandKeepItsNormals) {
  const auto normals = [](Boolean op, const Spans& a, const Spans& b) {
    const Volume v = result(op, one_ray(a, 0.1, "xyz"), one_ray(b, 0.2, "xyz"));
    const auto n = v.grid(Axis::Z)->ray_normals(0, 0);
    return std::vector<SpanNormals>(n.begin(), n.end());
  };
  const SpanNormals a{PackedNormal::pack({0.1, 0, -1}), PackedNormal::pack({0, 0.1, 1})};
  const SpanNormals b{PackedNormal::pack({0.2, 0, -1}), PackedNormal::pack({0, 0.2, 1})};
  EXPECT_EQ(normals(Boolean::Add, {{1, 3}}, {{2, 4}}), (std::vector<SpanNormals>{{a.near, b.far}}));
  EXPECT_EQ(normals(Boolean::Intersect, {{1, 3}}, {{2, 4}}), (std::vector<SpanNormals>{{b.near, a.far}}));
  // Equal ends keep a's.
  EXPECT_EQ(normals(Boolean::Add, {{1, 3}}, {{1, 4}}), (std::vector<SpanNormals>{{a.near, b.far}}));
  const auto cut = normals(Boolean::Subtract, {{1, 9}}, {{2, 4}});
  ASSERT_EQ(cut.size(), 2U);
  EXPECT_EQ(cut[0].near, a.near);
  EXPECT_EQ(cut[1].far, a.far);
  EXPECT_LT(glm::length(cut[0].far.unpack() + b.near.unpack()), 1e-12);
  EXPECT_LT(glm::length(cut[1].near.unpack() + b.far.unpack()), 1e-12);
}

TEST(Boolean, SubtractionReversesNormalsExactly) {
  std::mt19937 random(5);
  std::vector<Vec3> all{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int k = 0; k < 1000; ++k) {
    std::normal_distribution<double> d;
    all.emplace_back(d(random), d(random), d(random));
  }
  for (const Vec3& n : all) {
    Volume a = one_ray({{1, 9}}, 0.1, "xyz"), b = one_ray({}, 0, "xyz");
    TileBuilder builder(true);
    builder.add({2, 4}, {PackedNormal::pack(n), PackedNormal::pack(n)});
    const_cast<Grid*>(b.grid(Axis::Z))->set_tile(0, builder.finish());
    apply(Boolean::Subtract, a, b);
    const Vec3 turned = a.grid(Axis::Z)->ray_normals(0, 0)[0].far.unpack();
    ASSERT_LT(glm::length(turned + PackedNormal::pack(n).unpack()), 1e-15) << n.x << " " << n.y << " " << n.z;
  }
}

TEST(Boolean, AgreesWithDenseCellsOnRandomVolumes) {
  for (const char* directions : {"z", "xyz"})
    for (unsigned seed = 1; seed <= 6; ++seed) {
      const Frame frame = lattice_frame(directions, 0.37);
      const Volume a = random_volume(frame, seed), b = random_volume(frame, seed + 100);
      for (const Boolean op : kAll) {
        const Volume c = result(op, a, b);
        for (std::size_t g = 0; g < c.grids().size(); ++g) {
          const Grid &ga = a.grids()[g], &gb = b.grids()[g], &gc = c.grids()[g];
          for (int i = 0; i < gc.nu(); ++i)
            for (int j = 0; j < gc.nv(); ++j)
              ASSERT_EQ(cells_of(gc.ray(i, j)), reference(op, cells_of(ga.ray(i, j)), cells_of(gb.ray(i, j))));
          for (std::size_t t = 0; t < gc.tile_count(); ++t)
            for (const Span& s : gc.tile(t).spans) {
              ASSERT_LE(gc.tile(t).reach.near, s.near);
              ASSERT_GE(gc.tile(t).reach.far, s.far);
            }
        }
      }
    }
}

TEST(Boolean, ObeysTheLawsOfSets) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Frame frame = lattice_frame("xyz");
    const Volume box = Volume::block(frame), none(frame);
    const Volume a = random_volume(frame, seed), b = random_volume(frame, seed + 50),
                 c = random_volume(frame, seed + 9);
    EXPECT_TRUE(same_spans(result(Boolean::Add, a, b), result(Boolean::Add, b, a)));
    EXPECT_TRUE(same_spans(result(Boolean::Intersect, a, b), result(Boolean::Intersect, b, a)));
    const auto complement = [&](const Volume& v) { return result(Boolean::Subtract, box, v); };
    EXPECT_TRUE(
        same_spans(complement(result(Boolean::Add, a, b)), result(Boolean::Intersect, complement(a), complement(b))));
    EXPECT_TRUE(same_spans(complement(complement(a)), a));
    EXPECT_TRUE(same_spans(result(Boolean::Subtract, a, b), result(Boolean::Intersect, a, complement(b))));
    EXPECT_TRUE(same_spans(result(Boolean::Add, result(Boolean::Add, a, b), c),
                           result(Boolean::Add, a, result(Boolean::Add, b, c))));
    EXPECT_TRUE(same_rays(result(Boolean::Add, a, a), a));
    EXPECT_TRUE(same_rays(result(Boolean::Intersect, a, a), a));
    EXPECT_TRUE(same_rays(result(Boolean::Subtract, a, a), none));
    EXPECT_TRUE(same_rays(result(Boolean::Intersect, a, box), a));
    EXPECT_TRUE(same_spans(result(Boolean::Add, a, box), box));
  }
}

TEST(Boolean, MayTakeItselfAsTheOtherOperand) {
  Volume a = random_volume(lattice_frame("z"), 3);
  const Volume before = a;
  apply(Boolean::Add, a, a);
  EXPECT_TRUE(same_rays(a, before));
  EXPECT_EQ(a.revision(), before.revision());
  apply(Boolean::Subtract, a, a);
  EXPECT_EQ(a.volume(), 0);
  EXPECT_NE(a.revision(), before.revision());
}

TEST(Boolean, LeavesUnchangedTilesSharedAndCountsTheRest) {
  const Frame frame{{{0, 0, 0}, {64, 64, 10}}, 0.5, "z"};  // 4 × 4 tiles
  Volume a = Volume::block(frame);
  const Volume before = a;
  Volume b(frame);
  TileBuilder builder(false);
  builder.add({2, 4});
  b.grids()[0].set_tile(5, builder.finish());
  a.take_stats();
  apply(Boolean::Subtract, a, b);
  for (std::size_t t = 0; t < 16; ++t) {
    const bool same = a.grids()[0].shared_tile(t) == before.grids()[0].shared_tile(t);
    EXPECT_EQ(same, t != 5);
    EXPECT_EQ(a.grids()[0].tile(t).revision == before.grids()[0].tile(t).revision, same);
  }
  EXPECT_EQ(a.take_stats().tiles_changed, 1U);

  const std::uint64_t revision = a.revision();
  apply(Boolean::Subtract, a, b);  // again: nothing is left there
  EXPECT_EQ(a.revision(), revision);
  apply(Boolean::Intersect, a, before);
  EXPECT_EQ(a.revision(), revision);
  EXPECT_EQ(a.take_stats().tiles_changed, 0U);
  apply(Boolean::Add, a, before);
  EXPECT_EQ(a.grids()[0].shared_tile(5), before.grids()[0].shared_tile(5)) << "a full tile is taken over, not copied";
}

TEST(Boolean, DistinguishesABorderTileFromAnEqualInnerOne) {
  // 40 rays along v: the second tile has 8 columns. Its full tile, standing at the first place, covers 8 of 32 columns.
  const Frame frame{{{0, 0, 0}, {32, 40, 10}}, 1, "z"};
  const Volume box = Volume::block(frame);
  Volume narrow(frame);
  for (const std::size_t t : {0U, 1U}) narrow.grids()[0].set_tile(t, box.grids()[0].shared_tile(1));
  EXPECT_EQ(narrow.volume(), 2 * 32 * 8 * 10);
  EXPECT_EQ(result(Boolean::Intersect, box, narrow).volume(), 2 * 32 * 8 * 10);
  EXPECT_EQ(result(Boolean::Subtract, box, narrow).volume(), 32 * 24 * 10);
  EXPECT_EQ(result(Boolean::Add, narrow, box).volume(), box.volume());
}

TEST(Boolean, RefusesAnotherGridAndNamesWhatDiffers) {
  Volume a = Volume::block({{{0, 0, 0}, {4, 4, 4}}, 0.5, "z"});
  const Volume before = a;
  const auto message = [&](const Frame& frame) -> std::string {
    try {
      apply(Boolean::Subtract, a, Volume::block(frame));
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message({{{0, 0, 0}, {4, 4, 4}}, 0.25, "z"}).find("pitch"), std::string::npos);
  EXPECT_NE(message({{{0, 0, 1}, {4, 4, 4}}, 0.5, "z"}).find("lower"), std::string::npos);
  EXPECT_NE(message({{{0, 0, 0}, {4, 4, 5}}, 0.5, "z"}).find("upper"), std::string::npos);
  EXPECT_NE(message({{{0, 0, 0}, {4, 4, 4}}, 0.5, "xyz"}).find("directions"), std::string::npos);
  EXPECT_TRUE(same_rays(a, before));
}

TEST(Boolean, CancelledLeavesTheVolume) {
  Volume a = random_volume(lattice_frame("xyz", 0.1), 1);
  const Volume before = a, b = random_volume(lattice_frame("xyz", 0.1), 2);
  EXPECT_THROW(apply(Boolean::Subtract, a, b, [](double) { return false; }), Cancelled);
  EXPECT_TRUE(same_rays(a, before));
  EXPECT_EQ(a.revision(), before.revision());
}

TEST(Boolean, IsTheSameForAnyNumberOfThreads) {
  const Frame frame = lattice_frame("xyz", 0.15);
  const Volume a = random_volume(frame, 11), b = random_volume(frame, 12);
  const char* set = std::getenv("RIFFLER_THREADS");
  const std::string kept = set ? set : "";
  for (const Boolean op : kAll) {
    setenv("RIFFLER_THREADS", "1", 1);
    const Volume one = result(op, a, b);
    setenv("RIFFLER_THREADS", "5", 1);
    EXPECT_TRUE(same_rays(result(op, a, b), one));
  }
  kept.empty() ? unsetenv("RIFFLER_THREADS") : setenv("RIFFLER_THREADS", kept.c_str(), 1);
}

}  // namespace
}  // namespace riffler::dexel::boolean_test
