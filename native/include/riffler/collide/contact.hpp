// The result of a contact query: force, torque, depth and contact points.
#pragma once

#include <array>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::collide {

/// What is in contact: a part of the tool that touches the part, or a fixture, which any part of the tool may touch.
enum class Touch : unsigned char { Cutter, Shank, Holder, Fixture };

/// Operation counts of a query.
struct Counts {
  std::size_t nodes = 0;      ///< bounding spheres visited
  std::size_t triangles = 0;  ///< triangles tested one by one
  std::size_t cells = 0;      ///< evaluations of the tool's distance on triangles
  std::size_t points = 0;     ///< sample points of the force
  std::size_t boxes = 0;      ///< boxes of fixture material tested one by one
};

/// Decrease of force (N) and torque about the tip (N·mm) per small displacement of the tool: translation of the tip
/// (mm), then rotation vector (rad). Symmetric; sliding along the surfaces meets no resistance.
using ContactStiffness = std::array<std::array<double, 6>, 6>;

/// Force and torque that act on the tool. All values are in the part frame.
struct Contact {
  Vec3 force{0};   ///< N, directed out of the obstacle
  Vec3 torque{0};  ///< N·mm, about the tip
  /// A point of the part contributes k times its area along its normal: the derivative of its force where the tool's
  /// surface is tangent to the part's. A fixture contributes k times the area of the tool's surface inside it, along
  /// the force and along the tool's normal: twice the derivative where these agree, and never less than its symmetric
  /// part.
  ContactStiffness stiffness{};
  /// max(0, −clearance) over part and fixtures, mm; the true depth is at most `depth` + `missed_depth_bound`.
  double depth = 0;
  /// Bound on the depth that the search missed, mm. Without a budget this is rounding, 1e-10 mm and more far from the
  /// origin, but up to 1e-3 mm deep inside a tool where three of its surfaces are equally near and proving less would
  /// take very long. The clock is read at every eighth search step, so a short budget may be exceeded.
  double missed_depth_bound = 0;
  double checked = 1;          ///< share of the candidates that were examined, 0 to 1
  std::vector<Vec3> points;    ///< contact points, deepest first; empty without contact
  std::vector<Touch> touches;  ///< one per entry of `points`

  /// Adds the force `pushing` (N) at a point of the tool that lies `arm` (mm) from its tip.
  void push(const Vec3& arm, const Vec3& pushing) { force += pushing, torque += glm::cross(arm, pushing); }
  /// Adds a stiffness `per_mm` (N/mm) against motion of that point along the unit vector `direction`.
  void resist(const Vec3& arm, const Vec3& direction, double per_mm);
};

inline void Contact::resist(const Vec3& arm, const Vec3& direction, double per_mm) {
  const Vec3 m = glm::cross(arm, direction);
  const double w[6] = {direction.x, direction.y, direction.z, m.x, m.y, m.z};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) stiffness[i][j] += per_mm * w[i] * w[j];
}

}  // namespace riffler::collide
