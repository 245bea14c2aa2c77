// What a tool meets at a pose.
#pragma once

#include <array>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::collide {

/// What of the assembly touches the part, or that it is a fixture which is touched, by whatever piece.
enum class Touch : unsigned char { Cutter, Shank, Holder, Fixture };

/// Work that a call did.
struct Counts {
  std::size_t nodes = 0;      ///< bounding spheres looked at
  std::size_t triangles = 0;  ///< looked at by themselves
  std::size_t cells = 0;      ///< places on triangles where the tool's distance was taken
  std::size_t points = 0;     ///< sample points of the force
  std::size_t boxes = 0;      ///< of the material of fixtures, looked at by themselves
};

/// How force (N) and torque about the tip (N·mm) fall when the tool is moved by a small displacement: its translation
/// at the tip (mm), then its rotation vector (rad). Symmetric; nothing resists what slides along the surfaces.
using ContactStiffness = std::array<std::array<double, 6>, 6>;

/// Force and torque act on the tool. All in the part frame.
struct Contact {
  Vec3 force{0};   ///< N, out of what is touched
  Vec3 torque{0};  ///< N·mm, about the tip
  /// Of a point of the part k times its area along its normal: the derivative of its force where the tool's surface
  /// runs along the part's. Of a fixture k times the area of the tool's surface in it, along the force and along the
  /// tool's normal: twice the derivative where both agree, and no less than what of it is symmetric anywhere.
  ContactStiffness stiffness{};
  /// max(0, −clearance) over part and fixtures, mm; the true depth is at most `depth` + `missed_depth_bound`.
  double depth = 0;
  /// Without a budget rounding, 1e-10 mm and more far from the origin; up to about 1e-3 mm deep in a tool where three
  /// of its surfaces are equally near, where the search ends by its count of cells. The clock is read at every
  /// eighth step of a search, so short budgets may be exceeded.
  double missed_depth_bound = 0;
  double checked = 1;          ///< share of the candidates that was looked at
  std::vector<Vec3> points;    ///< contact points, the deepest first; empty where nothing touches
  std::vector<Touch> touches;  ///< of the points

  /// Adds a force on the tool's point that is `arm` away from its tip.
  void push(const Vec3& arm, const Vec3& pushing) { force += pushing, torque += glm::cross(arm, pushing); }
  /// Adds what that point's motion along a direction meets, N/mm.
  void resist(const Vec3& arm, const Vec3& direction, double per_mm);
};

inline void Contact::resist(const Vec3& arm, const Vec3& direction, double per_mm) {
  const Vec3 m = glm::cross(arm, direction);
  const double w[6] = {direction.x, direction.y, direction.z, m.x, m.y, m.z};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) stiffness[i][j] += per_mm * w[i] * w[j];
}

}  // namespace riffler::collide
