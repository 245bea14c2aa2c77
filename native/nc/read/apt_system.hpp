// MSYS of NX's cutter location files: the system that the coordinates after it are in.
#pragma once

#include <optional>

#include "nc/source.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Points are kept in the first system; until another one comes they stay what they are, to the bit.
class AptSystem {
 public:
  /// From here on coordinates are about `origin` along unit axes `x` and `y`, given in mm in what all systems of the
  /// file are given in. FormatError where the axes are not at right angles.
  void use(const Vec3& origin, const Vec3& x, const Vec3& y, const NcPlace& place);

  Vec3 in_first(const Vec3& point) const { return moved_ ? turn_ * point + shift_ : point; }
  Vec3 from_first(const Vec3& point) const { return moved_ ? glm::transpose(turn_) * (point - shift_) : point; }
  /// A unit vector.
  Vec3 turned(const Vec3& axis) const { return moved_ ? glm::normalize(turn_ * axis) : axis; }

 private:
  struct System {
    Mat3 axes;
    Vec3 origin;
  };
  std::optional<System> first_;
  Mat3 turn_{1};  // from the system at hand into the first
  Vec3 shift_{0};
  bool moved_ = false;
};

}  // namespace riffler::nc
