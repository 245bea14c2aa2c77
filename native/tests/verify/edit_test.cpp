#include "verify/edit.hpp"

#include <gtest/gtest.h>

#include "riffler/tool/cutters.hpp"

namespace riffler::verify::edit_test {
namespace {

using Rows = std::vector<std::int64_t>;

RunRows program(const std::vector<double>& x) {
  RunRows out;
  for (const double at : x) out.poses.push_back({{at, 0, 0}, {0, 0, 1}});
  out.tool.assign(x.size(), 0), out.rapid.assign(x.size(), 0);
  return out;
}

TEST(Edit, TheSameProgramHasNoDifference) {
  const ProgramEdit edit = edit_between(program({0, 1, 2, 3}), program({0, 1, 2, 3}));
  EXPECT_TRUE(edit.before.empty() && edit.now.empty());
  EXPECT_EQ(edit.shift, 0);
}

TEST(Edit, AChangedPlaceChangesTheMovesToItAndFromIt) {
  const ProgramEdit edit = edit_between(program({0, 1, 2, 3, 4, 5}), program({0, 1, 7, 3, 4, 5}));
  EXPECT_EQ(edit.before, (Rows{2, 3}));
  EXPECT_EQ(edit.now, (Rows{2, 3}));
  RunRows rapid = program({0, 1, 2, 3, 4, 5});
  rapid.rapid[4] = 1;
  EXPECT_EQ(edit_between(program({0, 1, 2, 3, 4, 5}), rapid).now, (Rows{4}));
  rapid.tool[1] = 3;
  EXPECT_EQ(edit_between(program({0, 1, 2, 3, 4, 5}), rapid).now, (Rows{1, 4}));
}

TEST(Edit, RowsAfterAnInsertionMoveOn) {
  const ProgramEdit edit = edit_between(program({0, 1, 2, 3, 4}), program({0, 1, 9, 2, 3, 4}));
  EXPECT_EQ(edit.before, (Rows{2}));
  EXPECT_EQ(edit.now, (Rows{2, 3}));
  EXPECT_EQ(edit.tail, 3);
  EXPECT_EQ(edit.shift, 1);
}

TEST(Edit, DeletingAppendingAndEmptyProgramsAreCovered) {
  EXPECT_EQ(edit_between(program({0, 1, 2}), program({0, 2})).before, (Rows{1, 2}));
  EXPECT_EQ(edit_between(program({0, 1, 2}), program({0, 1, 2, 3})).now, (Rows{3}));
  EXPECT_EQ(edit_between(program({0, 1, 2}), program({})).before, (Rows{1, 2}));
  EXPECT_EQ(edit_between(program({}), program({0, 1, 2})).now, (Rows{1, 2}));
  EXPECT_TRUE(edit_between(program({}), program({0})).now.empty());
  // No move counts both from the beginning and from the end.
  const ProgramEdit edit = edit_between(program({0, 0, 0}), program({0, 0, 0, 0}));
  EXPECT_TRUE(edit.before.empty());
  EXPECT_EQ(edit.now, (Rows{3}));
}

TEST(Edit, MovesOfRowsArePassedOnInIntervals) {
  std::vector<double> x(70'000);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = static_cast<double>(k);
  const RunRows rows = program(x);
  Rows all;
  for (std::int64_t row = 1; row < 70'000; ++row) all.push_back(row);
  const std::vector<ToolShapes> shapes{ToolShapes(cutters::ball(2, 5), 0.01, 10, 0.5)};
  std::size_t seen = 0;
  for_moves_of(rows, all, shapes, 10, [&](const Moves& moves) {
    for (std::size_t i = 0; i < moves.size(); ++i, ++seen) {
      ASSERT_EQ(moves.row(i), all[seen]);
      ASSERT_EQ(moves.to(i).tip.x, static_cast<double>(all[seen]));
      ASSERT_EQ(moves.from(i).tip.x, static_cast<double>(all[seen] - 1));
    }
  });
  EXPECT_EQ(seen, all.size());
}

}  // namespace
}  // namespace riffler::verify::edit_test
