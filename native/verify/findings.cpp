#include "verify/findings.hpp"

#include <algorithm>
#include <cstdio>
#include <tuple>

namespace riffler::verify {

namespace {

/// Whether the values of rows add up; otherwise the worst row counts.
bool adds_up(Kind kind) {
  return kind == Kind::Rapid || kind == Kind::Spindle;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 0.001 ? "%.1e" : value < 10 ? "%.3f" : "%.1f", value);
  return text;
}

const char* name_of(Member member) {
  static constexpr const char* names[] = {"cutter", "shank", "holder", "spindle"};
  return names[static_cast<int>(member)];
}

void take_worse(Finding& finding, const Event& e) {
  if (!(e.worst > finding.worst)) return;
  finding.worst = e.worst, finding.point = e.point, finding.member = e.member;
}

}  // namespace

void FindingList::add(std::vector<Event> events, std::span<const std::int32_t> tool, std::span<const std::int32_t> line,
                      std::int64_t first_row) {
  const auto key = [](const Event& e) { return std::tuple(e.row, e.kind, e.fixture); };
  std::stable_sort(events.begin(), events.end(), [&](const Event& a, const Event& b) { return key(a) < key(b); });
  for (std::size_t begin = 0; begin < events.size();) {
    Event row = events[begin];
    std::size_t k = begin + 1;
    for (; k < events.size() && key(events[k]) == key(row); ++k) {
      const Event& e = events[k];
      row.value = row.kind == Kind::Gouge ? std::max(row.value, e.value) : row.value + e.value;
      if (e.worst > row.worst) row.worst = e.worst, row.point = e.point, row.member = e.member;
    }
    const auto at = static_cast<std::size_t>(row.row - first_row);
    add_row(row, tool[at], line[at]);
    begin = k;
  }
}

void FindingList::add_row(const Event& e, std::int32_t tool, std::int32_t line) {
  const auto [open, added] = open_.try_emplace({e.kind, e.fixture}, findings_.size());
  // What the stock lacks from the start is reported at row 0, which is not a neighbour of a move.
  if (!added) {
    Finding& last = findings_[open->second];
    if (last.last_row + 1 == e.row && last.last_row > 0 && last.tool == tool) {
      last.last_row = e.row, last.last_line = line;
      last.value = adds_up(e.kind) ? last.value + e.value : std::max(last.value, e.value);
      take_worse(last, e);
      return;
    }
  }
  open->second = findings_.size();
  findings_.push_back(
      {e.kind, e.member, e.fixture, tool, e.row, e.row, line, line, e.value, e.worst, e.point, std::string()});
}

std::vector<Finding> FindingList::take() {
  std::stable_sort(findings_.begin(), findings_.end(), [](const Finding& a, const Finding& b) {
    return std::tuple(a.row, a.kind, a.fixture) < std::tuple(b.row, b.kind, b.fixture);
  });
  for (Finding& f : findings_) f.message = message_of(f);
  open_.clear();
  return std::exchange(findings_, {});
}

std::string message_of(const Finding& f) {
  const std::string tool = " of tool " + std::to_string(f.tool);
  const std::string what = f.fixture < 0 ? "material" : "fixture " + std::to_string(f.fixture + 1);
  const std::string met = f.value > 0 ? number(f.value) + " mm³ of " : "";
  switch (f.kind) {
    case Kind::Rapid:
      return "a rapid takes " + number(f.value) + " mm³ of material: retract higher before it, or make it a feed move";
    case Kind::Spindle:
      return "a feed move takes " + number(f.value) + " mm³ with a stopped spindle: start it (M3 S…) before";
    case Kind::Holder:
      return "the holder" + tool + " meets " + met +
             "material: let the tool stick out further, tilt it, or clear the place before";
    case Kind::Shank:
      return "the shank" + tool + " meets " + met +
             "material: take a longer or a thinner tool, tilt it, or clear the place before";
    case Kind::Fixture:
      return std::string("the ") + name_of(f.member) + tool + " meets " + number(f.value) + " mm³ of " + what +
             ": move the fixture or lead the tool around it";
    case Kind::Gouge:
      if (f.row == 0)
        return "the stock lacks material of the part, " + number(f.value) +
               " mm deep, before the first move: take a larger stock or shift it";
      return "the cutter" + tool + " gouges the part " + number(f.value) +
             " mm deep: lift the path or take a smaller tool";
    case Kind::Rest:
      return "rest material stands " + number(f.value) + " mm on the part: cut it with another pass or a smaller tool";
    case Kind::Machine:
    case Kind::Unknown:
      break;
  }
  return f.message;
}

std::string message_of_unknown(const Finding& f, const Tool& tool) {
  const std::string what = f.fixture < 0 ? "material" : "fixture " + std::to_string(f.fixture + 1);
  const bool holder = !tool.holder().empty(), shank = !tool.shank().empty();
  const double top = holder ? tool.holder().back().z1 : shank ? tool.shank().back().z1 : tool.length();
  return std::string("the ") +
         (holder  ? "holder"
          : shank ? "shank"
                  : "cutter") +
         " of tool " + std::to_string(f.tool) + " ends " + number(top) + " mm above the tip, and " + what +
         " stands above or next to that, so what follows it cannot be checked: " +
         (holder  ? "describe what follows the holder as further pieces of it"
          : shank ? "describe the holder"
                  : "describe the shank and the holder");
}

}  // namespace riffler::verify
