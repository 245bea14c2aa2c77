#include "session/journal.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nc/limits.hpp"

namespace riffler {

namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::invalid_argument(what);
}

/// `last`: the time before the first of these, if there is one.
void check_rows(std::span<const Pose> poses, std::span<const double> times, bool timed, const double* last) {
  for (std::size_t row = 0; row < poses.size(); ++row) checked_pose(poses[row], "poses", row);
  if (times.size() != (timed ? poses.size() : 0))
    fail(timed ? "times must be as many as poses" : "times for a stroke that has none");
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (!std::isfinite(times[row])) fail("times, row " + std::to_string(row) + ": not finite");
    if (last && times[row] < *last) fail("times, row " + std::to_string(row) + ": earlier than the one before");
    last = &times[row];
  }
}

}  // namespace

void Journal::check_stock(const JournalStock& stock) const {
  if (stock_) fail("the journal has a stock already");
  if (!finite(stock.box.lower) || !finite(stock.box.upper)) fail("the stock's box must be finite");
  for (int k = 0; k < 3; ++k)
    if (!(stock.box.lower[k] < stock.box.upper[k])) fail("the stock's lower must be below its upper");
  if (!(std::isfinite(stock.pitch) && stock.pitch > 0)) fail("pitch must be positive and finite");
  if (stock.directions != "z" && stock.directions != "xyz") fail("directions must be \"z\" or \"xyz\"");
}

void Journal::check_tool(int number, const std::string& json) const {
  if (number < 1 || number > kMaxNumber) fail("tool number must be from 1 to " + std::to_string(kMaxNumber));
  const auto it = tools_.find(number);
  if (it != tools_.end() && it->second != json)
    fail("tool " + std::to_string(number) + " is another tool already: take another number");
}

void Journal::check_stroke(const JournalStroke& stroke) const {
  if (!tools_.contains(stroke.tool))
    fail("tool " + std::to_string(stroke.tool) + " is not in the journal: add it first");
  if (!(std::isfinite(stroke.tolerance) && stroke.tolerance > 0)) fail("tolerance must be positive and finite");
  if (stroke.poses.empty()) fail("a stroke needs at least one pose");
  check_rows(stroke.poses, stroke.times, !stroke.times.empty(), nullptr);
}

void Journal::check_extension(std::span<const Pose> poses, std::span<const double> times) const {
  if (strokes_.empty()) fail("there is no stroke to extend");
  const JournalStroke& stroke = strokes_.back();
  const bool timed = !stroke.times.empty();
  check_rows(poses, times, timed, timed ? &stroke.times.back() : nullptr);
}

void Journal::set_stock(JournalStock stock) {
  check_stock(stock);
  stock_ = std::move(stock);
}

void Journal::add_tool(int number, std::string json) {
  check_tool(number, json);
  tools_.emplace(number, std::move(json));
}

void Journal::add_note(std::string key, std::string value) {
  notes_.emplace_back(std::move(key), std::move(value));
}

void Journal::add_stroke(JournalStroke stroke) {
  check_stroke(stroke);
  strokes_.push_back(std::move(stroke));
}

void Journal::extend_stroke(std::span<const Pose> poses, std::span<const double> times) {
  check_extension(poses, times);
  JournalStroke& stroke = strokes_.back();
  stroke.poses.insert(stroke.poses.end(), poses.begin(), poses.end());
  stroke.times.insert(stroke.times.end(), times.begin(), times.end());
}

namespace {

/// mm/min with which the tip comes to each row; the first row takes the first feed there is. Hands rest and jerk, and
/// clocks tick: what is beyond any machine is held within bounds.
std::vector<double> feeds(const JournalStroke& stroke, std::size_t index) {
  constexpr double kSlowest = 1, kFastest = 1e5;
  const std::string name = "stroke " + std::to_string(index);
  if (stroke.times.empty()) fail(name + " has no times: give a feed");
  std::vector<double> feed(stroke.poses.size(), 0);
  for (std::size_t row = 1; row < feed.size(); ++row) {
    const double way = glm::length(stroke.poses[row].tip - stroke.poses[row - 1].tip);
    const double minutes = (stroke.times[row] - stroke.times[row - 1]) / 60;
    if (way > 0)
      feed[row] = minutes > 0 ? std::clamp(way / minutes, kSlowest, kFastest) : kFastest;
    else
      feed[row] = feed[row - 1];
  }
  const auto first = std::find_if(feed.begin(), feed.end(), [](double f) { return f > 0; });
  if (first == feed.end()) fail(name + " never moves: give a feed");
  std::fill(feed.begin(), first, *first);
  return feed;
}

}  // namespace

Program to_program(const Journal& journal, std::map<int, Tool> tools, const JournalProgramOptions& options) {
  std::vector<CutterPath> paths;
  for (std::size_t k = 0; k < journal.strokes().size(); ++k) {
    const JournalStroke& stroke = journal.strokes()[k];
    paths.push_back(
        {stroke.poses, options.feed ? std::vector{*options.feed} : feeds(stroke, k), options.spindle, stroke.tool});
  }
  Clearance clearance = options.clearance;
  if (journal.stock()) clearance.occupied.add(journal.stock()->box);
  Program program = program_from_paths(paths, std::move(tools), clearance);
  program.provenance = journal.notes();
  return program;
}

}  // namespace riffler
