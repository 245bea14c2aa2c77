// What the material did against the tool's last motions, as a damper that the next one can be solved with.
#pragma once

#include "haptics/wrench.hpp"

namespace riffler {

/// A damper for the tool's point at `arm` from its tip, and one for turns about that point. Both pull back only.
struct Damper {
  Vec3 arm{0};         ///< mm
  double linear = 0;   ///< N·s/mm
  double angular = 0;  ///< N·mm·s/rad
};

/// The removal law's force is the volume removed per second times a constant. Along one direction that is a damper
/// whose constant is the area that the tool cuts: force = k · area · speed. The area is learnt as volume per way, over
/// the last `memory` mm of way and not over time, so that it is also right where a grid gives volume in portions (a
/// wall moves by whole rays), and at rest nothing is learnt or forgotten.
class Resistance {
 public:
  /// memory: mm, positive. damping: N·s/mm, added where it cuts.
  Resistance(double memory, double damping) : memory_(memory), damping_(damping) {}

  /// A move of dt seconds: how far the tool went, about its tip at the end, and the wrench on it there. `reach`: mm
  /// from the tip within which it cuts; turns are counted as way at that distance.
  void learn(const Twist& way, const Wrench& wrench, double dt, double reach);
  /// The tool is elsewhere.
  void forget() { impulse_ = turning_ = engaged_ = 0, arm_ = Vec3(0); }

  Damper damper() const { return {arm_, impulse_ + damping_ * engaged_, turning_}; }

 private:
  double memory_, damping_;
  double impulse_ = 0, turning_ = 0, engaged_ = 0;  // N·s/mm, N·mm·s/rad, share of the way
  Vec3 arm_{0};
};

}  // namespace riffler
