// A guide: what a tool cannot leave while a hand turns it.
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// For each axis of the tool the guide has one place, or a curve of places. Functions are for one thread; none of them
/// waits or allocates.
class Guide {
 public:
  /// The displacements that the guide leaves to a tool.
  struct Freedoms {
    std::array<Twist, 2> turns;  ///< about two perpendiculars of the axis, by one radian
    Twist slide;                 ///< along the curve, by one mm
    double back = 0, on = 0;     ///< mm to the curve's ends against and along `slide`; both 0: the tool does not slide
  };
  virtual ~Guide() = default;

  /// The pose on the guide that is nearest to `wanted`, searched from the last one: with the same axis, or with the
  /// last axis if the guide has no place for the wanted one.
  virtual Pose settled(const Pose& wanted) noexcept = 0;
  /// At the last settled pose.
  virtual Freedoms freedoms() const noexcept = 0;
};

}  // namespace riffler::haptics
