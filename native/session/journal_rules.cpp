#include "riffler/session/journal_rules.hpp"

#include <cmath>
#include <stdexcept>

#include "nc/limits.hpp"
#include "riffler/base/check.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::session {

namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::invalid_argument(what);
}

std::string at(const char* name, std::size_t row) {
  return std::string(name) + ", row " + std::to_string(row) + ": ";
}

/// Checks that a column has the required number of rows.
void check_length(const char* name, std::size_t size, bool wanted, std::size_t rows) {
  if (size == (wanted ? rows : 0)) return;
  fail(wanted ? std::string(name) + " must be as many as poses" : std::string(name) + " for a stroke that has none");
}

/// `last`: the time before the first of these rows, or null.
void check_values(const JournalRows& rows, const double* last) {
  for (std::size_t row = 0; row < rows.poses.size(); ++row) nc::checked_pose(rows.poses[row], "poses", row);
  for (std::size_t row = 0; row < rows.times.size(); ++row) {
    const double& time = rows.times[row];
    if (!std::isfinite(time)) fail(at("times", row) + "not finite");
    if (last && time < *last) fail(at("times", row) + "earlier than the one before");
    last = &time;
  }
  for (std::size_t row = 0; row < rows.forces.size(); ++row)
    if (!finite(rows.forces[row])) fail(at("forces", row) + "not finite");
  for (std::size_t row = 0; row < rows.removed.size(); ++row)
    if (!(std::isfinite(rows.removed[row]) && rows.removed[row] >= 0))
      fail(at("removed", row) + "must be finite and not negative");
  for (std::size_t row = 0; row < rows.forward.size(); ++row) {
    constexpr double kSquare = 1e-6;
    const Vec3 &forward = rows.forward[row], &axis = rows.poses[row].axis;
    if (!(std::abs(glm::length(forward) - 1) < kSquare))
      fail(at("poses", row) + "the forward direction must be a unit vector");
    if (!(std::abs(glm::dot(forward, axis)) < kSquare))
      fail(at("poses", row) + "the forward direction must be square to the axis: subtract its share along the axis");
  }
}

template <class T>
void append_to(std::vector<T>& column, std::span<const T> more) {
  column.insert(column.end(), more.begin(), more.end());
}

}  // namespace

void JournalStroke::append(const JournalRows& rows) {
  append_to(poses, rows.poses);
  append_to(times, rows.times);
  append_to(forces, rows.forces);
  append_to(removed, rows.removed);
  append_to(forward, rows.forward);
}

void JournalRules::set_stock(const JournalStock& stock) {
  if (stock_) fail("the journal has a stock already");
  if (!geom::finite(stock.box.lower) || !geom::finite(stock.box.upper)) fail("the stock's box must be finite");
  for (int k = 0; k < 3; ++k)
    if (!(stock.box.lower[k] < stock.box.upper[k])) fail("the stock's lower must be below its upper");
  if (!(std::isfinite(stock.pitch) && stock.pitch > 0)) fail("pitch must be positive and finite");
  if (stock.directions != "z" && stock.directions != "xyz") fail("directions must be \"z\" or \"xyz\"");
  stock_ = stock;
}

void JournalRules::add_tool(int number, const std::string& json) {
  if (number < 1 || number > nc::kMaxNumber) fail("tool number must be from 1 to " + std::to_string(nc::kMaxNumber));
  const auto it = tools_.find(number);
  if (it != tools_.end() && it->second != json)
    fail("tool " + std::to_string(number) + " is another tool already: take another number");
  tools_.emplace(number, json);
}

void JournalRules::add_stroke(const JournalStroke& stroke) {
  if (!tools_.contains(stroke.tool))
    fail("tool " + std::to_string(stroke.tool) + " is not in the journal: add it first");
  base::require_tolerance(stroke.tolerance);
  if (!(stroke.strength >= 0 && stroke.strength <= 1)) fail("strength must be from 0 to 1");
  if (!std::isfinite(stroke.amount)) fail("amount must be finite");
  if (stroke.poses.empty()) fail("a stroke needs at least one pose");
  const std::size_t rows = stroke.poses.size();
  check_length("times", stroke.times.size(), !stroke.times.empty(), rows);
  check_length("forces", stroke.forces.size(), !stroke.forces.empty(), rows);
  check_length("removed", stroke.removed.size(), !stroke.removed.empty(), rows);
  check_length("forward", stroke.forward.size(), !stroke.forward.empty(), rows);
  check_values(stroke.rows(), nullptr);
  const bool timed = !stroke.times.empty();
  last_ = {timed ? stroke.times.back() : 0, timed, !stroke.forces.empty(), !stroke.removed.empty(),
           !stroke.forward.empty()};
  ++counting_;
  taken_ = 0;
}

void JournalRules::extend_stroke(const JournalRows& rows) {
  if (!last_)
    fail(counting_ + taken_ == 0 ? "there is no stroke to extend" : "the last stroke has ended: begin another");
  const std::size_t n = rows.poses.size();
  check_length("times", rows.times.size(), last_->timed, n);
  check_length("forces", rows.forces.size(), last_->forces, n);
  check_length("removed", rows.removed.size(), last_->removed, n);
  check_length("forward", rows.forward.size(), last_->forward, n);
  check_values(rows, last_->timed ? &last_->time : nullptr);
  if (!rows.times.empty()) last_->time = rows.times.back();
}

void JournalRules::undo(std::size_t n) {
  if (counting_ == 0) fail("there is no stroke to undo");
  if (n < 1 || n > counting_) fail("strokes to undo must be from 1 to " + std::to_string(counting_));
  counting_ -= n, taken_ += n;
  last_.reset();
}

void JournalRules::redo(std::size_t n) {
  if (taken_ == 0) fail("there is no stroke to redo");
  if (n < 1 || n > taken_) fail("strokes to redo must be from 1 to " + std::to_string(taken_));
  counting_ += n, taken_ -= n;
  last_.reset();
}

}  // namespace riffler::session
