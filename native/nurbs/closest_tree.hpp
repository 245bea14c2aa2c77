// The nearest point of Bézier spans, proven to be the nearest of all.
//
// Lower bounds: a net is in the hull of its control points; and |S - p|² - τ² is, multiplied by w², a polynomial G
// whose Bézier coefficients bound it. If all are ≥ 0, no point of the net is nearer to p than τ. If G is convex, its
// tangent plane in any point bounds it as well, which ends the search next to the nearest point. Otherwise the net is
// halved, across the direction in which G bends more. Nets that are equally near everywhere (a ball's around its
// centre) have a constant G, and end the search at once.
//
// Borders of trimmed patches are searched as curves, before the trapezoids next to them. If then G is convex in a
// rectangle of parameters and negative in a point of it that is outside of the borders, the part within them has no
// point with a negative G: the line from one to the other would cross a border in such a point.
#pragma once

#include <cstddef>
#include <vector>

#include "nurbs/bezier.hpp"
#include "nurbs/excess.hpp"
#include "nurbs/trimmed_span.hpp"

namespace riffler::nurbs {

/// A part of a span that bends little, or a straight piece of a border: then u has no extent, and degree 0.
struct BezierLeaf {
  std::size_t span = 0;
  Trapezoid domain;  // in the span's unit square
  Degrees degrees;
  std::size_t net = 0;     // where its control points begin
  bool at_border = false;  // a trapezoid next to borders
};

/// A binary tree of boxes over items.
struct BoxTree {
  std::vector<std::size_t> order;  // of the items
  std::size_t levels = 0;
  std::vector<Box3> boxes;  // of the nodes: node i has the children 2 i + 1 and 2 i + 2

  /// Over the items from `first` on.
  void build(const std::vector<Box3>& items, std::size_t first);
};

/// Trees over the leaves of all spans, and over the pieces of borders.
class ClosestTree {
 public:
  ClosestTree() = default;
  /// `regions`: of the patches. Throws std::invalid_argument if they leave nothing.
  ClosestTree(const std::vector<BezierSpan>& spans, const std::vector<TrimRegion>& regions);

  const BezierLeaf& leaf(std::size_t i) const { return leaves_[i]; }

 private:
  friend class ClosestSearch;

  std::vector<BezierLeaf> leaves_;  // of faces, then of borders
  std::vector<Vec4> nets_;
  BoxTree faces_, borders_;
};

/// The nearest point, with its parameters in the unit square of the leaf's span.
struct LeafFoot {
  Vec3 point{0};
  double distance = 0;
  std::size_t leaf = 0;
  Vec2 uv{0};
};

/// One thread's search with its memory.
class ClosestSearch {
 public:
  /// Keeps references to all three; `spans` and `regions` are those of the tree.
  ClosestSearch(const ClosestTree& tree, const std::vector<BezierSpan>& spans, const std::vector<TrimRegion>& regions)
      : tree_(tree), spans_(spans), regions_(regions) {}
  /// `scale`: the surface's largest coordinate, mm.
  LeafFoot operator()(const Vec3& p, double scale);

 private:
  /// A part of a leaf whose net, relative to the query point, is on the stack.
  struct Cell {
    Vec2 lower, upper;  // in the leaf's unit square
  };
  /// |a - p|² - τ² in homogeneous coordinates about p.
  struct Form {
    double squared;
    double operator()(const Vec4& a, const Vec4& b) const {
      return a.x * b.x + a.y * b.y + a.z * b.z - squared * a.w * b.w;
    }
  };

  template <class Leaf>
  void descend(const BoxTree& tree, const Leaf& leaf);
  void set_net(const BezierLeaf& leaf);
  void search_leaf(std::size_t leaf);
  bool excluded_by_rectangle(const BezierLeaf& leaf, std::size_t index, const Cell& cell);
  bool excluded(const Vec4* net, const Degrees& degrees);
  Form form() const;
  void set_excess(const Vec4* net, const Degrees& degrees);
  bool excluded_by_convexity(const Vec4* net, const Degrees& degrees, const Vec2& at) const;
  void improve(const Vec4* net, const Degrees& degrees, const Cell& cell, std::size_t leaf, Vec2& at);
  /// Distance (mm) that the rest of the surface must be proven to have at least.
  double goal() const { return best_.distance - slack_; }

  const ClosestTree& tree_;
  const std::vector<BezierSpan>& spans_;
  const std::vector<TrimRegion>& regions_;
  std::vector<std::size_t> later_;  // leaves at borders
  std::vector<Vec4> nets_;
  std::vector<Cell> cells_;
  Excess excess_;
  Vec3 p_{0};
  double slack_ = 0;
  LeafFoot best_;
};

}  // namespace riffler::nurbs
