#include "riffler/nc/edit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

#include "nc/limits.hpp"
#include "riffler/base/check.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::nc {

namespace {

/// A program with the same tools and provenance, and rows [first, last) modified by `change`.
template <class Change>
Program copied(const Program& program, std::size_t first, std::size_t last, const Change& change) {
  Program out;
  out.reserve(last - first);
  for (std::size_t row = first; row < last; ++row) {
    Move move = program[row];
    change(move, row);
    out.append(move);
  }
  out.tools = program.tools, out.provenance = program.provenance, out.notes = program.notes;
  return out;
}

template <class Change>
Program copied(const Program& program, const Change& change) {
  return copied(program, 0, program.size(), [&](Move& move, std::size_t) { change(move); });
}

bool same_shape(const Tool& a, const Tool& b) {
  const tool::Outline left(a), right(b);
  return std::equal(left.edges().begin(), left.edges().end(), right.edges().begin(), right.edges().end(),
                    [](const tool::OutlineEdge& x, const tool::OutlineEdge& y) {
                      return x.from == y.from && x.to == y.to && x.centre == y.centre && x.bulge == y.bulge &&
                             x.part == y.part;
                    });
}

void add_tool(std::map<int, Tool>& tools, int number, const Tool& tool) {
  const auto [at, is_new] = tools.emplace(number, tool);
  if (!is_new && !same_shape(at->second, tool))
    throw std::invalid_argument("tool " + std::to_string(number) + " would be " + at->second.name() + " and " +
                                tool.name());
}

}  // namespace

Program trimmed(const Program& program, std::size_t first, std::size_t last) {
  if (first >= last || last > program.size())
    throw std::invalid_argument("rows " + std::to_string(first) + " to " + std::to_string(last) + " of " +
                                std::to_string(program.size()));
  return copied(program, first, last, [&](Move& move, std::size_t row) { move.rapid |= row == first; });
}

Program transformed(const Program& program, const Mat3& turn, const Vec3& shift) {
  const Mat3 square = glm::transpose(turn) * turn;
  double off = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(square[i][j] - (i == j)));
  if (!(off < 1e-9) || !(glm::determinant(turn) > 0) || !geom::finite(shift))
    throw std::invalid_argument("matrix must be a rotation and a translation: no scale, no mirror, finite");
  return copied(program, [&](Move& move) {
    const auto turned = [&](const Pose& p) { return Pose{turn * p.tip + shift, glm::normalize(turn * p.axis)}; };
    move.pose = turned(move.pose);
    if (!move.via) return;
    auto via = std::make_shared<std::vector<Pose>>();
    std::ranges::transform(*move.via, std::back_inserter(*via), turned);
    move.via = std::move(via);
  });
}

Program scale_feeds(const Program& program, double factor) {
  base::require_positive(factor, "factor", base::kPositiveAndFinite);
  return copied(program, [&](Move& move) { move.feed *= factor; });
}

Program joined(std::span<const Program* const> programs) {
  Program out;
  std::size_t rows = 0;
  for (const Program* p : programs) rows += p->size();
  out.reserve(rows);
  for (const Program* p : programs) {
    for (std::size_t row = 0; row < p->size(); ++row) {
      Move move = (*p)[row];
      // Rapids before the first known place stand where the previous program ended.
      if (move.at_machine && !out.empty()) move.pose = out.poses().back();
      out.append(move);
    }
    for (const auto& [number, tool] : p->tools) add_tool(out.tools, number, tool);
    out.notes.insert(out.notes.end(), p->notes.begin(), p->notes.end());
    for (const auto& [key, value] : p->provenance)
      if (std::none_of(out.provenance.begin(), out.provenance.end(), [&](const auto& own) { return own.first == key; }))
        out.provenance.emplace_back(key, value);
  }
  return out;
}

Program renumber_tools(const Program& program, const std::map<int, int>& numbers) {
  const auto renamed = [&](int number) {
    const auto at = numbers.find(number);
    return at == numbers.end() ? number : at->second;
  };
  for (const auto& [from, to] : numbers)
    if (to < 1 || to > kMaxNumber)
      throw std::invalid_argument("tool " + std::to_string(from) + ": " + std::to_string(to) + " is not a tool number");
  std::map<int, Tool> tools;
  for (const auto& [number, tool] : program.tools) add_tool(tools, renamed(number), tool);
  Program out = copied(program, [&](Move& move) { move.tool = renamed(move.tool); });
  out.tools = std::move(tools);
  return out;
}

}  // namespace riffler::nc
