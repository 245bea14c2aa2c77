// The local frame at a cutter contact point, and tool axes as inclination and tilt in it (4.1).
#pragma once

#include <string_view>

#include "riffler/plan/path.hpp"

namespace riffler::plan {

/// Right-handed: x the feed direction, z the part's normal, y = z × x, to the left of the feed.
struct CcFrame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

/// Inclination leans the axis forward, from the normal towards the feed; tilt then leans it out of the plane of both,
/// to the left. rad. The source turns about two axes of the frame without saying in which order; here it is axis = cos
/// ω (sin λ x + cos λ z) + sin ω y, regular everywhere but at ω = ±π/2: the normal itself is no pole.
struct Lean {
  double inclination = 0;  ///< λ
  double tilt = 0;         ///< ω
};

/// Frame from a feed direction of any length and a unit normal. Only the part of the feed that is square to the normal
/// counts; where nothing is left of it, x is the coordinate axis furthest from the normal, made square to it.
CcFrame cc_frame(const Vec3& feed, const Vec3& normal);

Vec3 axis_of(const CcFrame& frame, const Lean& lean);
/// Inverse of axis_of: inclination in (−π, π], tilt in [−π/2, π/2]; at ω = ±π/2 the inclination is 0.
Lean lean_of(const CcFrame& frame, const Vec3& axis);

/// Unit direction in which a path runs at point `k`: between its neighbours, of a loop round its end; the zero vector
/// where they coincide.
Vec3 feed_at(const PencilPath& path, std::size_t k);
/// Unit vector that halves the angle between the directions from the two contacts to the ball's centre; for walls that
/// face each other, x × n of the first.
Vec3 bisector_at(const PencilPath& path, std::size_t k);
/// The frame at the ball's centre: feed and bisector.
CcFrame frame_at(const PencilPath& path, std::size_t k);

/// `axis` made a unit vector; std::invalid_argument "`what`: …" where it is not finite or not one within 1e-6.
Vec3 unit_axis(const Vec3& axis, std::string_view what);

}  // namespace riffler::plan
