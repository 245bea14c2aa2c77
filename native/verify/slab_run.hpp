// The engine of verification: takes the rows of a program and returns a report.
//
// The stock's grids are divided into slabs, each with the moves that can touch it. A slab's results depend only on the
// slab and its moves, and are combined in slab order. The report is therefore bit-identical for any number of threads,
// any division of the program into chunks, and wherever slabs are simulated.
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

/// One run of a program that arrives in chunks, each beginning with the last row of the one before. Keeps 16 bytes per
/// row and nothing of the chunks.
class SlabRun {
 public:
  /// Throws std::invalid_argument naming the argument.
  explicit SlabRun(VerifyArguments arguments, const Progress& progress = {});
  explicit SlabRun(std::shared_ptr<VerifyScene> scene);

  /// Simulates a chunk in this process. Throws std::invalid_argument naming number, row and line of a tool without a
  /// shape, a row whose axis is exactly opposite to the one before, or a chunk that does not begin where the one before
  /// ended. After an error here, or Cancelled, this object cannot be used any more.
  void feed(const nc::Program& chunk, const Progress& progress = {});
  /// The report on the rows of all chunks.
  VerifyReport finish(const Progress& progress = {});

  /// Passes the moves of a chunk to the slabs.
  using Feeder = std::function<void(const RowChunk& chunk, const Progress& progress)>;
  /// Leaves the slabs of a chunk to `feeder`, which updates slabs() and stats() then or until finish(). Throws as feed.
  void feed_by(const Feeder& feeder, const nc::Program& chunk, const Progress& progress = {});
  /// Adds the volumes removed in a slab to the rows and clears them. Call it in slab order, so that rounding is
  /// reproducible.
  void take_removed(SlabState& slab);

  const VerifyScene& scene() const { return *scene_; }
  /// Number of rows fed.
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
