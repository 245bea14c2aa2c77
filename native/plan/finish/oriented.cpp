#include "plan/finish/oriented.hpp"

#include <utility>

#include "plan/cut_lines.hpp"
#include "plan/operation_moves.hpp"
#include "plan/row_axes.hpp"

namespace riffler::plan {

namespace {

constexpr double kAxes = 0.3;  // share of the work

struct Centres {
  std::vector<Vec3> centres;
  std::vector<MoveKind> kinds;
};

/// Lines of ball centres: pieces with the links between them.
std::vector<Centres> lines_of(const std::vector<CutPiece>& pieces, const std::vector<std::vector<Vec3>>& links,
                              const Mat3& frame, double radius) {
  std::vector<Centres> out;
  const auto add = [&](const Vec3& tip, MoveKind kind) {
    out.back().centres.push_back(frame * (tip + Vec3(0, 0, radius))), out.back().kinds.push_back(kind);
  };
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const bool linked = k > 0 && !links[k - 1].empty();
    if (!linked) out.emplace_back();
    for (std::size_t i = linked ? 1 : 0; i < pieces[k].tips.size(); ++i) add(pieces[k].tips[i], MoveKind::Cut);
    for (const Vec3& tip : links[k]) add(tip, MoveKind::Link);
  }
  return out;
}

}  // namespace

void cut_oriented(const SetupScene& scene, const Tool& tool, const FinishOptions& options, const Mat3& frame,
                  const std::vector<CutPiece>& pieces, const std::vector<std::vector<Vec3>>& links,
                  const Progress& progress, FinishResult& out) {
  const collide::Assembly assembly(tool);
  const collide::Collider collider(joined(scene.part, scene.fixtures));
  const RowAxes axes(*options.axes, scene.part, frame[2], assembly, collider, options.allowance, options.tolerance);
  const std::vector<Centres> centres = lines_of(pieces, links, frame, ball_for_rows(tool));
  std::vector<CutLine> lines;
  for (std::size_t k = 0; k < centres.size(); ++k) {
    const double n = static_cast<double>(centres.size()), at = static_cast<double>(k);
    const Progress here = base::part(progress, kAxes * at / n, kAxes * (at + 1) / n);
    lines.push_back(axes(centres[k].centres, centres[k].kinds, here));
  }
  const CutAlongOptions how{options.allowance, options.tolerance, std::max(options.cusp, options.tolerance),
                            options.feed, options.plunge};
  CutAlongResult found = cut_lines(scene, tool, lines, how, collider, base::part(progress, kAxes, 1));
  add_blocked(found.blocked, out.blocked);
  static_cast<Operation&>(out) = {std::move(found.poses), std::move(found.kinds), std::move(found.feeds),
                                  std::move(out.blocked), std::move(found.reason)};
  out.retracts = found.retracts, out.straight = 2 * found.pieces;
  for (const std::vector<Vec3>& link : links) out.direct += link.empty() ? 0 : 1;
}

}  // namespace riffler::plan
