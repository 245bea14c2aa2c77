// From axis positions of a program to rows of a Program: splits curves into chords and rotary moves into parts, removes
// offsets.
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

/// Data of a block's rows other than their position.
struct NcRowWords {
  bool rapid = false;
  double feed = 0;            ///< mm/min, or 1/min
  bool inverse_time = false;  ///< whether `feed` is 1/min
  double spindle = 0;
  int tool = 0;
  int line = 0;
};

class NcRows {
 public:
  /// rad: if uniformly turning rotary axes leave the great circle by more, the poses between are kept.
  static constexpr double kAxisBound = 0.002;

  /// Keeps a reference to `place`. `axis_tolerance` (rad) turns those poses into rows. Without it a block is one row,
  /// with those poses as via poses, if the tip's path permits.
  NcRows(std::unique_ptr<Machine> machine, double chord_tolerance, std::optional<double> axis_tolerance,
         const NcPlace& place)
      : machine_(std::move(machine)),
        chord_tolerance_(chord_tolerance),
        axis_tolerance_(axis_tolerance),
        place_(place) {}

  const Machine& machine() const { return *machine_; }
  double chord_tolerance() const { return chord_tolerance_; }

  /// Rows are in the program coordinates of the frame that is active when the first of them is made.
  void set_frame(const NcFrame& frame) {
    frame_ = frame;
    as_first_ = !first_ || frame == *first_;
  }
  const NcFrame& frame() const { return frame_; }

  /// A line between program coordinates.
  void line(const Joints& from, const Joints& to, const NcRowWords& words);
  /// As above along an arc in the plane of joints u, v; the others move evenly.
  void arc(const Joints& from, const Joints& to, const Arc& arc, std::size_t u, std::size_t v, const NcRowWords& words);
  /// Along a curve of `parts` chords with a total `length` (mm): `at(t)`, 0 < t ≤ 1.
  void curve(const Joints& from, int parts, double length, const std::function<Joints(double)>& at,
             const NcRowWords& words);

  /// A row at a machine position, whose place in the part is unknown: the pose repeats the last one. Before the first
  /// row it adds nothing, since the start of that is unknown too.
  void at_machine(const NcRowWords& words);
  bool begun() const { return first_.has_value(); }
  /// From now on, rows wait until it is known whether their positions count.
  void hold() { holds_ = true; }
  std::size_t held() const { return held_.size(); }
  /// Releases waiting rows: unchanged, or as machine positions.
  void release(bool in_part);

  /// One row at `pose`, held by joints `to`: the tool's axis is given directly.
  void line_to_pose(const Joints& from, const Joints& to, const Pose& pose, const NcRowWords& words);

  /// The words that give the same pose on `machine` with the same rotary axes; unchanged before the first row.
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
  bool as_first_ = true, away_ = false;  // away: the last row is at a machine position
  // Position of the last row, in the first frame.
  Joints at_{};
  Pose last_{};
  std::vector<Move> pending_, held_;
  bool holds_ = false;
};

}  // namespace riffler::nc
