#include "riffler/session/journal.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace riffler::session {

void Journal::set_stock(const JournalStock& stock) {
  rules_.set_stock(stock);
}

void Journal::add_tool(int number, const std::string& json) {
  rules_.add_tool(number, json);
}

void Journal::add_note(std::string key, std::string value) {
  notes_.emplace_back(std::move(key), std::move(value));
}

void Journal::add_stroke(JournalStroke stroke) {
  const std::size_t before = rules_.counting();
  rules_.add_stroke(stroke);
  strokes_.resize(before);
  strokes_.push_back(std::move(stroke));
}

void Journal::extend_stroke(const JournalRows& rows) {
  rules_.extend_stroke(rows);
  strokes_.back().append(rows);
}

void Journal::undo(std::size_t n) {
  rules_.undo(n);
}

void Journal::redo(std::size_t n) {
  rules_.redo(n);
}

namespace {

/// Feed in mm/min to each row; the first row takes the first available feed. Hands rest and jerk, and clocks are
/// coarse: feeds beyond any machine are clamped.
std::vector<double> feeds(const JournalStroke& stroke, std::size_t index) {
  constexpr double kSlowest = 1, kFastest = 1e5;
  const std::string name = "stroke " + std::to_string(index);
  if (stroke.times.empty()) throw std::invalid_argument(name + " has no times: give a feed");
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
  if (first == feed.end()) throw std::invalid_argument(name + " never moves: give a feed");
  std::fill(feed.begin(), first, *first);
  return feed;
}

}  // namespace

nc::Program to_program(const Journal& journal, std::map<int, Tool> tools, const JournalProgramOptions& options) {
  for (const auto& [number, tool] : tools) tool.require_revolved("tool " + std::to_string(number) + ": a program");
  std::vector<nc::CutterPath> paths;
  const std::span<const JournalStroke> strokes = journal.strokes();
  for (std::size_t k = 0; k < strokes.size(); ++k) {
    const JournalStroke& stroke = strokes[k];
    if (stroke.mode != StrokeMode::Remove && stroke.mode != StrokeMode::Beside) continue;
    paths.push_back(
        {stroke.poses, options.feed ? std::vector{*options.feed} : feeds(stroke, k), options.spindle, stroke.tool});
  }
  nc::Clearance clearance = options.clearance;
  if (journal.stock()) clearance.occupied.add(journal.stock()->box);
  nc::Program program = program_from_paths(paths, std::move(tools), clearance);
  program.provenance = journal.notes();
  return program;
}

}  // namespace riffler::session
