#include "verify/edit.hpp"

#include <algorithm>

namespace riffler::verify {

namespace {

bool same_pose(const Pose& a, const Pose& b) {
  return a.tip == b.tip && a.axis == b.axis;
}

/// Whether move `i` of program a equals move `k` of program b. Row 0 is a place, not a move.
bool same_move(const RunRows& a, std::size_t i, const RunRows& b, std::size_t k) {
  return a.tool[i] == b.tool[k] && a.rapid[i] == b.rapid[k] && same_pose(a.poses[i - 1], b.poses[k - 1]) &&
         same_pose(a.poses[i], b.poses[k]);
}

}  // namespace

ProgramEdit edit_between(const RunRows& before, const RunRows& now) {
  ProgramEdit edit;
  const std::size_t n = before.poses.size(), m = now.poses.size();
  edit.shift = static_cast<std::int64_t>(m) - static_cast<std::int64_t>(n);
  std::size_t first = 1, end = n, now_end = m;
  while (first < std::min(n, m) && same_move(before, first, now, first)) ++first;
  while (end > first && now_end > first && same_move(before, end - 1, now, now_end - 1)) --end, --now_end;
  edit.tail = static_cast<std::int64_t>(end);
  for (std::size_t row = first; row < end; ++row)
    if (n != m || !same_move(before, row, now, row)) edit.before.push_back(static_cast<std::int64_t>(row));
  for (std::size_t row = first; row < now_end; ++row)
    if (n != m || !same_move(before, row, now, row)) edit.now.push_back(static_cast<std::int64_t>(row));
  return edit;
}

void for_moves_of(const RunRows& program, std::span<const std::int64_t> rows, std::span<const ToolShapes> shapes,
                  double top, const std::function<void(const Moves&)>& f) {
  constexpr std::size_t kStretch = 1 << 16;
  for (std::size_t begin = 0; begin < rows.size(); begin += kStretch) {
    const std::span<const std::int64_t> some = rows.subspan(begin, std::min(kStretch, rows.size() - begin));
    std::vector<Pose> pairs;
    for (const std::int64_t row : some) {
      const auto at = static_cast<std::size_t>(row);
      pairs.push_back(program.poses[at - 1]), pairs.push_back(program.poses[at]);
    }
    Moves moves(pairs, 2, shapes, top);
    for (const std::int64_t row : some) {
      const auto at = static_cast<std::size_t>(row);
      moves.add(row, program.tool[at], program.rapid[at] != 0);
    }
    moves.finish();
    f(moves);
  }
}

}  // namespace riffler::verify
