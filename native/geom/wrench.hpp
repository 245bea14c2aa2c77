// Force and torque together.
#pragma once

#include "geom/vec.hpp"

namespace riffler {

/// N and N·mm, the torque about a point that goes with it.
struct Wrench {
  Vec3 force{0}, torque{0};

  /// The same about `to`, where this is about `from`.
  Wrench about(const Vec3& to, const Vec3& from) const { return {force, torque + glm::cross(from - to, force)}; }
  Wrench operator+(const Wrench& o) const { return {force + o.force, torque + o.torque}; }
  Wrench operator*(double s) const { return {s * force, s * torque}; }
};

inline bool finite(const Wrench& w) {
  return finite(w.force) && finite(w.torque);
}

}  // namespace riffler
