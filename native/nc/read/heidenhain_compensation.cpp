// Cutter radius compensation of Heidenhain programs: R0, RL, RR.
#include <cmath>
#include <string>

#include "nc/read/heidenhain_interpreter.hpp"

namespace riffler::nc {

namespace {

Vec3 tip_of(const Joints& joints) {
  return {joints[0], joints[1], joints[2]};
}

Joints contour_joints(const Vec3& at, const Joints& rotary) {
  Joints out = rotary;
  out[0] = at.x, out[1] = at.y, out[2] = at.z;
  return out;
}

}  // namespace

void HeidenhainInterpreter::make_compensation() {
  compensation_ = std::make_unique<CutterCompensation>(place_, [this](const CentreMove& move) {
    if (move.arc)
      round_rows(tip_of(move.from), tip_of(move.to), *move.arc, {0, 1}, {rotary_, rotary_}, move.words);
    else
      rows_->line(in_part(tip_of(move.from), rotary_), in_part(tip_of(move.to), rotary_), move.words);
  });
}

void HeidenhainInterpreter::compensate(char compensation) {
  if (compensation == 0) return;
  if (corner_ && compensation != side_) place_.fail("RND or CHF where the radius compensation changes");
  if (compensation == '0') {
    compensation_->off();
    side_ = '0';
    return;
  }
  const std::string name = compensation == 'L' ? "RL" : compensation == 'R' ? "RR" : "R+, R-";
  if (rule_ == CompensationRule::Ignore) {
    if (!compensation_noted_) note("cutter compensation", compensation_ignored(name));
    compensation_noted_ = true;
    return;
  }
  if (compensation == 'P')
    place_.fail(
        "compensation along an axis (R+, R-) is not read: have the CAM system write RL or RR, or, where the points are "
        "those of the tool's centre, read it with options {'cutter_compensation': 'ignore'}");
  if (rule_ == CompensationRule::Error) place_.fail(compensation_refused(name));
  if (compensation_->is_on() && side_ != compensation)
    place_.fail(name + " changes the compensation that holds: a line with R0 before it");
  side_ = compensation;
}

/// Radius in mm, from option tool_diameters or the program, with DR of TOOL CALL.
double HeidenhainInterpreter::compensation_radius() {
  std::optional<double> radius;
  if (const auto diameter = diameters_.of(tool_))
    radius = *diameter / 2;
  else if (const auto own = tool_radii_.find(tool_); own != tool_radii_.end())
    radius = own->second;
  const std::string name = std::string("R") + side_, whose = "tool " + std::to_string(tool_);
  if (!radius) place_.fail(diameter_unknown(name, whose, tool_));
  const double is = *radius + tool_more_;
  if (offsets_noted_.insert(tool_).second) note("cutter compensation", path_is_offset(name, whose, is));
  return is;
}

/// Whether the next move is offset. The first one with RL or RR begins the compensation.
bool HeidenhainInterpreter::compensates() {
  if (compensation_->is_on()) return true;
  if (side_ == '0') return false;
  const double radius = compensation_radius();
  if (radius == 0) return false;
  if (is_away())
    place_.fail("radius compensation begins while " + axes_away() +
                " is at a machine position: move all of X Y Z into the part first");
  const bool left = (side_ == 'L') == (radius > 0);
  compensation_->on(
      {left ? CutterSide::Left : CutterSide::Right, std::abs(radius), 0, 1, "R0", CutterEntry::NextElement},
      contour_joints(at_, rotary_));
  return true;
}

/// A line, or an arc in the working plane, of the contour.
void HeidenhainInterpreter::contour_to(const Vec3& to, const Arc* arc, const Joints& rotary, const NcRowWords& words) {
  check_length(to);
  if (rotary != rotary_) place_.fail("rotary axes turn in radius compensation: a line with R0 before it");
  if (!moves_in_part(words)) refuse_in_compensation("a machine position");
  if (arc)
    compensation_->arc(contour_joints(to, rotary), *arc, words);
  else
    compensation_->line(contour_joints(to, rotary), words);
  if (!arc && to != at_) leaving_ = glm::normalize(to - at_);
  at_ = to;
}

void HeidenhainInterpreter::refuse_in_compensation(const char* what) {
  if (side_ != '0' && compensation_radius() != 0)
    place_.fail(std::string(what) + " in radius compensation: a line with R0 before it");
}

/// After R0 the tool stays at the offset point until a move in the working plane. A move along the tool's axis alone
/// keeps that offset.
Vec3 HeidenhainInterpreter::leave_contour(const Vec3& to) {
  if (!compensation_->is_leaving()) return to;
  if (to.x == at_.x && to.y == at_.y) return {compensation_->centre()[0], compensation_->centre()[1], to.z};
  compensation_->end_leaving();
  return to;
}

/// From now on the tool's real position counts, not the programmed one.
void HeidenhainInterpreter::stay_beside_contour() {
  if (!compensation_->is_leaving()) return;
  at_.x = compensation_->centre()[0], at_.y = compensation_->centre()[1];
  compensation_->end_leaving();
}

}  // namespace riffler::nc
