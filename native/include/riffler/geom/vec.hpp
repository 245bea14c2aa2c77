// Vectors, matrices and boxes: GLM in double precision, under the names that the rest of the core uses.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <limits>

namespace riffler::geom {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec3f = glm::vec3;
using Vec3i = glm::ivec3;
using Mat3 = glm::dmat3;

/// Axis-aligned box. The default box is empty (`lower > upper`); adding a point to it gives that point.
struct Box3 {
  Vec3 lower{std::numeric_limits<double>::infinity()};
  Vec3 upper{-std::numeric_limits<double>::infinity()};

  bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
  void add(const Vec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
  void add(const Box3& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
  /// The box with every side moved outward by d.
  Box3 grown(double d) const { return {lower - Vec3(d), upper + Vec3(d)}; }
  Vec3 size() const { return upper - lower; }
  /// Whether the closed boxes have a common point.
  bool overlaps(const Box3& b) const {
    return lower.x <= b.upper.x && b.lower.x <= upper.x && lower.y <= b.upper.y && b.lower.y <= upper.y &&
           lower.z <= b.upper.z && b.lower.z <= upper.z;
  }
};

/// Whether all components are finite.
inline bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline double squared_length(const Vec3& v) {
  return glm::dot(v, v);
}

/// Returns `v`, shortened to length `max` if it is longer.
inline Vec3 clamp_length(const Vec3& v, double max) {
  const double length = glm::length(v);
  return length > max ? max / length * v : v;
}

/// The three ray directions. A grid of direction D works in the *cyclic frame* of D, local (u, v, w) with w along the
/// ray: "x" → (y, z, x), "y" → (z, x, y), "z" → (x, y, z). The change of frame is a rotation, so it keeps handedness.
enum class Axis : unsigned char { X = 0, Y = 1, Z = 2 };

/// World → cyclic frame of `axis`.
inline Vec3 to_local(Axis axis, const Vec3& p) {
  switch (axis) {
    case Axis::X:
      return {p.y, p.z, p.x};
    case Axis::Y:
      return {p.z, p.x, p.y};
    default:
      return p;
  }
}

/// Cyclic frame of `axis` → world.
inline Vec3 to_world(Axis axis, const Vec3& p) {
  switch (axis) {
    case Axis::X:
      return {p.z, p.x, p.y};
    case Axis::Y:
      return {p.y, p.z, p.x};
    default:
      return p;
  }
}

/// The box in the cyclic frame of `axis`.
inline Box3 to_local(Axis axis, const Box3& b) {
  return {to_local(axis, b.lower), to_local(axis, b.upper)};
}

}  // namespace riffler::geom

namespace riffler {
using geom::Axis;
using geom::Box3;
using geom::Mat3;
using geom::Vec2;
using geom::Vec3;
using geom::Vec3f;
using geom::Vec3i;
}  // namespace riffler
