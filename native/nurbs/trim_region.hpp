// The part of a patch's domain that its borders enclose, and its division into trapezoids.
#pragma once

#include <cstdint>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::nurbs {

/// A part of a parameter square between two lines of constant v and two straight lines. Triangles have one side of
/// length 0.
struct Trapezoid {
  double low = 0, high = 1;                    // v
  double left[2] = {0, 0}, right[2] = {1, 1};  // u at `low` and at `high`

  /// The parameters at (s, t) of the unit square.
  Vec2 at(const Vec2& st) const {
    const double l = left[0] + st.y * (left[1] - left[0]), r = right[0] + st.y * (right[1] - right[0]);
    return {l + st.x * (r - l), low + st.y * (high - low)};
  }
};

/// What closed polylines enclose an odd number of times.
class TrimRegion {
 public:
  using Edges = std::vector<std::uint32_t>;

  TrimRegion() = default;
  explicit TrimRegion(const std::vector<std::vector<Vec2>>& loops);

  /// Whether there is no border, so that everything is inside.
  bool everywhere() const { return edges_.empty() && !closed_; }
  bool holds(const Vec2& p) const;

  Edges all() const;
  /// Those of `some` edges that touch a rectangle.
  Edges touching(const Edges& some, const Vec2& lower, const Vec2& upper) const;
  /// Appends the trapezoids of the region in a rectangle, which `edges` touch, by slabs between the edges' ends and
  /// crossings. Parameters are relative to the rectangle.
  void append_pieces(const Edges& edges, const Vec2& lower, const Vec2& upper, std::vector<Trapezoid>& out) const;

 private:
  struct Edge {
    Vec2 a, b;  // a.y <= b.y

    double u(double v) const;
    bool spans(double v) const { return a.y <= v && v < b.y; }
  };

  void sort_into_bands();
  std::vector<double> slabs(const Edges& edges, const Vec2& lower, const Vec2& upper) const;

  std::vector<Edge> edges_;
  bool closed_ = false;  // there were borders
  double low_ = 0, per_band_ = 0;
  std::vector<Edges> bands_;  // edges by bands of v
};

}  // namespace riffler::nurbs
