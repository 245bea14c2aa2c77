#include "plan/drop_core.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "geom/median_tree.hpp"
#include "plan/grown_piece.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/plan/cc_frame.hpp"

namespace riffler::plan {

namespace {

constexpr double kNowhere = -std::numeric_limits<double>::infinity();

}  // namespace

DropCutter::Core::Core(const Mesh& mesh, const Tool& tool, const Vec3& axis, double margin) {
  validate(mesh);
  base::require_not_negative(margin, "margin", base::kFiniteAndNotNegative);
  if (mesh.empty()) throw std::invalid_argument("a part without triangles");
  // Along z, use the identity so that coordinates stay bit-identical.
  const CcFrame frame = axis == Vec3(0, 0, 1) ? CcFrame{} : cc_frame({1, 0, 0}, unit_axis(axis, "axis"));
  turn_ = Mat3(frame.x, frame.y, frame.z);
  for (const tool::ToolPiece& p : tool.assembly())
    for (const tool::Piece& piece : grown_lower_side(p.piece, margin)) sides_.emplace_back(p.part, LowerSide(piece));
  std::vector<Triangle> all;
  all.reserve(mesh.triangles.size());
  for (const Vec3i& t : mesh.triangles)
    all.push_back({mesh.vertices[t.x] * turn_, mesh.vertices[t.y] * turn_, mesh.vertices[t.z] * turn_});
  build(all);
}

void DropCutter::Core::build(const std::vector<Triangle>& all) {
  const std::size_t n = count_ = all.size();
  while ((n >> levels_) > 4) ++levels_;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto box_of = [&](auto begin, auto end) {
    Box3 box;
    for (auto i = begin; i != end; ++i) box.add(all[*i].a), box.add(all[*i].b), box.add(all[*i].c);
    return box;
  };
  // Only the projection matters for a tool that comes down: split along x or y.
  const auto axis = [&](auto begin, auto end) {
    const Vec3 size = box_of(begin, end).size();
    return size.x >= size.y ? 0 : 1;
  };
  geom::sort_by_medians(order, levels_, axis,
                        [&](std::size_t t, int side) { return all[t].a[side] + all[t].b[side] + all[t].c[side]; });
  boxes_ = geom::boxes_of_tree(levels_, [&](std::size_t leaf) {
    const auto at = [&](std::size_t k) { return order.begin() + static_cast<std::ptrdiff_t>(first(levels_, k)); };
    return box_of(at(leaf), at(leaf + 1));
  });
  triangles_.reserve(n);
  numbers_.reserve(n);
  for (const std::size_t t : order) triangles_.push_back(all[t]), numbers_.push_back(static_cast<int>(t));
}

/// One descent, best boxes first.
struct DropCutter::Core::Search {
  const Core& tree;
  Vec2 at;
  Stats counts{};
  LowerSide::Stop stop{kNowhere, Vec3(0), false};
  std::size_t side = 0, position = 0;

  /// Upper bound of the height at which a triangle in the box stops the tool.
  double bound(std::size_t node) {
    ++counts.boxes;
    const Box3& box = tree.boxes_[node];
    const double x = std::max({box.lower.x - at.x, at.x - box.upper.x, 0.0});
    const double y = std::max({box.lower.y - at.y, at.y - box.upper.y, 0.0});
    const double rho = std::sqrt(x * x + y * y);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [part, lower] : tree.sides_)
      if (rho <= lower.rim()) least = std::min(least, lower.height(rho));
    return box.upper.z - least;
  }

  /// Distance of `p` from the interval that contains a, b and c.
  static double apart(double a, double b, double c, double p) {
    const auto [low, high] = std::minmax({a, b, c});
    return std::max({low - p, p - high, 0.0});
  }

  void leaf(std::size_t place) {
    const Vec3 shift(at, 0);
    for (std::size_t t = tree.first(tree.levels_, place); t < tree.first(tree.levels_, place + 1); ++t) {
      ++counts.triangles;
      const Triangle& tri = tree.triangles_[t];
      const double x = apart(tri.a.x, tri.b.x, tri.c.x, at.x), y = apart(tri.a.y, tri.b.y, tri.c.y, at.y);
      const double rho = std::sqrt(x * x + y * y), top = std::max({tri.a.z, tri.b.z, tri.c.z});
      for (std::size_t s = 0; s < tree.sides_.size(); ++s) {
        const LowerSide& lower = tree.sides_[s].second;
        if (rho > lower.rim() * (1 + 1e-12) || top - lower.height(std::min(rho, lower.rim())) < stop.tip) continue;
        const double before = stop.tip;
        tree.sides_[s].second.meet(tri.a - shift, tri.b - shift, tri.c - shift, stop);
        if (stop.touches && stop.tip != before) side = s, position = t;
      }
    }
  }

  void descend(std::size_t node, std::size_t level, std::size_t place) {
    if (level == tree.levels_) return leaf(place);
    const double low = bound(2 * node + 1), high = bound(2 * node + 2);
    for (const bool second : {high > low, !(high > low)})
      if ((second ? high : low) > stop.tip) descend(2 * node + 1 + second, level + 1, 2 * place + second);
  }
};

DropCutter::Landing DropCutter::Core::drop(const Vec3& p, Stats* stats) const {
  const Vec3 local = p * turn_;
  Search search{*this, {local.x, local.y}};
  if (search.bound(0) > kNowhere) search.descend(0, 0, 0);
  if (stats) stats->boxes += search.counts.boxes, stats->triangles += search.counts.triangles;
  if (!search.stop.touches) return {};
  return {true,
          search.stop.tip,
          turn_ * (search.stop.point + Vec3(search.at, 0)),
          sides_[search.side].first,
          numbers_[search.position],
          search.side,
          search.position};
}

DropCutter::DropCutter(const Mesh& mesh, const Tool& tool, const Vec3& axis, double margin)
    : core_(std::make_shared<const Core>(mesh, tool, axis, margin)) {}

const Vec3& DropCutter::axis() const {
  return core_->turn_[2];
}

DropCutter::Landing DropCutter::operator()(const Vec3& p, Stats* stats) const {
  return core_->drop(p, stats);
}

bool DropCutter::stops_above(const Vec3& p, double height) const {
  const Vec3 local = p * core_->turn_;
  Core::Search search{*core_, {local.x, local.y}};
  search.stop = {height, local, true};
  if (search.bound(0) > height) search.descend(0, 0, 0);
  return search.stop.tip > height;
}

std::vector<DropCutter::Landing> DropCutter::operator()(const std::vector<Vec3>& points,
                                                        const Progress& progress) const {
  std::vector<Landing> out(points.size());
  base::parallel_for(
      points.size(), 64,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) out[i] = (*this)(points[i]);
      },
      progress);
  return out;
}

}  // namespace riffler::plan
