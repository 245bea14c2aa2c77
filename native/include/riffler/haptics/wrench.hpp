// Wrench and twist: six coordinates about one pivot. Capability: which coordinates a device can push.
#pragma once

#include <array>

#include "riffler/geom/vec.hpp"

namespace riffler::haptics {

/// Three translations, then three rotations, along the axes of the part frame.
inline constexpr int kCoordinates = 6;

/// Force (N) and torque (N·mm) about a pivot that the context names.
struct Wrench {
  Vec3 force{0}, torque{0};

  double operator[](int k) const { return k < 3 ? force[k] : torque[k - 3]; }
  double& operator[](int k) { return k < 3 ? force[k] : torque[k - 3]; }
  friend Wrench operator+(const Wrench& a, const Wrench& b) { return {a.force + b.force, a.torque + b.torque}; }
  friend Wrench operator-(const Wrench& a, const Wrench& b) { return {a.force - b.force, a.torque - b.torque}; }
  friend Wrench operator-(const Wrench& a) { return {-a.force, -a.torque}; }
  friend Wrench operator*(double s, const Wrench& a) { return {s * a.force, s * a.torque}; }
  friend bool operator==(const Wrench& a, const Wrench& b) { return a.force == b.force && a.torque == b.torque; }
};

/// Velocity (mm/s) of the body's material point at the pivot, and angular velocity (rad/s). For a tick: displacement in
/// mm and rotation vector in rad.
struct Twist {
  Vec3 linear{0}, angular{0};

  double operator[](int k) const { return k < 3 ? linear[k] : angular[k - 3]; }
  double& operator[](int k) { return k < 3 ? linear[k] : angular[k - 3]; }
  friend Twist operator+(const Twist& a, const Twist& b) { return {a.linear + b.linear, a.angular + b.angular}; }
  friend Twist operator-(const Twist& a, const Twist& b) { return {a.linear - b.linear, a.angular - b.angular}; }
  friend Twist operator*(double s, const Twist& a) { return {s * a.linear, s * a.angular}; }
};

/// Power (N·mm/s) that the wrench delivers to a body with this twist, or work (N·mm) for a displacement. Both about the
/// same pivot.
inline double power(const Wrench& w, const Twist& t) {
  return glm::dot(w.force, t.linear) + glm::dot(w.torque, t.angular);
}

/// The same wrench or twist about another pivot, `to`.
inline Wrench moved(const Wrench& w, const Vec3& from, const Vec3& to) {
  return {w.force, w.torque + glm::cross(from - to, w.force)};
}
inline Twist moved(const Twist& t, const Vec3& from, const Vec3& to) {
  return {t.linear + glm::cross(t.angular, to - from), t.angular};
}

inline bool finite(const Wrench& w) {
  return geom::finite(w.force) && geom::finite(w.torque);
}
inline bool finite(const Twist& t) {
  return geom::finite(t.linear) && geom::finite(t.angular);
}

/// Coordinates that a device can push: forces along three orthogonal axes and torques about them. The axes may turn
/// with the grip. The pen pushes all but the torque about its own axis: its third column of `axes` is the grip's axis.
struct Capability {
  std::array<bool, kCoordinates> push{true, true, true, true, true, true};
  Mat3 axes{1};  ///< orthonormal; columns in the part frame

  friend bool operator==(const Capability&, const Capability&) = default;
};

/// The part of the wrench that the device can render: the projection onto the coordinates it pushes.
inline Wrench renderable(const Capability& device, const Wrench& w) {
  Wrench out;
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = device.axes[k];
    if (device.push[static_cast<std::size_t>(k)]) out.force += glm::dot(w.force, axis) * axis;
    if (device.push[static_cast<std::size_t>(k + 3)]) out.torque += glm::dot(w.torque, axis) * axis;
  }
  return out;
}

}  // namespace riffler::haptics

namespace riffler {
using haptics::Twist;
using haptics::Wrench;
}  // namespace riffler
