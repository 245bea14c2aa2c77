// From where a program's axes go to the rows of a Program: chords for curves, parts for moves whose rotary axes turn,
// offsets taken out.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "nc/machine/machine.hpp"
#include "nc/read/arc.hpp"
#include "nc/read/frame.hpp"
#include "nc/source.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// What the rows of a block say beside where they are.
struct NcRowWords {
  bool rapid = false;
  double feed = 0;            ///< mm/min, or 1/min
  bool inverse_time = false;  ///< what feed means
  double spindle = 0;
  int tool = 0;
  int line = 0;
};

class NcRows {
 public:
  /// rad: where rotary axes that turn evenly leave the great circle by more, the poses on their way are kept.
  static constexpr double kAxisBound = 0.002;

  /// Keeps `place`. `axis_tolerance`, rad, makes rows of those poses. Without it a block is one row, with them as via
  /// poses, where the tip's way allows it.
  NcRows(std::unique_ptr<Machine> machine, double chord_tolerance, std::optional<double> axis_tolerance,
         const NcPlace& place)
      : machine_(std::move(machine)),
        chord_tolerance_(chord_tolerance),
        axis_tolerance_(axis_tolerance),
        place_(place) {}

  const Machine& machine() const { return *machine_; }
  double chord_tolerance() const { return chord_tolerance_; }

  /// Rows are in the program coordinates of the frame that holds when the first of them is made.
  void set_frame(const NcFrame& frame) {
    frame_ = frame;
    as_first_ = !first_ || frame == *first_;
  }
  const NcFrame& frame() const { return frame_; }

  /// From `from` to `to`, program coordinates.
  void line(const Joints& from, const Joints& to, const NcRowWords& words);
  /// The same along an arc in the plane of the joints u, v; the others move evenly.
  void arc(const Joints& from, const Joints& to, const Arc& arc, std::size_t u, std::size_t v, const NcRowWords& words);
  /// Along a curve of `parts` chords of `length` mm in all: `at(t)`, 0 < t ≤ 1.
  void curve(const Joints& from, int parts, double length, const std::function<Joints(double)>& at,
             const NcRowWords& words);

  /// A row at a position of the machine, whose place in the part is not known: the pose stays what it was. Before the
  /// first row there is none: where that comes from nobody knows either.
  void at_machine(const NcRowWords& words);
  bool begun() const { return first_.has_value(); }
  /// Rows that are made from now on wait until it is known whether where they are counts.
  void hold() { holds_ = true; }
  std::size_t held() const { return held_.size(); }
  /// Those that wait: as they are, or at positions of the machine.
  void release(bool in_part);

  /// One row at `pose`, which `to` holds: the tool's axis is given as such.
  void line_to_pose(const Joints& from, const Joints& to, const Pose& pose, const NcRowWords& words);

  /// The words that hold the same pose on `machine` with the same rotary axes; before the first row what they are.
  Joints change_machine(std::unique_ptr<Machine> machine, const Joints& at);

  std::vector<Move>& pending() { return pending_; }

 private:
  void begin(const Joints& from);
  Joints in_part(const Joints& program) const;
  Pose pose(const Joints& joints);
  Pose between(const Joints& to, int i, int parts) const;
  int rotary_parts(const Joints& to) const;
  std::vector<Pose> poses_on_the_way(const Joints& to, const NcRowWords& words) const;
  std::vector<Pose> dog_leg(const Joints& to) const;
  bool is_great_circle(const Joints& to) const;
  double axis_bound() const { return axis_tolerance_.value_or(kAxisBound); }
  double feed_over(double way, const NcRowWords& words) const;
  void check_limits(const Joints& joints) const;
  void row(const Pose& pose, double feed, const NcRowWords& words);
  std::vector<Move>& rows() { return holds_ ? held_ : pending_; }

  std::unique_ptr<Machine> machine_;
  double chord_tolerance_;
  std::optional<double> axis_tolerance_;
  const NcPlace& place_;
  NcFrame frame_;
  std::optional<NcFrame> first_;
  bool as_first_ = true, away_ = false;  // away: the last row is at a position of the machine
  // Where the last row is, in the first frame.
  Joints at_{};
  Pose last_{};
  std::vector<Move> pending_, held_;
  bool holds_ = false;
};

}  // namespace riffler::nc
