// The named cutters: each is one function that writes down a profile.
#pragma once

#include "tool/tool.hpp"

namespace riffler::cutters {

/// Every function throws std::invalid_argument naming the size that is not positive and finite or does not fit.
Tool ball(double diameter, double length);
Tool flat(double diameter, double length);
/// Bull nose: major radius e = diameter / 2 − corner_radius.
Tool fillet(double diameter, double corner_radius, double length);
/// Cone of `half_angle` (rad, between axis and flank) above a ball tip tangent to it (or a flat tip), up to `diameter`,
/// then a cylinder.
Tool taper(double tip_radius, double half_angle, double diameter, double length, bool flat_tip = false);
/// A sharp tip, a cone up to `tip_height`, a second cone up to `diameter`, then a cylinder.
Tool cone_end(double tip_half_angle, double tip_height, double half_angle, double diameter, double length);
/// Any profile of lines and arcs, followed by a cylinder up to `length` where it ends below.
Tool profile(std::vector<ProfileSegment> segments, double length);

}  // namespace riffler::cutters
