// The local frame at a cutter contact point, and tool axes as inclination and tilt in it (4.1).
#pragma once

#include <string_view>

#include "riffler/plan/path.hpp"

namespace riffler::plan {

/// Right-handed: x along the feed, z along the part's normal, y = z × x to the left of the feed.
struct CcFrame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

/// Tool axis in a CcFrame, rad. Inclination leans it from the normal towards the feed; tilt then leans it to the left,
/// out of the plane of normal and feed. The source does not state the order of the two rotations; here axis = cos ω
/// (sin λ x + cos λ z) + sin ω y, which is regular everywhere except at ω = ±π/2: the normal is not a pole.
struct Lean {
  double inclination = 0;  ///< λ
  double tilt = 0;         ///< ω
};

/// Frame from a feed direction of any length and a unit normal. Uses only the component of the feed orthogonal to the
/// normal. If that vanishes, x is the coordinate axis furthest from the normal, made orthogonal to it.
CcFrame cc_frame(const Vec3& feed, const Vec3& normal);

/// The unit axis with this inclination and tilt.
Vec3 axis_of(const CcFrame& frame, const Lean& lean);
/// Inverse of axis_of: inclination in (−π, π], tilt in [−π/2, π/2]; at ω = ±π/2 the inclination is 0.
Lean lean_of(const CcFrame& frame, const Vec3& axis);

/// Unit direction of the path at point `k`, from its neighbours; a closed path wraps around. Zero where the neighbours
/// coincide.
Vec3 feed_at(const PencilPath& path, std::size_t k);
/// Unit vector that halves the angle between the directions from the ball's centre to the two contacts, pointing away
/// from the part. For walls that face each other: feed × normal of the first contact.
Vec3 bisector_at(const PencilPath& path, std::size_t k);
/// The frame at the ball's centre, from feed and bisector.
CcFrame frame_at(const PencilPath& path, std::size_t k);

/// `axis`, normalised. Throws std::invalid_argument "`what`: …" if it is not finite or not of unit length within 1e-6.
Vec3 unit_axis(const Vec3& axis, std::string_view what);

}  // namespace riffler::plan
