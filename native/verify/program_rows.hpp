// The rows of a program that comes in chunks: where it stands, how long it takes, what it takes, with which tools.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/nc/program.hpp"
#include "verify/event.hpp"
#include "verify/machine_check.hpp"
#include "verify/toolset.hpp"

namespace riffler::verify {

/// Moves that are sorted into slabs in one go: memory of some 30 MB, and work enough for many threads.
inline constexpr std::size_t kMovesAtOnce = 1 << 17;

/// A stretch of a program. Each after the first begins with the row at which the one before ended.
struct RowChunk {
  const nc::Program& program;       ///< without via poses
  std::int64_t first_row;           ///< number of the chunk's row 0
  bool start;                       ///< whether it is the first one
  std::vector<std::uint32_t> tool;  ///< places of the rows' tools

  /// Calls f(moves, progress) with the moves to the chunk's rows from `first` ≥ 1 on, kMovesAtOnce at most at a time.
  /// `shapes` and `top` as for Moves.
  void for_moves(std::size_t first, std::span<const ToolShapes> shapes, double top, const Progress& progress,
                 const std::function<void(const Moves&, const Progress&)>& f) const;
};

/// Keeps 16 bytes a row, and 8 of those rows whose events have not been added (feed moves under a spindle that stands:
/// 32 more).
class ProgramRows {
 public:
  /// std::invalid_argument where it begins elsewhere than the one before ended, as Toolset::places, or where its poses
  /// make no path; nothing is changed then.
  RowChunk open(const nc::Program& program, Toolset& tools);
  /// Once its moves are with the slabs. `machine`: on which it is to run, or null.
  void close(const RowChunk& chunk, double rapid_feed, const MachineChoice* machine);

  /// Those that are not there yet.
  void add_notes(const std::vector<nc::Note>& notes);

  /// Rows so far.
  std::size_t size() const { return removed_.size(); }
  /// Adds what a slab took.
  void add_removed(const SlabReport& report);

  /// The rows that have been closed and not settled: their number, tools and lines.
  std::int64_t first_open() const { return static_cast<std::int64_t>(size() - tool_.size()); }
  std::span<const std::int32_t> open_tools() const { return tool_; }
  std::span<const std::int32_t> open_lines() const { return line_; }
  /// An event for each of these rows that took more than `least` (mm³) in a feed move under a spindle that stands.
  void add_spindle(double least, std::vector<Event>& events) const;
  /// Forgets tools and lines of these rows: all their events are known.
  void settle();

  const std::set<std::uint32_t>& tools() const { return tools_; }
  bool without_tool() const { return without_tool_; }
  /// What the machine cannot run, one a chunk at most.
  const std::vector<Finding>& faults() const { return faults_; }
  /// Of all chunks; those of a stream repeat what the ones before had.
  const std::vector<nc::Note>& notes() const { return notes_; }
  /// mm³ and s, one per row.
  std::vector<double> take_removed() { return std::move(removed_); }
  std::vector<double> take_seconds() { return std::move(seconds_); }

 private:
  struct StandingMove {
    std::int64_t row;
    Vec3 tip;  // where it ends
  };

  std::vector<double> removed_, seconds_;
  std::optional<Pose> last_;
  std::vector<std::int32_t> tool_, line_;  // of the last rows
  std::vector<StandingMove> standing_;     // among them: feed moves under a spindle that stands
  std::set<std::uint32_t> tools_;
  bool without_tool_ = false;
  std::vector<Finding> faults_;
  std::vector<nc::Note> notes_;
};

}  // namespace riffler::verify
