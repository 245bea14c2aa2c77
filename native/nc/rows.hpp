// From where a program's axes go to the rows of a Program: chords for curves, parts for moves whose rotary axes turn,
// offsets taken out.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "nc/arc.hpp"
#include "nc/frame.hpp"
#include "nc/machine.hpp"
#include "nc/program.hpp"
#include "nc/source.hpp"

namespace riffler {

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
  /// Keeps `place`. `axis_tolerance`, rad: none leaves a feed move one row, where the tip's way allows it.
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

  /// The words that hold the same pose on `machine` with the same rotary axes; before the first row what they are.
  Joints change_machine(std::unique_ptr<Machine> machine, const Joints& at);

  std::vector<Move>& pending() { return pending_; }

 private:
  /// Whether this rapid is one in which the tool is out of everything's way: from the machine's own retract, by the
  /// text of its block, to the first move of Z. Where it is then is not in the program: it is no row.
  bool is_away(const NcRowWords& words);
  void begin(const Joints& from);
  Joints in_part(const Joints& program) const;
  Pose pose(const Joints& joints);
  Pose between(const Joints& to, int i, int parts) const;
  int rotary_parts(const Joints& to, bool feeds) const;
  double feed_over(double way, const NcRowWords& words) const;
  void check_limits(const Joints& joints) const;
  void row(const Pose& pose, double feed, const NcRowWords& words);

  std::unique_ptr<Machine> machine_;
  double chord_tolerance_;
  std::optional<double> axis_tolerance_;
  const NcPlace& place_;
  NcFrame frame_;
  std::optional<NcFrame> first_;
  bool as_first_ = true;
  bool away_ = false;  // out of everything's way, by the machine's own retract
  // Where the last row is, in the first frame.
  Joints at_{};
  Pose last_{};
  std::vector<Move> pending_;
};

}  // namespace riffler
