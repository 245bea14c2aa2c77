#include "nc/write/block_maker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/number_text.hpp"
#include "nc/retract_path.hpp"
#include "nc/write/arc_fit.hpp"
#include "nc/write/rotary.hpp"
#include "nc/write/subdivider.hpp"

namespace riffler::nc {

namespace {

class BlockMaker {
 public:
  BlockMaker(const Program& program, const BlockSettings& settings, BlockSink& sink)
      : program_(program), settings_(settings), machine_(settings.machine), sink_(sink) {}

  WriteReport run() {
    if (settings_.joints)
      by_joints();
    else
      by_poses();
    return std::move(report_);
  }

 private:
  void by_poses() {
    for (std::size_t row = 0; row < program_.size(); ++row) {
      const bool away = program_.at_machine()[row] != 0, rapid = program_.rapid()[row] != 0;
      const Pose& pose = program_.poses()[row];
      if (row > 0 && away != away_ && pose.tip.z < whole_space().top) {
        std::vector<Pose> out = retract_path(pose, reach(row), whole_space());
        if (!away) std::reverse(out.begin(), out.end());
        for (const Pose& p : out) by_pose(row, p, away || rapid || p.tip.z >= whole_space().top);
      }
      set_up(row);
      if (!away) by_pose(row, pose, rapid);
      away_ = away;
    }
  }

  void by_pose(std::size_t row, const Pose& pose, bool rapid) {
    check_range(row, {pose.tip.x, pose.tip.y, pose.tip.z, 0, 0, 0});
    if (settings_.motion && row > 0) report_.motion.push_back({row, before_, pose, rapid, false});
    before_ = pose;
    sink_.block({pose, {}, rapid, false, rapid ? 0 : feed_of(row), 0, true});
  }

  void by_joints() {
    const std::vector<bool> free = free_moves(program_, settings_.safe_height);
    const std::vector<Waypoint> way = choose_joints(program_, machine_, settings_.axis_tolerance, free);
    Subdivider splitter(machine_, settings_.tolerance, settings_.axis_tolerance);
    before_ = {};
    for (std::size_t k = 0; k < way.size(); ++k) {
      if (const std::size_t last = settings_.arcs ? run_end(way, k) : k; last > k) {
        curves(std::span(way).subspan(k, last + 1 - k));
        k = last;
      } else {
        move(way[k], free[way[k].row], splitter);
      }
    }
  }

  void move(const Waypoint& w, bool free, Subdivider& splitter) {
    const std::size_t row = w.row;
    if (program_.at_machine()[row]) return stay_out(row, splitter);
    if (away_) return come_back(w, splitter);
    if (w.rewound) return rewind(row, w.joints, splitter);
    // The start position of a new tool is unknown, and with it length and duration of the move.
    if (set_up(row)) stands_.reset();
    const Pose& end = program_.poses()[row];
    if (!stands_) {
      block(row, w.joints, end, true);
      before_ = end;
      return;
    }
    const Pose to = w.share < 1 ? Motion(program_.poses()[row - 1], end).at(w.share) : end;
    const Joints start = *stands_;
    const auto& parts = split(row, splitter, to, w.joints, free);
    slowest_ = 1;
    for (std::size_t k = 0; k < parts.size(); ++k) block(row, parts[k], to, k + 1 == parts.size());
    if (!free) note_passage(row, geom::angle_between(before_.axis, to.axis) * kRadian, rotary_way(start, w.joints));
    before_ = to;
  }

  /// A machine position, known only to the machine: stay at safe height instead.
  void stay_out(std::size_t row, Subdivider& splitter) {
    if (!away_ && stands_) leave(row, *stands_, splitter);
    if (set_up(row)) stands_.reset();
    away_ = true;
  }

  void come_back(const Waypoint& w, Subdivider& splitter) {
    if (set_up(w.row)) stands_.reset();
    away_ = false;
    const Pose& end = program_.poses()[w.row];
    if (stands_)
      arrive(w.row, end, w.joints, false, splitter);
    else
      block(w.row, w.joints, end, true);
    before_ = end;
  }

  const std::vector<Joints>& split(std::size_t row, Subdivider& splitter, const Pose& to, const Joints& joints,
                                   bool free) const {
    try {
      return splitter.split(before_, *stands_, to, joints, free);
    } catch (const std::invalid_argument& e) {
      throw RowError("poses", row, std::string("on the move there ") + e.what());
    }
  }

  /// The last waypoint of the run from `first` with constant feed, tool, spindle and rotary axes: the rows that arcs
  /// may replace.
  std::size_t run_end(const std::vector<Waypoint>& way, std::size_t first) const {
    const std::size_t row = way[first].row;
    std::size_t last = first;
    if (!stands_ || away_ || program_.feed()[row] == 0) return first;
    for (std::size_t k = first; k < way.size(); ++k) {
      const Waypoint& w = way[k];
      if (w.rewound || w.share < 1 || program_.feed()[w.row] != program_.feed()[row] || program_.rapid()[w.row] ||
          program_.tool()[w.row] != *tool_ || program_.spindle()[w.row] != spindle_ || program_.at_machine()[w.row] ||
          rotary_way(w.joints, *stands_) > 0)
        break;
      last = k;
    }
    return last;
  }

  /// Lines and arcs for a run. With the rotary axes at rest, the tip's path is that of the words, rotated and moved, so
  /// the tolerance is the same.
  void curves(std::span<const Waypoint> run) {
    const auto words = [](const Joints& j) { return Vec3(j[0], j[1], j[2]); };
    std::vector<Vec3> points{words(*stands_)};
    for (const Waypoint& w : run) points.push_back(words(w.joints));
    std::size_t done = 0;
    for (const FittedPiece& piece : fit_arcs(points, settings_.tolerance)) {
      const Waypoint& w = run[piece.last - 1];
      const Pose& end = program_.poses()[w.row];
      before_ = end;
      // Arcs are within the tolerance of the rows that they replace.
      for (; done < piece.last; ++done)
        if (settings_.motion && piece.arc)
          record(run[done].row, done > 0 ? run[done - 1].joints : *stands_, run[done].joints, false);
      if (!piece.arc) {
        block(w.row, w.joints, end, true);
        continue;
      }
      check(w.row, w.joints);
      PostBlock b{end, w.joints, false, false, feed_of(w.row), 0, true};
      for (std::size_t k = 0; k < 3; ++k)
        if (machine_.joint_words()) b.feed = std::min(b.feed, machine_.range(k).rate);
      sink_.arc({b, static_cast<std::size_t>(piece.normal), words(*stands_), piece.centre, piece.clockwise});
      stands_ = w.joints, tip_ = end.tip;
    }
  }

  /// Sets tool and spindle before the row's first block. Whether the tool changes.
  bool set_up(std::size_t row) {
    const int tool = program_.tool()[row];
    const double spindle = program_.spindle()[row];
    const bool change = !tool_ || tool != *tool_;
    if (change) {
      const auto shape = program_.tools.find(tool);
      sink_.change_tool(tool, shape == program_.tools.end() ? nullptr : &shape->second, !tool_);
      tool_ = tool, spindle_ = 0;
    }
    if (spindle != spindle_) sink_.spindle(spindle);
    spindle_ = spindle;
    if (change) sink_.ready(tool);
    return change;
  }

  /// Leaves the material, turns the rotary axes to `to` with the tip fixed, and returns.
  void rewind(std::size_t row, const Joints& to, Subdivider& splitter) {
    const Pose pose = before_;
    report_.rewinds.push_back(row);
    leave(row, to, splitter);
    arrive(row, pose, to, true, splitter);
  }

  /// Along the axis and up to safe height, with the rotary axes at rest. `to`: where they will turn there.
  void leave(std::size_t row, const Joints& to, Subdivider& splitter) {
    const ClearanceZone high = space(row, to);
    if (before_.tip.z >= high.top) return;
    for (const Pose& p : retract_path(before_, reach(row), high)) straight(row, p, true, splitter);
  }

  /// Turns the rotary axes to `to` at safe height with the tip fixed, moves over `pose` and down to it. Rapid if the
  /// row is a rapid, and up to the last piece if the tool was there before.
  void arrive(std::size_t row, const Pose& pose, const Joints& to, bool was_there, Subdivider& splitter) {
    constexpr double kGap = 1;  // mm: last piece of the return, at feed
    const bool rapid = program_.rapid()[row] != 0;
    const ClearanceZone high = space(row, to);
    std::vector<Pose> in;
    if (pose.tip.z < high.top) in = retract_path(pose, reach(row), high);
    if (const Joints turned = machine_.with_tip(to, before_.tip); turned != *stands_)
      go(row, {before_.tip, pose.axis}, turned, true, splitter);
    if (!in.empty() && in.back().tip == before_.tip) in.pop_back();
    if (!in.empty()) {
      straight(row, in.back(), true, splitter);
      in.pop_back();
    }
    for (std::size_t k = in.size(); k-- > 0;) straight(row, in[k], was_there || rapid, splitter);
    const double apart = glm::length(before_.tip - pose.tip);
    if (was_there && apart > kGap)
      straight(row, {pose.tip + kGap / apart * (before_.tip - pose.tip), pose.axis}, true, splitter);
    straight(row, pose, rapid, splitter);
  }

  void go(std::size_t row, const Pose& end, const Joints& joints, bool rapid, Subdivider& splitter) {
    for (const Joints& part : split(row, splitter, end, joints, true)) block(row, part, end, true, rapid);
    before_ = end;
  }

  /// Straight move: the rotary axes are at rest, and a table at rest keeps straight lines straight.
  void straight(std::size_t row, const Pose& end, bool rapid, Subdivider& splitter) {
    go(row, end, machine_.with_tip(*stands_, end.tip), rapid, splitter);
  }

  ToolEnvelope reach(std::size_t row) const {
    const auto shape = program_.tools.find(program_.tool()[row]);
    return ToolEnvelope(shape == program_.tools.end() ? nullptr : &shape->second);
  }

  const ClearanceZone& whole_space() {
    if (!space_) space_ = space_of_all();
    return *space_;
  }

  /// High enough for what extends below the tip while the rotary axes turn to `to`.
  ClearanceZone space(std::size_t row, const Joints& to) {
    ClearanceZone out = whole_space();
    out.top += reach(row).below_tip(lowest_axis(*stands_, to));
    return out;
  }

  /// Smallest z of the tool's axis while the rotary axes turn from one place to another.
  double lowest_axis(const Joints& from, const Joints& to) const {
    constexpr double kStep = 2;  // deg
    const int steps = 1 + static_cast<int>(std::min(1e5, rotary_way(from, to) / kStep));
    double lowest = 1;
    for (int k = 0; k <= steps; ++k)
      lowest = std::min(lowest, machine_.pose(mix(from, to, static_cast<double>(k) / steps)).axis.z);
    return lowest;
  }

  ClearanceZone space_of_all() const {
    constexpr double kClearance = 10;
    Box3 box;
    double top = -std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < program_.size(); ++row) {
      box.add(program_.poses()[row].tip);
      if (program_.rapid()[row]) top = std::max(top, program_.poses()[row].tip.z);
    }
    if (settings_.safe_height) return {box.grown(kClearance), *settings_.safe_height};
    // As high as the program itself goes; a program without rapids gets its own height.
    return {box.grown(kClearance), std::max(top, box.upper.z + (top < box.upper.z ? kClearance : 0))};
  }

  /// One block to `joints`; `must`: a row ends here, so it is written even without motion.
  void block(std::size_t row, const Joints& joints, const Pose& pose, bool must) {
    block(row, joints, pose, must, program_.rapid()[row] != 0);
  }

  void block(std::size_t row, const Joints& joints, const Pose& pose, bool must, bool rapid) {
    check(row, joints);
    PostBlock b{pose, joints, rapid, false, rapid ? 0 : feed_of(row), 0, must};
    const Vec3 tip =
        machine_.joint_words() || !stands_ ? machine_.pose(joints).tip : Vec3(joints[0], joints[1], joints[2]);
    if (!rapid && stands_) take_time(row, b, glm::length(tip - tip_));
    if (settings_.motion) record(row, stands_, joints, rapid);
    stands_ = joints, tip_ = tip;
    sink_.block(b);
  }

  /// The machine's motion over a block, in pieces whose rotary motion is so small that the tool's axis follows a great
  /// circle.
  void record(std::size_t row, const std::optional<Joints>& from, const Joints& to, bool rapid) {
    constexpr double kTurn = 1;         // deg: the axis is then within 4e-5 rad of the circle
    constexpr double kAbove = 200;      // mm: smallest height from which a tool comes down for the first time
    constexpr double kMaxParts = 7200;  // twenty turns
    if (!from) {
      Joints above = to;
      above[2] += kAbove;
      report_.motion.push_back({row, machine_.pose(above), machine_.pose(to), rapid, true});
      return;
    }
    const int parts = std::max(1, static_cast<int>(std::ceil(std::min(kMaxParts, rotary_way(*from, to) / kTurn))));
    Pose last = machine_.pose(*from);
    for (int k = 1; k <= parts; ++k) {
      const Pose next = machine_.pose(k < parts ? mix(*from, to, static_cast<double>(k) / parts) : to);
      if (next.tip != last.tip || next.axis != last.axis) report_.motion.push_back({row, last, next, rapid, false});
      last = next;
    }
  }

  /// The duration at the row's feed, or at the axes' largest rates if that takes longer.
  void take_time(std::size_t row, PostBlock& b, double way) {
    double own = program_.feed()[row] > 0 ? way / program_.feed()[row] : 0, least = 0;
    bool turns = false;
    for (std::size_t k = 0; k < b.joints.size(); ++k) {
      const double apart = std::abs(b.joints[k] - (*stands_)[k]);
      if (apart == 0) continue;
      if (k >= 3) turns |= ticks(b.joints[k], kAngleDecimals) != ticks((*stands_)[k], kAngleDecimals);
      if (k >= 3 || machine_.joint_words()) least = std::max(least, apart / machine_.range(k).rate);
    }
    b.inverse = turns && machine_.control().inverse_time;
    b.minutes = std::max({own, least, 1 / kMaxFeed});
    const bool slowed = least > own * (1 + 1e-9);
    if (slowed && way > 1e-6) ++report_.slowed, slowest_ = std::max(slowest_, least / own);
    if (b.inverse || !(slowed || (machine_.joint_words() && turns))) return;
    // The distance to which F refers under G94, by LinuxCNC's rule, as printed: X Y Z if one of them moves, otherwise
    // the rotary axes.
    const double linear = printed_way(b.joints, 0, kLengthDecimals), rotary = printed_way(b.joints, 3, kAngleDecimals);
    if (linear > 0)
      b.feed = linear / b.minutes;
    else if (rotary > 0)
      b.feed = machine_.joint_words() ? rotary / b.minutes : std::min(b.feed, rotary / b.minutes);
  }

  /// Printed distance from the current position, over three of the axes.
  double printed_way(const Joints& to, std::size_t first, int decimals) const {
    double sum = 0;
    for (std::size_t k = first; k < first + 3; ++k) {
      const auto apart = static_cast<double>(ticks(to[k], decimals) - ticks((*stands_)[k], decimals));
      sum += apart * apart;
    }
    return std::sqrt(sum) * base::pow(10.0, -decimals);
  }

  /// Notes where the rotary axes turn much further than the tool.
  void note_passage(std::size_t row, double tool, double rotary) {
    constexpr double kTimes = 5, kMin = 10;  // deg
    if (!(rotary > kTimes * tool && rotary > kMin)) return;
    if (!report_.passages.empty() && report_.passages.back().last + 1 >= row) {
      PolePassage& last = report_.passages.back();
      last.last = row, last.tool += tool, last.rotary += rotary, last.slowed = std::max(last.slowed, slowest_);
    } else {
      report_.passages.push_back({row, row, tool, rotary, slowest_});
    }
  }

  /// Checks that the numbers are within the range of the code.
  void check_range(std::size_t row, const Joints& joints) const {
    for (const char letter : machine_.axes()) {
      const std::size_t k = joint_index(letter);
      if (!(std::abs(joints[k]) <= (k >= 3 ? kMaxAngle : kMaxLength)))
        throw RowError("poses", row, std::string(1, letter) + " is out of range");
    }
  }

  void check(std::size_t row, const Joints& joints) const {
    check_range(row, joints);
    // Limits are printable numbers: a value beyond one by less than half a step is printed as the limit.
    const std::size_t k = machine_.beyond(joints, 4e-7);
    if (k == joints.size()) return;
    const AxisRange& range = machine_.range(k);
    throw RowError("poses", row,
                   "on the move there machine " + machine_.name() + " would leave the limits of " + kJointLetters[k] +
                       ", " + number_text(range.low) + " to " + number_text(range.high) + ": " +
                       number_text(joints[k]) + "; place the part differently or put rows closer together");
  }

  /// A row whose tip stands still has no feed of its own: it uses the previous or the next one.
  double feed_of(std::size_t row) {
    const std::vector<double>& feed = program_.feed();
    if (program_.rapid()[row]) return 0;
    if (feed[row] > 0) return last_feed_ = feed[row];
    if (last_feed_ > 0) return last_feed_;
    const auto own =
        std::find_if(feed.begin() + static_cast<std::ptrdiff_t>(row), feed.end(), [](double f) { return f > 0; });
    if (own == feed.end()) throw RowError("feed", row, "no feed is known");
    return last_feed_ = *own;
  }

  const Program& program_;
  const BlockSettings& settings_;
  const Machine& machine_;
  BlockSink& sink_;
  WriteReport report_;

  std::optional<Joints> stands_;  // joints after the last block
  Vec3 tip_{0};                   // position after the last block
  Pose before_;                   // pose of the program after the last block
  bool away_ = false;             // the last row is at a machine position
  std::optional<ClearanceZone> space_;
  std::optional<int> tool_;
  double spindle_ = 0, last_feed_ = 0, slowest_ = 1;
};

}  // namespace

WriteReport make_blocks(const Program& program, const BlockSettings& settings, BlockSink& sink) {
  return BlockMaker(program, settings, sink).run();
}

}  // namespace riffler::nc
