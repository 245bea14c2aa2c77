// The program: where the tool goes, how fast and with which tool. The one currency between recording, planning, NC code
// and replay.
#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/pose.hpp"
#include "tool/tool.hpp"

namespace riffler {

/// What is wrong with one row: "name, row 3: what".
class RowError : public std::invalid_argument {
 public:
  RowError(std::string_view name, std::size_t row, const std::string& what)
      : std::invalid_argument(std::string(name) + ", row " + std::to_string(row) + ": " + what),
        row_(row),
        reason_(what) {}

  std::size_t row() const { return row_; }
  /// Without name and row.
  const std::string& reason() const { return reason_; }

 private:
  std::size_t row_;
  std::string reason_;
};

/// One move end. The motion from the row before is that of geom/pose.hpp: the tip on a line, the axis on a great
/// circle.
struct Move {
  Pose pose;
  double feed = 0;     ///< mm/min at the tip; 0 for rapids and for moves in which the tip stands still
  double spindle = 0;  ///< rev/min; > 0 clockwise (M3), < 0 counter-clockwise (M4), 0 stopped
  int tool = 0;        ///< tool number; 0: none
  int line = 0;        ///< 1-based line of the source; 0: no source
  bool rapid = false;
};

/// Rows that one tool makes without a change: [begin, end) of the program.
struct ToolRun {
  int tool = 0;
  std::size_t begin = 0, end = 0;
};

/// Keys and values for the reader of the code (part, recording, …), in the order in which they were given.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// What a reader assumed or passed over, which whoever relies on the program has to know.
struct Note {
  std::string kind;  ///< "skipped", "coordinates", "units", "machine position", "tool length",
                     ///< "cutter compensation", "user code", "end"
  int line = 0;      ///< 1-based, of the source
  std::string message;

  bool operator==(const Note&) const = default;
};

/// Rows in columns. Every row is valid: finite, unit axis, a feed where the tip moves.
class Program {
 public:
  /// Throws std::invalid_argument naming the argument and the row: not finite, an axis whose length differs from 1 by
  /// 1e-6 or more (less is normalised), a negative feed, a feed of 0 in a feed move whose tip moves, a negative tool,
  /// what nc/limits.hpp excludes.
  void append(const Move& move);
  void reserve(std::size_t rows);

  std::size_t size() const { return poses_.size(); }
  bool empty() const { return poses_.empty(); }
  Move operator[](std::size_t row) const;

  const std::vector<Pose>& poses() const { return poses_; }
  const std::vector<double>& feed() const { return feed_; }
  const std::vector<double>& spindle() const { return spindle_; }
  const std::vector<std::int32_t>& tool() const { return tool_; }
  const std::vector<std::int32_t>& line() const { return line_; }
  const std::vector<std::uint8_t>& rapid() const { return rapid_; }  // 0 or 1

  /// Maximal runs of rows with one tool, in order: what a replay sweeps, feed moves and rapids alike.
  std::vector<ToolRun> runs() const;

  /// The tools whose shape is known, by number; a number used by a row need not be here (NC code has no shapes).
  std::map<int, Tool> tools;
  Provenance provenance;
  std::vector<Note> notes;  ///< in the order of their lines

 private:
  std::vector<Pose> poses_;
  std::vector<double> feed_, spindle_;
  std::vector<std::int32_t> tool_, line_;
  std::vector<std::uint8_t> rapid_;
};

/// `pose` with its axis normalised. Throws std::invalid_argument "`name`, row `row`: …" where it is not finite or its
/// axis is not a unit vector within 1e-6.
Pose checked_pose(const Pose& pose, std::string_view name, std::size_t row);

}  // namespace riffler
