// One convex piece of a tool on a short part of a move that turns its axis, against rays along +w.
#pragma once

#include <array>

#include "geom/pose.hpp"
#include "sweep/swept_piece.hpp"

namespace riffler {

/// One connected stretch of a ray inside the swept body; `near_t` and `far_t` are the move's t at its ends.
struct SweptInterval {
  SweptHit near, far;
  double near_t = 0, far_t = 0;
};

/// Disjoint stretches of one ray, merged where they overlap; a part of a move rarely makes more than one.
class SweptIntervals {
 public:
  void clear() { count_ = 0; }
  void add(const SweptInterval& interval);
  const SweptInterval* begin() const { return items_.data(); }
  const SweptInterval* end() const { return items_.data() + count_; }
  bool empty() const { return count_ == 0; }

 private:
  static constexpr int kMost = 8;
  std::array<SweptInterval, kMost> items_;
  int count_ = 0;
};

/// The piece at its *exact* pose for every t in [t0, t1], where the pose turns so little that the sets met here are
/// convex up to a fraction of the tolerance (steps.hpp says how many parts that takes). While the ray meets the moving
/// piece it does so in one interval [a(t), b(t)], and a is convex in t, b concave, up to that fraction: so the least a
/// is at an end of the part or at the one place where a′ changes sign, with a′ = (n · v) / (n · d) (methods: "Per-ray
/// form": the envelope condition (3.1) itself). It is bracketed and narrowed by exact hits only, which all belong to
/// the swept volume: nothing is ever cut too much. Two tangents of a convex function bound its minimum from below,
/// which says when to stop.
class TurningPiece {
 public:
  /// `motion` must outlive this. `tolerance`: mm, along the ray.
  TurningPiece(const Piece& piece, const Motion& motion, double t0, double t1, double tolerance);

  /// Adds the stretches of the ray through (u, v). Ends outside of `material` need not be exact.
  void hit(double u, double v, const Interval& material, SweptIntervals& out) const;
  /// Unit normal, out of the body, at one end of a stretch.
  Vec3 normal(double u, double v, const SweptHit& hit, double t) const;

 private:
  struct Sample;
  struct Slope;
  SweptPiece at(double t) const { return {piece_, motion_->tip(t), motion_->axis(t), Vec3(0)}; }
  Sample sample(double u, double v, double t) const;
  Sample sample(double u, double v, double t, const SweptPiece& body) const;
  Slope slope(double u, double v, const Sample& s, bool far) const;
  void part(double u, double v, const Interval& material, const Sample& from, const Sample& to, int depth,
            SweptIntervals& out) const;
  Sample extreme(double u, double v, bool far, const Sample& from, const Sample& to, double beyond) const;
  Sample inside(double u, double v, double t0, double t1) const;
  double gap(double u, double v, double t) const;

  Piece piece_;
  const Motion* motion_;
  double t0_, t1_, tolerance_;
  SweptPiece first_, last_, straight_;
};

}  // namespace riffler
