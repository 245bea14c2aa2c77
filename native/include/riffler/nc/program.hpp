// The program: where the tool goes, how fast and with which tool. The one currency between recording, planning, NC code
// and replay.
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

/// What is wrong with one row: "name, row 3: what".
class RowError : public std::invalid_argument {
 public:
  RowError(std::string_view name, std::size_t row, const std::string& what)
      : std::invalid_argument(std::string(name) + ", row " + std::to_string(row) + ": " + what),
        name_(name),
        row_(row),
        reason_(what) {}

  /// Of the argument.
  const std::string& name() const { return name_; }
  std::size_t row() const { return row_; }
  /// Without name and row.
  const std::string& reason() const { return reason_; }

 private:
  std::string name_;
  std::size_t row_;
  std::string reason_;
};

/// One move end. The motion from the row before is that of geom/pose.hpp: the tip on a line, the axis on a great
/// circle; by way of `via`, if there are any.
struct Move {
  Pose pose;
  double feed = 0;     ///< mm/min at the tip; 0 for rapids and for moves in which the tip stands still
  double spindle = 0;  ///< rev/min; > 0 clockwise (M3), < 0 counter-clockwise (M4), 0 stopped
  int tool = 0;        ///< tool number; 0: none
  int line = 0;        ///< 1-based line of the source; 0: no source
  bool rapid = false;
  /// Ends at a position of the machine (G28, G30, G53) whose place in the part nobody knows. The pose is that of the
  /// row before: nothing moves in the part's picture. At the beginning of a program: rapids before every linear axis
  /// has been named, those that have not taken for 0. Neither the motion there nor the one that leaves it is cut or
  /// compared.
  bool at_machine = false;
  /// Poses on the way to a row, where rotary axes that turn evenly take the tool another way than the great circle.
  std::shared_ptr<const std::vector<Pose>> via = nullptr;
};

/// Rows that one tool makes without a change, all of them in the part: [begin, end) of the program.
struct ToolRun {
  int tool = 0;
  std::size_t begin = 0, end = 0;
};

/// Keys and values for the reader of the code (part, recording, …), in the order in which they were given.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// An assumption or omission of the reader, which users of the program must know.
struct Note {
  std::string kind;  ///< "skipped", "coordinates", "units", "work offset", "machine position", "rapid", "motion",
                     ///< "start", "tool length", "cutter compensation", "user code", "end"
  int line = 0;      ///< 1-based, of the source
  std::string message;

  bool operator==(const Note&) const = default;
};

/// Rows in columns. Every row is valid: finite, unit axis, a feed where the tip moves.
class Program {
 public:
  /// Throws std::invalid_argument naming the argument and the row: not finite, an axis whose length differs from 1 by
  /// 1e-6 or more (less is normalised), a negative feed, a feed of 0 in a feed move whose tip moves, a negative tool,
  /// what nc/limits.hpp excludes, a row at a machine's position, not at the beginning, that has another pose than the
  /// row before. Via poses of the first row, which nothing leads to, are left out.
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
  const std::vector<std::uint8_t>& rapid() const { return rapid_; }            // 0 or 1
  const std::vector<std::uint8_t>& at_machine() const { return at_machine_; }  // 0 or 1

  /// Of the rows that have any.
  const std::map<std::size_t, std::shared_ptr<const std::vector<Pose>>>& via() const { return via_; }

  /// Whether the motion that ends with `row` is one in the part, between places that are known. Never true of row 0.
  bool moves_in_part(std::size_t row) const { return row > 0 && !at_machine_[row] && !at_machine_[row - 1]; }

  /// Maximal runs of rows in the part with one tool, in order: what a replay sweeps, feed moves and rapids alike.
  std::vector<ToolRun> runs() const;

  /// The tools whose shape is known, by number; a number used by a row need not be here (NC code has no shapes).
  std::map<int, Tool> tools;
  Provenance provenance;
  std::vector<Note> notes;  ///< in the order of their lines

 private:
  std::vector<Pose> poses_;
  std::vector<double> feed_, spindle_;
  std::vector<std::int32_t> tool_, line_;
  std::vector<std::uint8_t> rapid_, at_machine_;
  std::size_t leading_ = 0;  // rows at the beginning that are all at positions of the machine
  std::map<std::size_t, std::shared_ptr<const std::vector<Pose>>> via_;
};

/// `pose` with its axis normalised. Throws std::invalid_argument "`name`, row `row`: …" where it is not finite or its
/// axis is not a unit vector within 1e-6.
Pose checked_pose(const Pose& pose, std::string_view name, std::size_t row);

}  // namespace riffler::nc
