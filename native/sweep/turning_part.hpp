// A convex part of a tool on a short part of a move that turns its axis, as plain numbers for the kernel.
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// A circle about the axis, possibly thickened: a Round, or an edge (`thick` is 0). Planes that touch the group there
/// have normals n with turn0 ≤ n · axis ≤ turn1.
struct Rim {
  double radius, z, thick, turn0, turn1;
};

/// The group and its motion as plain numbers. Heights along the rays are measured from the tip's height at the start of
/// the part.
struct TurningBody {
  TurningBody(const ConvexGroup& group, const Motion& motion, double t0, double t1, double tolerance);

  std::size_t count;
  std::array<PieceShape, ConvexGroup::kMax> pieces;
  std::size_t rim_count;
  std::array<Rim, 2 * ConvexGroup::kMax + 1> rims;
  bool leans;     ///< whether a piece is a cone
  double widest;  ///< largest radius
  double t0, t1, origin;
  double tip[3], way[3];    ///< the tip at t = 0, heights from the origin, and its velocity
  double axis[3], side[3];  ///< axis(t) = cos θ axis + sin θ side, θ = angle (t − middle)
  double middle, angle;
  /// The poses at t0 and t1.
  struct End {
    double tip[3], axis[3];
  } start, end;
  double spin[3];      ///< Ω, per unit of t
  double pull, drift;  ///< |Ω|³ and 3 |Ω|² |V|, for the bound on the third derivative (docs/methods.md)
  double speed;        ///< |V|
  double along;        ///< mm, tolerance of an end along the ray
  double aside;        ///< mm, tolerance of a supporting plane in space
  int deepest;         ///< number of halvings after which no point moves more than `aside`
};

}  // namespace riffler::sweep
