// The borders of a patch, seen from the unit square of one of its spans.
#pragma once

#include <vector>

#include "nurbs/bezier.hpp"
#include "nurbs/trim_region.hpp"

namespace riffler::nurbs {

class TrimmedSpan {
 public:
  /// Keeps references to both.
  TrimmedSpan(const BezierSpan& span, const TrimRegion& region) : span_(span), region_(region) {}

  TrimRegion::Edges all() const { return region_.all(); }
  bool holds(const Vec2& p) const { return region_.holds(span_.to_patch(p)); }
  TrimRegion::Edges touching(const TrimRegion::Edges& some, const Vec2& lower, const Vec2& upper) const {
    return region_.touching(some, span_.to_patch(lower), span_.to_patch(upper));
  }
  /// The parts of a rectangle that are inside, relative to it.
  void append_pieces(const TrimRegion::Edges& edges, const Vec2& lower, const Vec2& upper,
                     std::vector<Trapezoid>& out) const {
    region_.append_pieces(edges, span_.to_patch(lower), span_.to_patch(upper), out);
  }

 private:
  const BezierSpan& span_;
  const TrimRegion& region_;
};

}  // namespace riffler::nurbs
