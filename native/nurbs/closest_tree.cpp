#include "nurbs/closest_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "geom/median_tree.hpp"
#include "nurbs/chord_bound.hpp"
#include "nurbs/foot.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::nurbs {

namespace {

constexpr double kFlat = 0.05;       // distance of a leaf from its plane, relative to its size
constexpr int kMaxHalvings = 10;     // of a span, for leaves
constexpr double kProven = 1e-9;     // mm
constexpr double kRounding = 1e-13;  // relative

Box3 box_of(const Vec4* net, const Degrees& degrees) {
  Box3 box;
  for (std::size_t k = 0; k < degrees.size(); ++k) box.add(affine(net[k]));
  return box;
}

double squared_distance(const Vec3& p, const Box3& box) {
  const Vec3 d = glm::max(glm::max(box.lower - p, p - box.upper), Vec3(0));
  return glm::dot(d, d);
}

/// Binomial coefficients up to those of degree 2 kMaxDegree.
struct Binomials {
  std::array<std::array<double, 2 * kMaxDegree + 1>, 2 * kMaxDegree + 1> rows{};

  constexpr Binomials() {
    for (std::size_t n = 0; n < rows.size(); ++n) {
      rows[n][0] = 1;
      for (std::size_t k = 1; k <= n; ++k) rows[n][k] = rows[n - 1][k - 1] + (k < n ? rows[n - 1][k] : 0);
    }
  }
  constexpr double operator()(int n, int k) const {
    return rows[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
  }
};
constexpr Binomials kBinomials;

/// Divides a span until it bends little.
struct LeafMaker {
  std::size_t span;
  Degrees degrees;
  std::vector<BezierLeaf>& leaves;
  std::vector<Vec4>& nets;

  void divide(const Vec4* net, const Vec2& lower, const Vec2& upper, int halvings) {
    const SecondDerivatives bound = second_derivatives(net, degrees);
    const Vec3 size = box_of(net, degrees).size();
    if (halvings == 0 || !(bound.chord(1, 1) > kFlat * glm::length(size))) {
      leaves.push_back({span, lower, upper, degrees, nets.size()});
      nets.insert(nets.end(), net, net + degrees.size());
      return;
    }
    const bool along_u = bound.uu >= bound.vv;
    const Vec2 middle = 0.5 * (lower + upper);
    std::vector<Vec4> halves(2 * degrees.size());
    halve(net, degrees, along_u, halves.data(), halves.data() + degrees.size());
    divide(halves.data(), lower, along_u ? Vec2(middle.x, upper.y) : Vec2(upper.x, middle.y), halvings - 1);
    divide(halves.data() + degrees.size(), along_u ? Vec2(middle.x, lower.y) : Vec2(lower.x, middle.y), upper,
           halvings - 1);
  }
};

}  // namespace

ClosestTree::ClosestTree(const std::vector<BezierSpan>& spans) {
  for (std::size_t i = 0; i < spans.size(); ++i)
    LeafMaker{i, spans[i].degrees, leaves_, nets_}.divide(spans[i].net.data(), Vec2(0), Vec2(1), kMaxHalvings);
  std::vector<Box3> boxes;
  std::vector<Vec3> centres;
  for (const BezierLeaf& leaf : leaves_) {
    boxes.push_back(box_of(nets_.data() + leaf.net, leaf.degrees));
    centres.push_back(0.5 * boxes.back().lower + 0.5 * boxes.back().upper);
  }
  order_.resize(leaves_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  while ((std::size_t{2} << levels_) <= leaves_.size()) ++levels_;
  geom::sort_by_medians(order_, levels_, centres);
  boxes_ = geom::boxes_of_tree(levels_, [&](std::size_t k) {
    Box3 box;
    for (std::size_t i = geom::first_item(order_.size(), levels_, k);
         i < geom::first_item(order_.size(), levels_, k + 1); ++i)
      box.add(boxes[order_[i]]);
    return box;
  });
}

ClosestSearch::ClosestSearch(const ClosestTree& tree) : tree_(&tree) {}

LeafFoot ClosestSearch::operator()(const Vec3& p, double scale) {
  p_ = p;
  best_ = {};
  best_.distance = std::numeric_limits<double>::infinity();
  slack_ = std::max(kProven, kRounding * std::max(scale, glm::length(p)));
  struct Node {
    double squared;
    std::size_t index;
  };
  std::array<Node, 2 * 64> stack;
  std::size_t top = 0;
  stack[top++] = {squared_distance(p, tree_->boxes_[0]), 0};
  const std::size_t first_leaf = (std::size_t{1} << tree_->levels_) - 1;
  while (top > 0) {
    const Node node = stack[--top];
    if (!(goal() > 0)) break;
    if (node.squared >= goal() * goal()) continue;
    if (node.index < first_leaf) {
      Node near{squared_distance(p, tree_->boxes_[2 * node.index + 1]), 2 * node.index + 1};
      Node far{squared_distance(p, tree_->boxes_[2 * node.index + 2]), 2 * node.index + 2};
      if (far.squared < near.squared) std::swap(near, far);
      stack[top++] = far, stack[top++] = near;
      continue;
    }
    const std::size_t k = node.index - first_leaf, n = tree_->order_.size();
    for (std::size_t i = geom::first_item(n, tree_->levels_, k); i < geom::first_item(n, tree_->levels_, k + 1); ++i)
      search_leaf(tree_->order_[i]);
  }
  best_.point += p;
  return best_;
}

void ClosestSearch::search_leaf(std::size_t index) {
  const BezierLeaf& leaf = tree_->leaf(index);
  const Degrees& degrees = leaf.degrees;
  const std::size_t size = degrees.size();
  nets_.resize(std::max(nets_.size(), 3 * size));
  for (std::size_t k = 0; k < size; ++k) {
    const Vec4& h = tree_->nets_[leaf.net + k];
    nets_[k] = Vec4(Vec3(h) - h.w * p_, h.w);
  }
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
    // No part of a net that is as small as the slack is nearer by more than that.
    if (glm::length(box_of(net.data(), degrees).size()) <= slack_) continue;
    const Vec2 bend = excess_.bend();
    const bool along_u = bend.x >= bend.y;
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

void ClosestSearch::set_excess(const Vec4* net, const Degrees& degrees) {
  const Degrees twice{2 * degrees.u, 2 * degrees.v};
  const double squared = goal() * goal();
  excess_.degrees = twice;
  excess_.g.assign(twice.size(), 0);
  for (int i = 0; i <= degrees.u; ++i)
    for (int k = 0; k <= degrees.u; ++k) {
      const double share_u = kBinomials(degrees.u, i) * kBinomials(degrees.u, k) / kBinomials(twice.u, i + k);
      for (int j = 0; j <= degrees.v; ++j)
        for (int l = 0; l <= degrees.v; ++l) {
          const Vec4 &a = net[degrees.at(i, j)], &b = net[degrees.at(k, l)];
          const double share_v = kBinomials(degrees.v, j) * kBinomials(degrees.v, l) / kBinomials(twice.v, j + l);
          excess_.g[twice.at(i + k, j + l)] +=
              share_u * share_v * (a.x * b.x + a.y * b.y + a.z * b.z - squared * a.w * b.w);
        }
    }
}

bool ClosestSearch::Excess::positive() const {
  return std::all_of(g.begin(), g.end(), [](double x) { return x >= 0; });
}

/// Largest second differences along u and v, times the share in which a coefficient exceeds the polynomial.
Vec2 ClosestSearch::Excess::bend() const {
  Vec2 most(0);
  for (int i = 0; i <= degrees.u; ++i)
    for (int j = 0; j <= degrees.v; ++j) {
      if (i + 2 <= degrees.u) most.x = std::max(most.x, std::abs(at(i + 2, j) - 2 * at(i + 1, j) + at(i, j)));
      if (j + 2 <= degrees.v) most.y = std::max(most.y, std::abs(at(i, j + 2) - 2 * at(i, j + 1) + at(i, j)));
    }
  return {most.x * degrees.u, most.y * degrees.v};
}

/// Whether the coefficients of its second derivatives show that G is convex.
bool ClosestSearch::Excess::convex() const {
  double uu = std::numeric_limits<double>::infinity(), vv = uu, uv = 0;
  for (int i = 0; i <= degrees.u; ++i)
    for (int j = 0; j <= degrees.v; ++j) {
      if (i + 2 <= degrees.u) uu = std::min(uu, at(i + 2, j) - 2 * at(i + 1, j) + at(i, j));
      if (j + 2 <= degrees.v) vv = std::min(vv, at(i, j + 2) - 2 * at(i, j + 1) + at(i, j));
      if (i < degrees.u && j < degrees.v)
        uv = std::max(uv, std::abs(at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)));
    }
  uu *= degrees.u * (degrees.u - 1), vv *= degrees.v * (degrees.v - 1), uv *= degrees.u * degrees.v;
  return uu >= 0 && vv >= 0 && uu * vv >= uv * uv;
}

/// Whether G is convex and its tangent plane at `at` is not negative in the unit square.
bool ClosestSearch::excluded_by_convexity(const Vec4* net, const Degrees& degrees, const Vec2& at) const {
  if (!excess_.convex()) return false;
  const Jet4 h = jet_of(net, degrees, at);
  const double squared = goal() * goal();
  const auto product = [&](const Vec4& a, const Vec4& b) { return glm::dot(Vec3(a), Vec3(b)) - squared * a.w * b.w; };
  const auto lowest = [](double slope, double t) { return std::min(-slope * t, slope * (1 - t)); };
  return product(h.s, h.s) + lowest(2 * product(h.s, h.u), at.x) + lowest(2 * product(h.s, h.v), at.y) >= 0;
}

/// Sets `at` to the nearest point of the net that Newton's method finds, and keeps it if it is the nearest so far.
void ClosestSearch::improve(const Vec4* net, const Degrees& degrees, const Cell& cell, std::size_t leaf, Vec2& at) {
  const double distance = std::sqrt(walk_to_foot(net, degrees, at));
  if (!(distance < best_.distance)) return;
  best_ = {affine(point_of(net, degrees, at)), distance, leaf, cell.lower + at * (cell.upper - cell.lower)};
}

}  // namespace riffler::nurbs
