#include "riffler/sweep/cut_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/median_tree.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/sweep/carve.hpp"
#include "sweep/swept_distance.hpp"
#include "tool/cutter_only.hpp"

namespace riffler::sweep {
namespace {

constexpr std::size_t kLeaf = 4;  // moves in a leaf of the tree, at most
constexpr double kAsNear = 0.05;  // of the tolerance: moves that are as near as the nearest one
constexpr double kSlack = 0.02;   // of the tolerance, for each distance
constexpr std::size_t kPointsAtOnce = 256;

/// Bounds the swept cutter. On a great circle a point at height h is at most h (1 − cos(angle / 2)) off its chord.
Box3 swept_box(const SearchedMove& move, const Motion& motion, const Tool& tool) {
  Box3 box;
  for (const Pose& pose : {move.from, move.to}) box.add(pose.tip), box.add(pose.tip + tool.length() * pose.axis);
  const double margin = 0.5 * tool.diameter() + tool.length() * (1 - base::cos(0.5 * motion.angle()));
  box.lower -= Vec3(margin), box.upper += Vec3(margin);
  return box;
}

}  // namespace

struct CutSearch::Core {
  std::vector<tool::Outline> outlines;
  std::vector<SearchedMove> moves;
  std::vector<Motion> motions;
  double tolerance;
  std::vector<std::uint32_t> order;  // of the leaves
  std::size_t levels = 0;
  std::vector<Box3> boxes;  // of the nodes

  void build(const std::vector<Tool>& tools);
  std::int32_t find(const Vec3& p, std::vector<std::pair<std::uint32_t, double>>& near) const;
  void visit(const Vec3& p, double& best, std::vector<std::pair<std::uint32_t, double>>& near) const;
};

void CutSearch::Core::build(const std::vector<Tool>& tools) {
  const std::size_t n = moves.size();
  order.resize(n);
  std::iota(order.begin(), order.end(), 0U);
  while ((n >> levels) > kLeaf) ++levels;
  std::vector<Box3> own(n);
  std::vector<Vec3> centres(n);
  base::parallel_for(n, 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      own[k] = swept_box(moves[k], motions[k], tools[moves[k].tool]);
      centres[k] = 0.5 * (own[k].lower + own[k].upper);
    }
  });
  geom::sort_by_medians(order, levels, centres);
  boxes = geom::boxes_of_tree(levels, [&](std::size_t leaf) {
    Box3 box;
    for (std::size_t i = geom::first_item(n, levels, leaf); i < geom::first_item(n, levels, leaf + 1); ++i)
      box.add(own[order[i]]);
    return box;
  });
}

/// Appends the moves whose swept surface is at most `best` plus the band of equals away, and lowers `best`.
void CutSearch::Core::visit(const Vec3& p, double& best, std::vector<std::pair<std::uint32_t, double>>& near) const {
  const std::size_t inner = (std::size_t{1} << levels) - 1;
  const Box3 around{p - Vec3(tolerance), p + Vec3(tolerance)};
  std::size_t stack[64];
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::size_t node = stack[--depth];
    if (!boxes[node].overlaps(around)) continue;
    if (node < inner) {
      stack[depth++] = 2 * node + 2, stack[depth++] = 2 * node + 1;
      continue;
    }
    const std::size_t leaf = node - inner;
    for (std::size_t i = geom::first_item(order.size(), levels, leaf);
         i < geom::first_item(order.size(), levels, leaf + 1); ++i) {
      const SearchedMove& move = moves[order[i]];
      const double enough = best + kAsNear * tolerance;
      const double d =
          std::abs(swept_distance(outlines[move.tool], Motion(move.from, move.to), p, enough, kSlack * tolerance));
      if (d > enough) continue;
      near.emplace_back(order[i], d);
      best = std::min(best, d);
    }
  }
}

std::int32_t CutSearch::Core::find(const Vec3& p, std::vector<std::pair<std::uint32_t, double>>& near) const {
  near.clear();
  if (moves.empty()) return -1;
  double best = tolerance;
  visit(p, best, near);
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
  for (const auto& [move, distance] : near)
    if (distance <= tolerance && distance <= best + kAsNear * tolerance) first = std::min(first, move);
  return first == std::numeric_limits<std::uint32_t>::max() ? -1 : moves[first].id;
}

CutSearch::CutSearch(std::vector<Tool> tools, std::vector<SearchedMove> moves, double tolerance) {
  base::require_length(tolerance, "tolerance");
  auto core = std::make_unique<Core>();
  for (const Tool& tool : tools) core->outlines.emplace_back(tool::cutter_only(tool));
  for (const SearchedMove& move : moves) {
    if (move.tool >= tools.size())
      throw std::invalid_argument("moves: there is no tool " + std::to_string(move.tool) + " in the list");
    check_path(std::vector<Pose>{move.from, move.to});
    core->motions.emplace_back(move.from, move.to);
  }
  core->moves = std::move(moves);
  core->tolerance = tolerance;
  core->build(tools);
  core_ = std::move(core);
}

CutSearch::~CutSearch() = default;
CutSearch::CutSearch(CutSearch&&) noexcept = default;
CutSearch& CutSearch::operator=(CutSearch&&) noexcept = default;

std::vector<std::int32_t> CutSearch::find(std::span<const Vec3> points, const Progress& progress) const {
  std::vector<std::int32_t> out(points.size());
  base::parallel_for(
      points.size(), kPointsAtOnce,
      [&](std::size_t begin, std::size_t end) {
        std::vector<std::pair<std::uint32_t, double>> near;
        for (std::size_t k = begin; k < end; ++k) out[k] = core_->find(points[k], near);
        base::still_wanted();
      },
      progress);
  return out;
}

}  // namespace riffler::sweep
