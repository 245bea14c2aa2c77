// What the material did against the tool's last motions, as a damper that the next one can be solved with.
#pragma once

#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// A damper for the tool's point at `arm` from its tip, and one for turns about that point. Both pull back only.
struct Damper {
  Vec3 arm{0};         ///< mm
  double linear = 0;   ///< N·s/mm
  double angular = 0;  ///< N·mm·s/rad
};

/// mm of way over which resistance is best learnt in a stock of that pitch. Of a longer way the force comes late, by
/// about 1 % of the largest for 0.05 mm; a wall falls by rows of rays, and within a tenth of the pitch, in a slot along
/// the rays' rows, a steady cut is felt by a third too weakly. A third of the pitch costs little of either for all
/// cutters (docs/decisions.md). A ball that is sunk less than its radius would not need it: its rays come in from no
/// length, and no pitch matters to it.
double memory_for(double pitch);

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
  void forget();

  Damper damper() const { return {arm_, area_.mean() + damping_ * engaged_.mean(), turning_.mean()}; }

 private:
  /// Mean per way over the last `memory` of it. A mean of less way than that is of this way alone, so what begins is
  /// known at once; but never of less than a fiftieth, in which one row of rays may have come together.
  struct PerWay {
    double sum = 0, way = 0;

    void add(double amount, double length, double memory);
    double mean() const { return way > 0 ? sum / way : 0; }
  };

  double memory_, damping_;
  PerWay area_, turning_, engaged_;  // N·s/mm, N·mm·s/rad, share of the way
  Vec3 arm_{0};
  double idle_ = 0;  // mm without a cut
};

}  // namespace riffler::haptics
