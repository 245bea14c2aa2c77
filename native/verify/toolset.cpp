#include "verify/toolset.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "riffler/base/check.hpp"

namespace riffler::verify {

namespace {

bool same(const tool::Frustum& a, const tool::Frustum& b) {
  return a.z0 == b.z0 && a.r0 == b.r0 && a.z1 == b.z1 && a.r1 == b.r1;
}

bool same(const tool::Piece& a, const tool::Piece& b) {
  if (a.index() != b.index()) return false;
  if (const auto* f = std::get_if<tool::Frustum>(&a)) return same(*f, std::get<tool::Frustum>(b));
  const tool::Round &r = std::get<tool::Round>(a), &s = std::get<tool::Round>(b);
  return r.e == s.e && r.zc == s.zc && r.r == s.r && r.z0 == s.z0 && r.z1 == s.z1;
}

template <class T>
bool all_same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return same(x, y); });
}

std::string where(const nc::Program& program, std::size_t row, std::int64_t first_row) {
  const std::int32_t line = program.line()[row];
  return "row " + std::to_string(first_row + static_cast<std::int64_t>(row)) +
         (line > 0 ? ", line " + std::to_string(line) : "");
}

}  // namespace

bool same_shape(const Tool& a, const Tool& b) {
  return all_same(a.cutter(), b.cutter()) && all_same(a.shank(), b.shank()) && all_same(a.holder(), b.holder());
}

Toolset::Toolset(std::map<int, Tool> own, double tolerance, double reach, double pitch)
    : own_(std::move(own)), tolerance_(tolerance), reach_(reach), pitch_(pitch) {}

std::vector<std::uint32_t> Toolset::places(const nc::Program& program, std::int64_t first_row) {
  std::vector<std::uint32_t> out(program.size(), kNoTool);
  std::map<int, std::uint32_t> known;
  for (std::size_t row = 1; row < program.size(); ++row) {
    if (!program.moves_in_part(row)) continue;
    const int number = program.tool()[row];
    if (const auto at = known.find(number); at != known.end()) {
      out[row] = at->second;
      continue;
    }
    const auto mine = own_.find(number);
    const auto theirs = program.tools.find(number);
    if (mine != own_.end() || theirs != program.tools.end()) {
      out[row] = known[number] = place(number, mine != own_.end() ? mine->second : theirs->second);
      continue;
    }
    if (number == 0 && program.rapid()[row]) continue;
    if (number == 0)
      throw std::invalid_argument("tools: a feed move before any tool is called (" + where(program, row, first_row) +
                                  "); give the shape of tool 0, or call a tool before it");
    throw std::invalid_argument("tools: the shape of tool " + std::to_string(number) + " is unknown (" +
                                where(program, row, first_row) + "); give tools={" + std::to_string(number) +
                                ": Tool…}");
  }
  return out;
}

std::uint32_t Toolset::place(int number, const Tool& tool) {
  for (std::size_t k = 0; k < tools_.size(); ++k)
    if (numbers_[k] == number && same_shape(tools_[k], tool)) return static_cast<std::uint32_t>(k);
  base::require_tolerance_for(tolerance_, std::max(tool.length(), tool.diameter()));
  numbers_.push_back(number), tools_.push_back(tool);
  shapes_.emplace_back(tool, tolerance_, reach_, pitch_);
  return static_cast<std::uint32_t>(shapes_.size() - 1);
}

const Tool* Toolset::of_number(int number) const {
  for (std::size_t k = numbers_.size(); k-- > 0;)
    if (numbers_[k] == number) return &tools_[k];
  return nullptr;
}

std::vector<std::string> Toolset::not_described(const std::set<std::uint32_t>& places) const {
  std::vector<std::string> out;
  for (const std::uint32_t k : places)
    if (tools_[k].holder().empty())
      out.push_back(std::string(tools_[k].shank().empty() ? "shank and holder" : "holder") + " of tool " +
                    std::to_string(numbers_[k]) + ": not described");
  return out;
}

}  // namespace riffler::verify
