// A convex part of a tool on a straight path without rotation, as plain numbers for the kernel.
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// Lines a s + b τ = c of a section, for all c: through the point c per_norm (dt, −ds) in the direction (ds, dt).
struct SectionLine {
  SectionLine() = default;
  /// The line does not exist if a and b are (nearly) zero: below `least`.
  SectionLine(double a, double b, double least);
  bool exists = false;
  double ds = 0, dt = 0, per_norm = 0;
};

/// A piece of the group, and which of its surfaces may bound the group's swept volume.
struct SweptShape : PieceShape {
  /// A ray through the line that a cone's apex sweeps touches the side in a double root (at_most_zero).
  static constexpr double kTangent = 1e-13;
  /// Whether its flat face at z0 or z1 exists and is not hidden inside the group, or its rim is an edge of the group.
  bool face0, face1;
  double low, high;       ///< heights between which its side lies, up to rounding
  double floor, ceiling;  ///< heights along the rays between which it stays on the path
  /// n · V = 0 on a Frustum: for F = ρ² − k², ∂F/∂τ = 0 is a line of the section, and F is quadratic on it.
  SectionLine outline;
};

/// The swept volume of a convex group on a straight path of length L at constant orientation. It is convex, so a ray
/// meets it in one interval. In the plane spanned by ray and motion, with coordinates (s along the ray, τ along the
/// path), its section is { group at τ contains the point } ∩ { 0 ≤ τ ≤ L }, a convex set; [near, far] are its extreme
/// s. The extremes are taken over *all* hits that lie in the body (the pieces at both ends of the path, their swept
/// faces, the silhouettes n · V = 0). Every candidate belongs to the body and every part of its boundary has one, so no
/// case analysis can open or invert an interval (methods: "Tool motion and its swept volume").
///
/// Frame: the cyclic frame of a grid, with rays along its third axis and s measured from the height of the tip at the
/// start, so that coordinates far from the origin lose no precision. Three vectors e1, e2, axis with e1 × e2 = axis;
/// the rays lie in the plane of axis and e1, in the direction tilt e1 + oz axis.
struct StraightBody {
  /// The tool's tip starts at `from` and moves by `motion` (mm, may be zero) between the times t0 and t1: those of its
  /// move where that turns; else 0 and 1, for the part of its move near the grid (for_each_step).
  StraightBody(const ConvexGroup& group, const Pose& from, const Vec3& motion, double t0, double t1);

  std::size_t count;
  std::array<SweptShape, ConvexGroup::kMax> pieces;
  double tip[3], moved[3];  ///< the tip at t0, its displacement
  double axis[3], e1[3], e2[3];
  double tilt, oz;
  double way, m1, m2, mo;  ///< length of the motion and its unit vector in the frame
  SectionLine face;        ///< for planes perpendicular to the axis
  double t0, per_way;      ///< t at path length τ is t0 + τ per_way
  double middle;           ///< t at the midpoint
};

}  // namespace riffler::sweep
