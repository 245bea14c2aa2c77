// Hand tools: unions of convex polytopes, moved by poses with a roll.
#pragma once

#include <vector>

#include "riffler/tool/tool.hpp"

namespace riffler::tool::hand_tools {

/// Frame: z from the tip to the handle, x the cutting direction, y across; the tip lies at the origin. Lengths in mm,
/// angles in rad. Each function throws std::invalid_argument naming the size that is not positive and finite or does
/// not fit.

/// The union of the convex hulls of lists of points.
Tool convex(const std::vector<std::vector<Vec3>>& hulls);
/// A flat blade. Its edge of `width` lies across the tip; `bevel` is the angle between the flat front and the ground
/// face behind it. `skew` turns the edge about x.
Tool chisel(double width, double thickness, double bevel, double length, double skew = 0);
/// A sweep of `radius`, with `width` between its rims. The section is filled up to the rims, so that the chip is taken
/// out. The arc is a polygon in it: within kArcTolerance, of at most kArcSides sides.
Tool gouge(double width, double radius, double bevel, double length);
/// Two blades that meet at `angle`, filled up to the rims, with `width` between them.
Tool v_tool(double angle, double width, double bevel, double length);
/// A blade of `width` and `thickness` whose edge, with `edge_angle` between its two sides, leads from the tip along
/// the cutting direction.
Tool knife(double width, double thickness, double edge_angle, double length);

inline constexpr double kArcTolerance = 0.01;  // mm
inline constexpr int kArcSides = 24;

}  // namespace riffler::tool::hand_tools

namespace riffler {
namespace hand_tools = tool::hand_tools;
}  // namespace riffler
