// The program: where the tool moves, how fast and with which tool. The common exchange type of recording, planning, NC
// code and replay.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::nc {

/// An error in one row: "name, row 3: what".
class RowError : public std::invalid_argument {
 public:
  RowError(std::string_view name, std::size_t row, const std::string& what)
      : std::invalid_argument(std::string(name) + ", row " + std::to_string(row) + ": " + what),
        name_(name),
        row_(row),
        reason_(what) {}

  /// Name of the argument.
  const std::string& name() const { return name_; }
  std::size_t row() const { return row_; }
  /// The message without name and row.
  const std::string& reason() const { return reason_; }

 private:
  std::string name_;
  std::size_t row_;
  std::string reason_;
};

/// One row: the end of a move. The motion from the row before is that of geom/pose.hpp, with the tip on a line and the
/// axis on a great circle, through the poses of `via` if there are any.
struct Move {
  Pose pose;
  double feed = 0;     ///< mm/min at the tip; 0 for rapids and for moves in which the tip stands still
  double spindle = 0;  ///< rev/min; > 0 clockwise (M3), < 0 counter-clockwise (M4), 0 stopped
  int tool = 0;        ///< tool number; 0: none
  int line = 0;        ///< 1-based line of the source; 0: no source
  bool rapid = false;
  /// The row ends at a position in machine coordinates (G28, G30, G53), whose place in the part is unknown. The pose
  /// repeats the row before: in the part nothing moves. At the beginning of a program such rows are rapids before every
  /// linear axis has been programmed; axes not programmed yet count as 0. The moves to and from such a row are neither
  /// cut nor compared.
  bool at_machine = false;
  /// Intermediate poses of the motion to the row, where rotary axes at constant rates take the tool off the great
  /// circle.
  std::shared_ptr<const std::vector<Pose>> via = nullptr;
};

/// Consecutive rows in the part with one tool: [begin, end) of the program.
struct ToolRun {
  int tool = 0;
  std::size_t begin = 0, end = 0;
};

/// Keys and values about the origin of the program (part, recording, …), in the order in which they were added.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// An assumption or omission of the NC reader that users of the program must know.
struct Note {
  std::string kind;  ///< "skipped", "coordinates", "units", "work offset", "machine position", "rapid", "motion",
                     ///< "start", "tool length", "cutter compensation", "user code", "end"
  int line = 0;      ///< 1-based line of the source
  std::string message;

  bool operator==(const Note&) const = default;
};

/// Rows stored in columns. Every row is valid: finite, with a unit axis, and with a feed where the tip moves.
class Program {
 public:
  /// Appends a row. Throws std::invalid_argument naming argument and row for: values that are not finite; an axis whose
  /// length differs from 1 by 1e-6 or more (less is normalised); a negative feed; a feed of 0 where the tip moves at
  /// feed; a negative tool number; what nc/limits.hpp excludes; an `at_machine` row after the beginning whose pose
  /// differs from the row before. Via poses of the first row are dropped, since no motion leads to it.
  void append(const Move& move);
  /// Reserves memory for `rows` rows.
  void reserve(std::size_t rows);

  std::size_t size() const { return poses_.size(); }
  bool empty() const { return poses_.empty(); }
  /// The row with this index, from 0 to size() − 1.
  Move operator[](std::size_t row) const;

  const std::vector<Pose>& poses() const { return poses_; }
  const std::vector<double>& feed() const { return feed_; }
  const std::vector<double>& spindle() const { return spindle_; }
  const std::vector<std::int32_t>& tool() const { return tool_; }
  const std::vector<std::int32_t>& line() const { return line_; }
  const std::vector<std::uint8_t>& rapid() const { return rapid_; }            // 0 or 1
  const std::vector<std::uint8_t>& at_machine() const { return at_machine_; }  // 0 or 1

  /// Via poses by row, for the rows that have any.
  const std::map<std::size_t, std::shared_ptr<const std::vector<Pose>>>& via() const { return via_; }

  /// Whether the motion that ends at `row` lies in the part, between known places. Always false for row 0.
  bool moves_in_part(std::size_t row) const { return row > 0 && !at_machine_[row] && !at_machine_[row - 1]; }

  /// Maximal runs of rows in the part with one tool, in order. A replay sweeps feed moves and rapids of these alike.
  std::vector<ToolRun> runs() const;

  /// Tools of known shape, by number. A row's number may be missing here, since NC code has no tool shapes.
  std::map<int, Tool> tools;
  Provenance provenance;
  std::vector<Note> notes;  ///< in line order

 private:
  std::vector<Pose> poses_;
  std::vector<double> feed_, spindle_;
  std::vector<std::int32_t> tool_, line_;
  std::vector<std::uint8_t> rapid_, at_machine_;
  std::size_t leading_ = 0;  // number of leading at_machine rows
  std::map<std::size_t, std::shared_ptr<const std::vector<Pose>>> via_;
};

/// `pose` with its axis normalised. Throws std::invalid_argument "`name`, row `row`: …" if it is not finite or its axis
/// is not a unit vector within 1e-6.
Pose checked_pose(const Pose& pose, std::string_view name, std::size_t row);

}  // namespace riffler::nc
