// Positioning blocks of Heidenhain programs: lines.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "nc/limits.hpp"
#include "nc/read/heidenhain_interpreter.hpp"
#include "nc/read/tool_axis.hpp"

namespace riffler::nc {

void HeidenhainInterpreter::check_length(const Vec3& at) const {
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(at[k]) <= kMaxLength)) place_.fail(std::string(1, "XYZ"[k]) + " is out of range");
}

// --- Knowledge of the tip's position ---

bool HeidenhainInterpreter::is_away() const {
  return has_stand(stand_, Stand::Machine);
}

std::string HeidenhainInterpreter::axes_away() const {
  return axes_of(stand_, Stand::Machine);
}

void HeidenhainInterpreter::lose_place() {
  stand_.fill(Stand::Machine);
  leaving_.reset();
}

/// The only place that creates a row whose position in the part depends on the machine.
void HeidenhainInterpreter::leave_part(const NcRowWords& words) {
  // Before the first row it has no effect: the start of that row is unknown anyway.
  const bool begun = rows_->begun();
  if (begun && !position_noted_)
    note("machine position",
         "a machine position (M91, M92, M140 MB MAX, or rotary axes that turn without M128): where it is in the part "
         "is not in the program; the moves there, and from there to the next position in the part, are not those of "
         "the machine");
  position_noted_ |= begun;
  check_no_corner();
  refuse_in_compensation("a machine position");
  compensation_->end_leaving();
  leaving_.reset();
  rows_->at_machine(words);
}

/// Called before every motion in program coordinates: whether it ends in the part. Notes the assumptions.
bool HeidenhainInterpreter::moves_in_part(const NcRowWords& words) {
  const bool upright = keeps_tip_ || is_upright();
  if (words.rapid) return upright && !is_away();
  if (!upright) fail_tilted();
  if (is_away() && !std::exchange(away_noted_, true))
    note("coordinates", "a feed move while " + axes_away() + " is at a machine position: neither cut nor checked");
  if (!std::exchange(start_noted_, true)) {
    const std::string axes = axes_of(stand_, Stand::Start, ", ");
    if (!axes.empty())
      note("start",
           axes + " was not programmed before the first feed move: assumed to be 0 at the start of the program");
  }
  return !is_away();
}

// --- Targets ---

Vec3 HeidenhainInterpreter::linear_target(const HeidenhainWords& words) {
  Vec3 to = at_;
  for (std::size_t k = 0; k < 3; ++k) {
    const HeidenhainCoordinate& axis = words.axes[k];
    to[static_cast<int>(k)] = axis.from(at_[static_cast<int>(k)], unit_);
    if (axis.given && !axis.incremental) stand_[k] = Stand::Given;
  }
  check_length(to);
  return to;
}

Joints HeidenhainInterpreter::rotary_target(const HeidenhainWords& words) {
  Joints to = rotary_;
  for (std::size_t k = 3; k < to.size(); ++k) {
    const HeidenhainCoordinate& axis = words.axes[k];
    if (!axis.given) continue;
    if (rows_->machine().axes().find(kJointLetters[k]) == std::string_view::npos)
      place_.fail(std::string("unknown letter ") + kJointLetters[k] +
                  ": the machine has no such axis; read it with the machine that the program is for");
    to[k] = axis.from(rotary_[k], 1);
    if (shortest_ && !axis.incremental) to[k] = nearest_turn(to[k], rotary_[k]);
    if (!(std::abs(to[k]) <= kMaxAngle)) place_.fail(std::string(1, kJointLetters[k]) + " is out of range");
  }
  return to;
}

/// Under FUNCTION TCPM with AXIS SPAT: A B C are spatial angles.
std::optional<Vec3> HeidenhainInterpreter::spatial_axis(const HeidenhainWords& words) {
  if (!spatial_ || !words.has_rotary()) return std::nullopt;
  for (int k = 0; k < 3; ++k)
    spatial_angles_[k] = words.axes[static_cast<std::size_t>(3 + k)].from(spatial_angles_[k], 1);
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(spatial_angles_[k]) <= kMaxAngle)) place_.fail("an angle is out of range");
  return spatial_turn(spatial_angles_)[2];
}

Joints HeidenhainInterpreter::in_part(const Vec3& at, const Joints& rotary) const {
  const Vec3 part = frame_.to_part(at);
  Joints out = rotary;
  out[0] = part.x, out[1] = part.y, out[2] = part.z;
  return out;
}

// --- Lines ---

void HeidenhainInterpreter::line(HeidenhainWords& words) {
  begin_codes(words);
  take_feed(words);
  compensate(words.compensation);
  if (words.has_code(91) || words.has_code(92))
    to_machine(words);
  else if (const auto axis = spatial_axis(words))
    to_axis(linear_target(words), frame_.direction_to_part(*axis), row_words(words.feed == HeidenhainFeed::Rapid));
  else if (words.has_linear() || words.has_rotary())
    move(words, at_);
  end_line(words);
}

/// Actions of a block after its motion.
void HeidenhainInterpreter::end_line(const HeidenhainWords& words) {
  if (words.retraction.given)
    retract(words.retraction, words.feed == HeidenhainFeed::Number ? words.feed_number * feed_unit_ : 0);
  const bool moves = words.has_linear() || words.has_rotary() || words.radius.given || words.angle.given;
  if (words.has_code(99) || words.has_code(89) || (calls_everywhere_ && moves)) call_cycle();
  if (words.has_code(89)) calls_everywhere_ = true;
  if (words.has_code(99)) calls_everywhere_ = false;
  end_codes(words);
}

/// Moves by words; axes without a word go to, or stay at, `other`.
void HeidenhainInterpreter::move(const HeidenhainWords& words, const Vec3& other) {
  const NcRowWords row = row_words(words.feed == HeidenhainFeed::Rapid);
  const Joints rotary = rotary_target(words);
  const bool turns = rotary != rotary_;
  if (turns && !keeps_tip_) {
    if (!row.rapid && words.has_linear())
      place_.fail(
          "a feed move in which rotary axes turn without M128: the tip's path depends on the machine; have the post "
          "write M128 or FUNCTION TCPM");
    if (!row.rapid && !std::exchange(away_noted_, true))
      note("coordinates", "rotary axes turn in feed without M128: neither cut nor checked");
    lose_place();
    rotary_ = rotary;
    leave_part(row);
    if (!words.has_linear()) return;
  }
  Vec3 to = other;
  const Vec3 named = linear_target(words);
  for (std::size_t k = 0; k < 3; ++k)
    if (words.axes[k].given) to[static_cast<int>(k)] = named[static_cast<int>(k)];
  if (corner_) cut_corner(to);
  if (!corner_follows()) return move_to(to, rotary, row);
  if (rotary != rotary_ || !moves_in_part(row))
    place_.fail("RND and CHF are read between two lines in the working plane");
  corner_ = Corner{at_, row, std::nullopt};
  at_ = to;
}

void HeidenhainInterpreter::move_to(const Vec3& to, const Joints& rotary, const NcRowWords& words) {
  if (compensates()) return check_no_corner(), contour_to(to, nullptr, rotary, words);
  check_length(to), check_no_corner();
  const Vec3 from = at_, centre = leave_contour(to);
  if (!moves_in_part(words)) {
    // While the rotary axes do not match, every word moves the tip along all axes of the part.
    if (!keeps_tip_ && !is_upright()) lose_place();
    leave_part(words);
  } else if (along_vectors_ && rotary != rotary_) {
    const Joints joints = in_part(to, rotary);
    rows_->line_to_pose(in_part(at_, rotary_), joints, rows_->machine().pose(joints), words);
  } else {
    rows_->line(in_part(at_, rotary_), in_part(centre, rotary), words);
  }
  at_ = to, rotary_ = rotary;
  if (to != from && !is_away()) leaving_ = glm::normalize(to - from);
}

/// LN: with the tool's axis, if TX TY TZ give it. NX NY NZ are for compensation.
void HeidenhainInterpreter::vector_line(HeidenhainWords& words) {
  const bool has_axis = words.tool[0].given || words.tool[1].given || words.tool[2].given;
  if (!has_axis) return line(words);
  begin_codes(words);
  take_feed(words);
  compensate(words.compensation);
  Vec3 axis(0);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!words.tool[k].given || words.tool[k].incremental) place_.fail("LN needs all of TX TY TZ, or none");
    axis[static_cast<int>(k)] = words.tool[k].value;
  }
  const double length = glm::length(axis);
  if (!(std::abs(length - 1) < 1e-3)) place_.fail("TX TY TZ are not a unit vector");
  if (!keeps_tip_) place_.fail("LN with TX TY TZ without M128: have the post write M128 or FUNCTION TCPM before");
  if (words.has_rotary()) place_.fail("LN with TX TY TZ and rotary axes");
  to_axis(linear_target(words), frame_.direction_to_part(axis / length),
          row_words(words.feed == HeidenhainFeed::Rapid));
  end_line(words);
}

/// Moves the rotary axes by the shortest path to hold `axis`, a unit vector in the part.
void HeidenhainInterpreter::to_axis(const Vec3& to, const Vec3& axis, const NcRowWords& words) {
  check_no_corner();
  refuse_in_compensation("LN");
  stay_beside_contour();
  Joints best;
  try {
    best = joints_holding(rows_->machine(), axis, rotary_, 1e-9);
  } catch (const std::invalid_argument& e) {
    place_.fail(std::string(e.what()) + ": read it with the machine that the program is for");
  }
  const Vec3 from = at_;
  if (moves_in_part(words)) {
    const Joints joints = in_part(to, best);
    rows_->line_to_pose(in_part(at_, rotary_), joints, {frame_.to_part(to), axis}, words);
  } else {
    leave_part(words);
  }
  at_ = to, rotary_ = best;
  if (to != from && !is_away()) leaving_ = glm::normalize(to - from);
}

/// M91, M92: relative to the machine's zero or another machine point.
void HeidenhainInterpreter::to_machine(const HeidenhainWords& words) {
  if (!words.has_linear() && !words.has_rotary()) return;
  const NcRowWords row = row_words(words.feed == HeidenhainFeed::Rapid);
  const Joints rotary = rotary_target(words);
  const bool square = is_upright() && !frame_.tilted && frame_.rotation == 0 && rotary == rotary_;
  if (!square) lose_place();
  for (std::size_t k = 0; k < 3; ++k)
    if (words.axes[k].given) stand_[k] = Stand::Machine;
  rotary_ = rotary;
  leave_part(row);
}

/// M140: along the tool, by a length or to the end of the machine's travel.
void HeidenhainInterpreter::retract(const HeidenhainRetraction& retraction, double feed) {
  if (!retraction.given) return;
  refuse_in_compensation("M140");
  const NcRowWords row{feed == 0, feed, false, turning_ * speed_, tool_, place_.line};
  const Vec3 axis = rows_->machine().pose(rotary_).axis;
  const bool along_z = glm::length(axis - frame_.normal()) < 1e-9;
  if (retraction.to_limit && along_z)
    stand_[2] = Stand::Machine;
  else if (retraction.to_limit)
    lose_place();
  if (is_away()) return leave_part(row);
  Vec3 to = at_;
  const double by = retraction.distance * unit_;
  if (along_z)
    to.z += by;
  else
    to = frame_.from_part(frame_.to_part(at_) + by * axis);
  move_to(to, rotary_, row);
}

void HeidenhainInterpreter::polar_line(HeidenhainWords& words) {
  begin_codes(words);
  take_feed(words);
  compensate(words.compensation);
  const Pole at = pole("LP");
  const Vec3 to = polar_target(words);
  stand_[at.u] = stand_[at.v] = Stand::Given;
  move(words, to);
  end_line(words);
}

}  // namespace riffler::nc
