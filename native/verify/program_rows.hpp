// Rows of a program that arrives in chunks: positions, durations, removed volumes and tools.
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

/// Moves sorted into slabs at once: about 30 MB of memory, and enough work for many threads.
inline constexpr std::size_t kMovesAtOnce = 1 << 17;

/// A chunk of a program. Each after the first begins with the last row of the one before.
struct RowChunk {
  const nc::Program& program;       ///< without via poses
  std::int64_t first_row;           ///< number of the chunk's row 0
  bool start;                       ///< whether it is the first chunk
  std::vector<std::uint32_t> tool;  ///< the rows' tools, as indices in the toolset

  /// Calls f(moves, progress) with the moves to the chunk's rows from `first` ≥ 1 on, at most kMovesAtOnce at a time.
  /// `shapes` and `top` as for Moves.
  void for_moves(std::size_t first, std::span<const ToolShapes> shapes, double top, const Progress& progress,
                 const std::function<void(const Moves&, const Progress&)>& f) const;
};

/// Keeps 16 bytes per row, and 8 more for rows whose events were not added yet (32 more for feed moves with a stopped
/// spindle).
class ProgramRows {
 public:
  /// Throws std::invalid_argument if the chunk does not begin where the one before ended, as Toolset::places, or if its
  /// poses form no path; then nothing changes.
  RowChunk open(const nc::Program& program, Toolset& tools);
  /// Call it after the chunk's moves were passed to the slabs. `machine`: the machine for limit checks, or null.
  void close(const RowChunk& chunk, double rapid_feed, const MachineChoice* machine);

  /// Adds the notes that are not there yet.
  void add_notes(const std::vector<nc::Note>& notes);

  /// Number of rows so far.
  std::size_t size() const { return removed_.size(); }
  /// Adds the volumes removed in a slab.
  void add_removed(const SlabReport& report);

  /// The rows that are closed but not settled: first number, tools and lines.
  std::int64_t first_open() const { return static_cast<std::int64_t>(size() - tool_.size()); }
  std::span<const std::int32_t> open_tools() const { return tool_; }
  std::span<const std::int32_t> open_lines() const { return line_; }
  /// Adds an event for each of these rows that removed more than `least` (mm³) in a feed move with a stopped spindle.
  void add_spindle(double least, std::vector<Event>& events) const;
  /// Discards tools and lines of these rows: all their events are known.
  void settle();

  const std::set<std::uint32_t>& tools() const { return tools_; }
  bool without_tool() const { return without_tool_; }
  /// Rows that the machine cannot run, at most one per chunk.
  const std::vector<Finding>& faults() const { return faults_; }
  /// Notes of all chunks; later chunks of a stream repeat earlier notes.
  const std::vector<nc::Note>& notes() const { return notes_; }
  /// mm³ and s, one entry per row.
  std::vector<double> take_removed() { return std::move(removed_); }
  std::vector<double> take_seconds() { return std::move(seconds_); }

 private:
  struct StandingMove {
    std::int64_t row;
    Vec3 tip;  // end of the last row
  };

  std::vector<double> removed_, seconds_;
  std::optional<Pose> last_;
  std::vector<std::int32_t> tool_, line_;  // of the open rows
  std::vector<StandingMove> standing_;     // among them: feed moves with a stopped spindle
  std::set<std::uint32_t> tools_;
  bool without_tool_ = false;
  std::vector<Finding> faults_;
  std::vector<nc::Note> notes_;
};

}  // namespace riffler::verify
