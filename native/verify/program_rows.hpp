// A program that comes in chunks: where it stands, how long it takes, with which tools.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "nc/program.hpp"
#include "verify/event.hpp"
#include "verify/machine_check.hpp"
#include "verify/toolset.hpp"

namespace riffler {

/// Moves that are sorted into slabs in one go: memory of some 30 MB, and work enough for many threads.
inline constexpr std::size_t kMovesAtOnce = 1 << 17;

/// A feed move under a spindle that stands.
struct StandingMove {
  std::int64_t row;
  Vec3 tip;  ///< where it ends
};
std::vector<StandingMove> standing_moves(const Program& program, std::int64_t first_row);
/// An event for each of them that took more than `least` (mm³). `removed` is of the rows from `first_row` on.
void add_spindle(std::span<const StandingMove> moves, std::span<const double> removed, std::int64_t first_row,
                 double least, std::vector<Event>& events);

/// Keeps 8 bytes a row.
class ProgramRows {
 public:
  struct Chunk {
    const Program& program;
    std::int64_t first_row;           ///< number of the chunk's row 0
    bool start;                       ///< whether it is the first one
    std::vector<std::uint32_t> tool;  ///< places of the rows' tools
    /// Calls f(moves, progress) with the chunk's moves in stretches of kMovesAtOnce at most. `shapes` and `top` as for
    /// Moves.
    void for_moves(std::span<const ToolShapes> shapes, double top, const Progress& progress,
                   const std::function<void(const Moves&, const Progress&)>& f) const;
  };
  /// std::invalid_argument where it begins elsewhere than the one before ended, as Toolset::places, or where its poses
  /// make no path; nothing is changed then.
  Chunk open(const Program& program, Toolset& tools) const;
  /// Once its rows have been dealt with. `machine`: on which it is to run, or null.
  void close(const Chunk& chunk, double rapid_feed, const MachineChoice* machine);

  const std::set<std::uint32_t>& tools() const { return tools_; }
  bool without_tool() const { return without_tool_; }
  /// What the machine cannot run, one a chunk at most.
  const std::vector<Finding>& faults() const { return faults_; }
  /// Of all chunks; those of a stream repeat what the ones before had.
  const std::vector<Note>& notes() const { return notes_; }
  /// s, one per row.
  std::vector<double> take_seconds() { return std::move(seconds_); }

 private:
  std::vector<double> seconds_;
  std::optional<Pose> last_;
  std::set<std::uint32_t> tools_;
  bool without_tool_ = false;
  std::vector<Finding> faults_;
  std::vector<Note> notes_;
};

}  // namespace riffler
