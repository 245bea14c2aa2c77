// The engine of verifications: the rows of a program go in, a report comes out.
//
// The stock's grids are cut in slabs, each with the moves that can touch it. What a slab holds of results depends on
// the slab and the moves alone, and the slabs' results are put together in their order: the report is the same, bit for
// bit, for any number of threads, any splitting of the program into chunks, and wherever slabs are simulated.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "nc/follow.hpp"
#include "riffler/verify/report.hpp"
#include "verify/findings.hpp"
#include "verify/program_rows.hpp"
#include "verify/scene.hpp"

namespace riffler::verify {

/// One run of a program, which comes in chunks, each of which begins with the row at which the one before ended. Keeps
/// 16 bytes a row, and nothing of the chunks.
class SlabRun {
 public:
  /// Throws std::invalid_argument naming the argument.
  explicit SlabRun(VerifyArguments arguments, const Progress& progress = {});
  explicit SlabRun(std::shared_ptr<VerifyScene> scene);

  /// Simulates a chunk here. Throws std::invalid_argument naming number, row and line of a tool without a shape, a row
  /// whose axis is exactly opposite to the one before, or where a chunk begins elsewhere than the one before ended.
  /// After an error in it, or Cancelled, this cannot be used any more.
  void feed(const nc::Program& chunk, const Progress& progress = {});
  /// What the rows of all chunks did.
  VerifyReport finish(const Progress& progress = {});

  /// Brings the moves of a chunk to the slabs.
  using Feeder = std::function<void(const RowChunk& chunk, const Progress& progress)>;
  /// Leaves the slabs of a chunk to `feeder`, which changes slabs() and stats(), now or up to finish(). Throws as feed.
  void feed_by(const Feeder& feeder, const nc::Program& chunk, const Progress& progress = {});
  /// Adds to the rows what a slab took, which it forgets. Slabs come in their order, as rounding wants it.
  void take_removed(SlabState& slab);

  const VerifyScene& scene() const { return *scene_; }
  /// How many rows have been fed.
  std::size_t size() const { return rows_.size(); }
  std::vector<SlabState>& slabs() { return slabs_; }
  const std::vector<SlabState>& slabs() const { return slabs_; }
  VerifyStats& stats() { return stats_; }

 private:
  void settle();
  void note_unchecked(VerifyReport& report) const;

  std::shared_ptr<VerifyScene> scene_;
  std::vector<SlabState> slabs_;
  ProgramRows rows_;
  FindingList findings_;
  VerifyStats stats_;
  nc::FollowedChunks followed_;
};

}  // namespace riffler::verify
