#include "nurbs/closest_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "geom/median_tree.hpp"
#include "nurbs/chord_bound.hpp"
#include "nurbs/foot.hpp"
#include "nurbs/trimmed_net.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::nurbs {

namespace {

constexpr double kFlat = 0.05;    // distance of a leaf from its plane, relative to its size
constexpr int kMaxHalvings = 10;  // of a span, until leaves bend little
constexpr int kMaxCuts = 24;      // more halvings of it, until few edges of borders cross a leaf
constexpr std::size_t kMaxEdges = 8;
constexpr double kNarrow = 1.0 / 64;  // of a rectangle of parameters: width relative to its length
constexpr double kSmall = 1e-6;       // and to the span
constexpr double kProven = 1e-9;      // mm
constexpr double kRounding = 1e-13;   // relative

Box3 box_of(const Vec4* net, const Degrees& degrees) {
  Box3 box;
  for (std::size_t k = 0; k < degrees.size(); ++k) box.add(affine(net[k]));
  return box;
}

double squared_distance(const Vec3& p, const Box3& box) {
  const Vec3 d = glm::max(glm::max(box.lower - p, p - box.upper), Vec3(0));
  return glm::dot(d, d);
}

/// Divides a span until it bends little, and until few borders cross a part of it.
struct LeafMaker {
  std::size_t span;
  Degrees degrees;
  const TrimmedSpan& trims;
  std::vector<BezierLeaf>&leaves, &borders;
  std::vector<Vec4>& nets;

  void divide(const Vec4* net, const Vec2& lower, const Vec2& upper, int halvings, const TrimRegion::Edges& above) {
    const TrimRegion::Edges edges = trims.touching(above, lower, upper);
    if (edges.empty() && !trims.holds(0.5 * (lower + upper))) return;
    const SecondDerivatives bound = second_derivatives(net, degrees);
    const Vec3 size = box_of(net, degrees).size();
    const bool flat = halvings <= kMaxCuts || !(bound.chord(1, 1) > kFlat * glm::length(size));
    if (flat && (edges.size() <= kMaxEdges || halvings <= 0)) return add(net, lower, upper, edges);
    const Vec2 sides = side_lengths(net, degrees);
    const bool along_u = flat ? sides.x >= sides.y : bound.uu >= bound.vv;
    const Vec2 middle = 0.5 * (lower + upper);
    std::vector<Vec4> halves(2 * degrees.size());
    halve(net, degrees, along_u, halves.data(), halves.data() + degrees.size());
    divide(halves.data(), lower, along_u ? Vec2(middle.x, upper.y) : Vec2(upper.x, middle.y), halvings - 1, edges);
    divide(halves.data() + degrees.size(), along_u ? Vec2(middle.x, lower.y) : Vec2(lower.x, middle.y), upper,
           halvings - 1, edges);
  }

  void add(const Vec4* net, const Vec2& lower, const Vec2& upper, const TrimRegion::Edges& edges) {
    const Trapezoid whole{lower.y, upper.y, {lower.x, lower.x}, {upper.x, upper.x}};
    if (edges.empty()) {
      leaves.push_back({span, whole, degrees, nets.size()});
      nets.insert(nets.end(), net, net + degrees.size());
      return;
    }
    std::vector<Trapezoid> pieces;
    trims.append_pieces(edges, lower, upper, pieces);
    const Vec2 size = upper - lower;
    for (const Trapezoid& piece : pieces) {
      const Degrees made = degrees_over(degrees, piece);
      const auto u = [&](double x) { return lower.x + x * size.x; };
      leaves.push_back({span,
                        {lower.y + piece.low * size.y,
                         lower.y + piece.high * size.y,
                         {u(piece.left[0]), u(piece.left[1])},
                         {u(piece.right[0]), u(piece.right[1])}},
                        made,
                        nets.size(),
                        true});
      nets.resize(nets.size() + made.size());
      trimmed_net(net, degrees, piece, nets.data() + nets.size() - made.size());
      add_borders(net, lower, upper, piece);
    }
  }

  /// All sides of a trapezoid. An edge with nothing within the borders next to it is a side of none.
  void add_borders(const Vec4* net, const Vec2& lower, const Vec2& upper, const Trapezoid& piece) {
    const Vec2 corners[] = {piece.at({0, 0}), piece.at({1, 0}), piece.at({1, 1}), piece.at({0, 1})};
    const Degrees made{0, degrees.u + degrees.v};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2 &a = corners[k], &b = corners[(k + 1) % 4];
      if (a == b) continue;
      const Vec2 from = lower + a * (upper - lower), to = lower + b * (upper - lower);
      borders.push_back({span, {from.y, to.y, {from.x, to.x}, {from.x, to.x}}, made, nets.size()});
      nets.resize(nets.size() + made.size());
      border_net(net, degrees, a, b, nets.data() + nets.size() - made.size());
    }
  }
};

}  // namespace

void BoxTree::build(const std::vector<Box3>& items, std::size_t first) {
  if (first == items.size()) return;
  std::vector<Vec3> centres;
  for (const Box3& box : items) centres.push_back(0.5 * box.lower + 0.5 * box.upper);
  order.resize(items.size() - first);
  std::iota(order.begin(), order.end(), first);
  while ((std::size_t{2} << levels) <= order.size()) ++levels;
  geom::sort_by_medians(order, levels, centres);
  boxes = geom::boxes_of_tree(levels, [&](std::size_t k) {
    Box3 box;
    for (std::size_t i = geom::first_item(order.size(), levels, k); i < geom::first_item(order.size(), levels, k + 1);
         ++i)
      box.add(items[order[i]]);
    return box;
  });
}

ClosestTree::ClosestTree(const std::vector<BezierSpan>& spans, const std::vector<TrimRegion>& regions) {
  std::vector<BezierLeaf> borders;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const TrimmedSpan trims(spans[i], regions[spans[i].patch]);
    LeafMaker{i, spans[i].degrees, trims, leaves_, borders, nets_}.divide(spans[i].net.data(), Vec2(0), Vec2(1),
                                                                          kMaxHalvings + kMaxCuts, trims.all());
  }
  if (leaves_.empty())
    throw std::invalid_argument("trims: nothing is inside of the borders; leave trims out for the whole domain");
  const std::size_t faces = leaves_.size();
  std::vector<Box3> boxes;
  leaves_.insert(leaves_.end(), borders.begin(), borders.end());
  for (const BezierLeaf& leaf : leaves_) boxes.push_back(box_of(nets_.data() + leaf.net, leaf.degrees));
  borders_.build(boxes, faces);
  boxes.resize(faces);
  faces_.build(boxes, 0);
}

LeafFoot ClosestSearch::operator()(const Vec3& p, double scale) {
  p_ = p;
  best_ = {};
  best_.distance = std::numeric_limits<double>::infinity();
  slack_ = std::max(kProven, kRounding * std::max(scale, glm::length(p)));
  later_.clear();
  descend(tree_.faces_, [&](std::size_t index) {
    const BezierLeaf& leaf = tree_.leaf(index);
    if (!leaf.at_border) return search_leaf(index);
    later_.push_back(index);
    set_net(leaf);
    Vec2 at(0.5);
    improve(nets_.data(), leaf.degrees, {Vec2(0), Vec2(1)}, index, at);
  });
  if (!later_.empty()) descend(tree_.borders_, [&](std::size_t index) { search_leaf(index); });
  for (const std::size_t index : later_)
    if (goal() > 0) search_leaf(index);
  best_.point += p;
  return best_;
}

/// Calls leaf(i) for the items of leaves whose box is nearer than the goal, the nearer child first.
template <class Leaf>
void ClosestSearch::descend(const BoxTree& tree, const Leaf& leaf) {
  if (tree.boxes.empty()) return;
  struct Node {
    double squared;
    std::size_t index;
  };
  std::array<Node, 2 * 64> stack;
  std::size_t top = 0;
  stack[top++] = {squared_distance(p_, tree.boxes[0]), 0};
  const std::size_t first_leaf = (std::size_t{1} << tree.levels) - 1;
  while (top > 0) {
    const Node node = stack[--top];
    if (!(goal() > 0)) break;
    if (node.squared >= goal() * goal()) continue;
    if (node.index < first_leaf) {
      Node near{squared_distance(p_, tree.boxes[2 * node.index + 1]), 2 * node.index + 1};
      Node far{squared_distance(p_, tree.boxes[2 * node.index + 2]), 2 * node.index + 2};
      if (far.squared < near.squared) std::swap(near, far);
      stack[top++] = far, stack[top++] = near;
      continue;
    }
    const std::size_t k = node.index - first_leaf, n = tree.order.size();
    for (std::size_t i = geom::first_item(n, tree.levels, k); i < geom::first_item(n, tree.levels, k + 1); ++i)
      leaf(tree.order[i]);
  }
}

/// The leaf's net, relative to the query point, at the bottom of the stack.
void ClosestSearch::set_net(const BezierLeaf& leaf) {
  nets_.resize(std::max(nets_.size(), 3 * leaf.degrees.size()));
  for (std::size_t k = 0; k < leaf.degrees.size(); ++k) {
    const Vec4& h = tree_.nets_[leaf.net + k];
    nets_[k] = Vec4(Vec3(h) - h.w * p_, h.w);
  }
}

void ClosestSearch::search_leaf(std::size_t index) {
  const BezierLeaf& leaf = tree_.leaf(index);
  const Degrees& degrees = leaf.degrees;
  const std::size_t size = degrees.size();
  set_net(leaf);
  cells_.assign(1, {Vec2(0), Vec2(1)});
  std::array<Vec4, kMaxNet> net;
  for (int round = 0; !cells_.empty() && goal() > 0; ++round) {
    if (round % 1024 == 1023) base::still_wanted();
    const Cell cell = cells_.back();
    cells_.pop_back();
    std::copy_n(nets_.begin() + static_cast<std::ptrdiff_t>(cells_.size() * size), size, net.begin());
    if (excluded(net.data(), degrees)) continue;
    Vec2 at(0.5);
    improve(net.data(), degrees, cell, index, at);
    if (!(goal() > 0)) return;
    set_excess(net.data(), degrees);
    if (excess_.positive() || excluded_by_convexity(net.data(), degrees, at)) continue;
    const Vec2 bend = excess_.bend();
    if (leaf.at_border && excluded_by_rectangle(leaf, index, cell)) continue;
    if (!(goal() > 0)) return;
    // No part of a net that is as small as the slack is nearer by more than that.
    if (glm::length(box_of(net.data(), degrees).size()) <= slack_) continue;
    const bool along_u = degrees.u > 0 && bend.x >= bend.y;
    const Vec2 middle = 0.5 * (cell.lower + cell.upper);
    if (along_u ? middle.x == cell.lower.x || middle.x == cell.upper.x
                : middle.y == cell.lower.y || middle.y == cell.upper.y)
      continue;  // parameters have no number between these
    const std::size_t place = cells_.size();
    nets_.resize(std::max(nets_.size(), (place + 2) * size));
    Vec4 *first = nets_.data() + place * size, *second = first + size;
    halve(net.data(), degrees, along_u, first, second);
    cells_.push_back({cell.lower, along_u ? Vec2(middle.x, cell.upper.y) : Vec2(cell.upper.x, middle.y)});
    cells_.push_back({along_u ? Vec2(middle.x, cell.lower.y) : Vec2(cell.lower.x, middle.y), cell.upper});
    if ((along_u ? at.x : at.y) >= 0.5) continue;  // the half with the nearest point found here is searched first
    std::swap_ranges(first, first + size, second);
    std::swap(cells_[place], cells_[place + 1]);
  }
}

/// By the box, or by the coefficients of G.
bool ClosestSearch::excluded(const Vec4* net, const Degrees& degrees) {
  if (!std::isfinite(best_.distance)) return false;
  const double squared = squared_distance(Vec3(0), box_of(net, degrees));
  if (squared >= goal() * goal()) return true;
  set_excess(net, degrees);
  return excess_.positive();
}

ClosestSearch::Form ClosestSearch::form() const {
  return {goal() * goal()};
}

void ClosestSearch::set_excess(const Vec4* net, const Degrees& degrees) {
  excess_.set(net, degrees, form());
}

/// Whether G is convex and its tangent plane at `at` is not negative in the unit square.
bool ClosestSearch::excluded_by_convexity(const Vec4* net, const Degrees& degrees, const Vec2& at) const {
  return excess_.convex() && Excess::tangent_is_positive(jet_of(net, degrees, at), at, form());
}

/// Whether the rectangle of parameters around a cell has no point within the borders that is nearer than the goal. No
/// border is.
bool ClosestSearch::excluded_by_rectangle(const BezierLeaf& leaf, std::size_t index, const Cell& cell) {
  const BezierSpan& span = spans_[leaf.span];
  const Vec2 corners[] = {leaf.domain.at(cell.lower), leaf.domain.at({cell.upper.x, cell.lower.y}),
                          leaf.domain.at({cell.lower.x, cell.upper.y}), leaf.domain.at(cell.upper)};
  Vec2 lower = corners[0], upper = corners[0];
  for (const Vec2& c : corners) lower = glm::min(lower, c), upper = glm::max(upper, c);
  // Derivatives across a narrow rectangle would be rounding only.
  const Vec2 size = upper - lower, wider = glm::max(size, glm::max(kNarrow * Vec2(size.y, size.x), Vec2(kSmall)));
  lower = glm::max(lower - 0.5 * (wider - size), 0.0), upper = glm::min(upper + 0.5 * (wider - size), 1.0);
  const Trapezoid rectangle{lower.y, upper.y, {lower.x, lower.x}, {upper.x, upper.x}};
  std::array<Vec4, kMaxNet> net;
  trimmed_net(span.net.data(), span.degrees, rectangle, net.data());
  for (std::size_t k = 0; k < span.degrees.size(); ++k) net[k] -= Vec4(net[k].w * p_, 0);
  set_excess(net.data(), span.degrees);
  if (excess_.positive()) return true;
  if (!excess_.convex()) return false;
  Vec2 at(0.5);
  const double distance = std::sqrt(walk_to_foot(net.data(), span.degrees, at));
  if (distance < goal()) {
    const Vec2 place = rectangle.at(at);
    if (!regions_[span.patch].holds(span.to_patch(place))) return true;
    best_ = {affine(point_of(net.data(), span.degrees, at)), distance, index, place};
  }
  return !(goal() > 0) || excluded_by_convexity(net.data(), span.degrees, at);
}

/// Sets `at` to the nearest point of the net that Newton's method finds, and keeps it if it is the nearest so far.
void ClosestSearch::improve(const Vec4* net, const Degrees& degrees, const Cell& cell, std::size_t leaf, Vec2& at) {
  const double distance = std::sqrt(walk_to_foot(net, degrees, at));
  if (!(distance < best_.distance)) return;
  best_ = {affine(point_of(net, degrees, at)), distance, leaf,
           tree_.leaf(leaf).domain.at(cell.lower + at * (cell.upper - cell.lower))};
}

}  // namespace riffler::nurbs
