#include "riffler/nc/program.hpp"

#include <cmath>
#include <stdexcept>

#include "nc/limits.hpp"

namespace riffler::nc {

namespace {

[[noreturn]] void fail(std::string_view name, std::size_t row, const char* what) {
  throw RowError(name, row, what);
}

}  // namespace

Pose checked_pose(const Pose& pose, std::string_view name, std::size_t row) {
  if (!geom::finite(pose.tip) || !geom::finite(pose.axis)) fail(name, row, "not finite");
  const double length = glm::length(pose.axis);
  if (!(std::abs(length - 1) < 1e-6)) fail(name, row, "the axis is not a unit vector");
  // A vector as close to unit length as doubles allow stays bit-identical.
  return std::abs(length - 1) < 1e-15 ? pose : Pose{pose.tip, pose.axis / length};
}

void Program::append(const Move& move) {
  const std::size_t row = size();
  const Pose pose = checked_pose(move.pose, "poses", row);
  if (!(std::abs(move.spindle) <= kMaxSpindle)) fail("spindle", row, "not finite or out of range");
  if (move.tool < 0 || move.tool > kMaxNumber) fail("tool", row, "negative or out of range");
  if (!move.rapid) {
    if (!(move.feed >= 0 && move.feed <= kMaxFeed)) fail("feed", row, "must be positive and finite");
    if (move.feed == 0 && row > 0 && pose.tip != poses_.back().tip) fail("feed", row, "0, but the tip moves");
  }
  if (move.at_machine && leading_ == row)
    ++leading_;
  else if (move.at_machine && !(pose.tip == poses_.back().tip && pose.axis == poses_.back().axis))
    fail("poses", row, "a row at a machine position repeats the pose of the row before");
  if (move.via && !move.via->empty() && row > 0) {
    for (const Pose& on_the_way : *move.via) checked_pose(on_the_way, "via", row);
    via_.emplace_hint(via_.end(), row, move.via);
  }
  poses_.push_back(pose);
  feed_.push_back(move.rapid ? 0 : move.feed);
  spindle_.push_back(move.spindle);
  tool_.push_back(move.tool);
  line_.push_back(move.line);
  rapid_.push_back(move.rapid);
  at_machine_.push_back(move.at_machine);
}

void Program::reserve(std::size_t rows) {
  poses_.reserve(rows), feed_.reserve(rows), spindle_.reserve(rows);
  tool_.reserve(rows), line_.reserve(rows), rapid_.reserve(rows), at_machine_.reserve(rows);
}

Move Program::operator[](std::size_t row) const {
  return {poses_[row],
          feed_[row],
          spindle_[row],
          tool_[row],
          line_[row],
          rapid_[row] != 0,
          at_machine_[row] != 0,
          via_.empty() || !via_.contains(row) ? nullptr : via_.at(row)};
}

std::vector<ToolRun> Program::runs() const {
  std::vector<ToolRun> out;
  for (std::size_t row = 0; row < size(); ++row) {
    if (at_machine_[row]) continue;
    if (out.empty() || out.back().tool != tool_[row] || out.back().end != row) out.push_back({tool_[row], row, row});
    out.back().end = row + 1;
  }
  return out;
}

}  // namespace riffler::nc
