// A convex polytope: one of the bodies that a hand tool is the union of.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::tool {

/// A half-space n · p ≤ offset, with a unit normal out of the body.
struct HalfSpace {
  Vec3 normal;
  double offset;  ///< mm
};

/// In the tool's frame: z from the tip to the handle, x the cutting direction, y across; mm.
struct Hull {
  std::vector<Vec3> vertices;    ///< the corners, in the order of the points that the hull was made from
  std::vector<HalfSpace> faces;  ///< one for each face; the body is where all of them hold
  double reach = 0;              ///< mm, largest distance of a vertex from the tip
  double size = 0;               ///< mm, largest distance between two vertices

  static constexpr std::size_t kMostPoints = 128;
  static constexpr double kLargest = 1e6;    ///< mm; beyond it, rounding errors are not small against a tolerance
  static constexpr double kFlattest = 1e-6;  ///< least thickness, as a share of the size
};

/// The convex hull of points, mm. Points within 1e-10 of the size of a plane share its face; points inside are left
/// out. Throws std::invalid_argument beginning with `name`: fewer than four or more than kMostPoints points, one that
/// is not finite or beyond kLargest, or a body that is thinner than kFlattest of its size, such as points in a plane.
Hull make_hull(std::span<const Vec3> points, const std::string& name);

}  // namespace riffler::tool
