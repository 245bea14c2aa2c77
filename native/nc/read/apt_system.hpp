// MSYS of NX's cutter location files: the coordinate system of the following points.
#pragma once

#include <optional>

#include "nc/source.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Keeps points in the first system; until another one is set they stay bit-identical.
class AptSystem {
 public:
  /// Sets the system of the following coordinates: `origin` and unit axes `x` and `y`, given in mm in the common
  /// reference system. Throws FormatError if the axes are not perpendicular.
  void use(const Vec3& origin, const Vec3& x, const Vec3& y, const NcPlace& place);

  Vec3 in_first(const Vec3& point) const { return moved_ ? turn_ * point + shift_ : point; }
  Vec3 from_first(const Vec3& point) const { return moved_ ? glm::transpose(turn_) * (point - shift_) : point; }
  /// Rotates a unit vector into the first system.
  Vec3 turned(const Vec3& axis) const { return moved_ ? glm::normalize(turn_ * axis) : axis; }

 private:
  struct System {
    Mat3 axes;
    Vec3 origin;
  };
  std::optional<System> first_;
  Mat3 turn_{1};  // from the current system to the first
  Vec3 shift_{0};
  bool moved_ = false;
};

}  // namespace riffler::nc
