#include "verify/slab_job.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace riffler::verify::slab_job_test {
namespace {

SlabState started() {
  SlabState state;
  state.snapshots.push_back({0, {}});
  return state;
}

TEST(SlabState, SnapshotsStayFewAndSpreadOverTheProgram) {
  SlabState state = started();
  for (std::int64_t row = 1; row <= 100'000; ++row) {
    state.save(row, {});
    ASSERT_LE(state.snapshots.size(), SlabState::kMaxSnapshots);
  }
  EXPECT_EQ(state.snapshots.front().row, 0);
  std::int64_t widest = 0;
  for (std::size_t k = 1; k < state.snapshots.size(); ++k)
    widest = std::max(widest, state.snapshots[k].row - state.snapshots[k - 1].row);
  EXPECT_LE(widest, 100'000 / 3);
}

TEST(SlabState, RewindingForgetsWhatCameAfterTheSnapshot) {
  SlabState state = started();
  for (const std::int64_t row : {10, 20, 30}) {
    state.save(row, {});
    state.report.removed.emplace_back(row, 1.0);
    state.report.events.push_back({Kind::Rapid, Member::Cutter, -1, row, 1, 1, {}});
  }
  state.rewind(21);
  EXPECT_EQ(state.done, 20);
  EXPECT_EQ(state.report.removed.size(), 2U);
  EXPECT_EQ(state.report.events.size(), 2U);
  state.rewind(20);  // the snapshot of row 20 has that row in it
  EXPECT_EQ(state.done, 10);
  state.rewind(1);
  EXPECT_EQ(state.done, 0);
  EXPECT_TRUE(state.report.removed.empty() && state.report.events.empty());
}

TEST(SlabState, RowsBehindAnEditAreRenumbered) {
  SlabState state = started();
  for (const std::int64_t row : {10, 20}) state.save(row, {}), state.report.removed.emplace_back(row, 1.0);
  state.renumber(15, -3);
  EXPECT_EQ(state.report.removed[0].first, 10);
  EXPECT_EQ(state.report.removed[1].first, 17);
  EXPECT_EQ(state.snapshots.back().row, 17);
}

}  // namespace
}  // namespace riffler::verify::slab_job_test
