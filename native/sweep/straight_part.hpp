// A convex part of a tool on a straight way without turning: what the kernel needs, in plain numbers.
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// Lines a s + b τ = c of a section, for all c: through the point c per_norm (dt, −ds) in the direction (ds, dt).
struct SectionLine {
  SectionLine() = default;
  /// There is none where a and b are nothing: below `least`.
  SectionLine(double a, double b, double least);
  bool exists = false;
  double ds = 0, dt = 0, per_norm = 0;
};

/// A piece of the group, and which of its surfaces may bound what the group sweeps.
struct SweptShape : PieceShape {
  /// A ray through the line that a cone's apex sweeps touches its side in a double root (at_most_zero).
  static constexpr double kTangent = 1e-13;
  bool face0,
      face1;  ///< its flat face at z0, at z1, is there and not hidden within the group, or its rim is an edge of it
  double low, high;       ///< heights between which its side is, up to rounding
  double floor, ceiling;  ///< heights along the rays between which it stays on the way
  /// n · V = 0 on a Frustum: F = ρ² − k², ∂F/∂τ = 0 is a line of the section, on which F is quadratic.
  SectionLine outline;
};

/// The body that a convex group sweeps on a straight way at fixed orientation. It is convex, so a ray meets it in one
/// interval; in the plane spanned by ray and motion, with coordinates (s along the ray, τ along the way), its section
/// is { group at τ contains the point } ∩ { 0 ≤ τ ≤ way }, a convex set of which [near, far] are the extreme s. The
/// extremes are taken over *all* hits that lie in the body (the pieces at both ends of the way, their faces swept, the
/// silhouettes n · V = 0): every candidate belongs to the body and every part of its boundary has one, so no case
/// analysis can open or invert an interval (methods: "Tool motion and its swept volume").
/// Frame: the cyclic frame of a grid, rays along its third axis, s from the height of the tip at the start, so that
/// coordinates far from the origin lose nothing. Three vectors e1, e2, axis with e1 × e2 = axis, the rays in the plane
/// of axis and e1: their direction is tilt e1 + oz axis.
struct StraightBody {
  /// The tool's tip starts at `from` and moves by `motion` (may be zero) between the times t0 and t1 of its move.
  StraightBody(const ConvexGroup& group, const Pose& from, const Vec3& motion, double t0, double t1);

  std::size_t count;
  std::array<SweptShape, ConvexGroup::kMax> pieces;
  double tip[3], axis[3], e1[3], e2[3];
  double tilt, oz;
  double way, m1, m2, mo;  ///< length of the motion and its unit vector in the frame
  SectionLine face;        ///< of planes square to the axis
  double t0, per_way;      ///< the move's t after the way τ is t0 + τ per_way
  double middle;           ///< t in the middle
};

}  // namespace riffler::sweep
