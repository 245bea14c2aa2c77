// Cutting resistance, estimated from the tool's last motions as a damper for the next step.
#pragma once

#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// A linear damper at the tool's point `arm` from its tip, and an angular damper about that point. Both only oppose
/// motion.
struct Damper {
  Vec3 arm{0};         ///< mm
  double linear = 0;   ///< N·s/mm
  double angular = 0;  ///< N·mm·s/rad
};

/// Travel (mm) over which to average the resistance in a stock of `pitch` (mm). Longer averaging delays the force, by
/// about 1 % of its largest value per 0.05 mm. Shorter averaging is uneven: a wall recedes ray row by ray row, and at a
/// tenth of the pitch, in a slot along the ray rows, a steady cut feels a third too weak. A third of the pitch is a
/// good compromise for all cutters (docs/decisions.md). A ball sunk less than its radius does not need it: its rays
/// enter with zero length, so the pitch has no effect.
double memory_for(double pitch);

/// The removal law gives a force proportional to the volume removed per second. Along one direction this is a damper
/// proportional to the cut area: force = k · area · speed. The area is estimated as volume per travel, over the last
/// `memory` mm of travel rather than over time. The estimate is therefore right where the grid yields volume in
/// portions (a wall recedes by whole rays), and does not change at rest.
class Resistance {
 public:
  /// `memory`: mm, positive. `damping`: N·s/mm, added while cutting.
  Resistance(double memory, double damping) : memory_(memory), damping_(damping) {}

  /// Records a move: the displacement of the tool about its tip at the end; `wrench` on the tool about that tip;
  /// `dt`: s; `reach`: mm from the tip within which the tool cuts. Rotations count as travel at that distance.
  void learn(const Twist& way, const Wrench& wrench, double dt, double reach);
  /// Clears the estimate: call it when the tool is placed elsewhere.
  void forget();

  /// The damper for the next step.
  Damper damper() const { return {arm_, area_.mean() + damping_ * engaged_.mean(), turning_.mean()}; }

 private:
  /// Mean per mm over the last `memory` mm of travel. After less travel the mean covers that travel, so a new cut
  /// counts at once, but at least a fiftieth of `memory`, because a whole row of rays may be cut together.
  struct PerWay {
    double sum = 0, way = 0;

    void add(double amount, double length, double memory);
    double mean() const { return way > 0 ? sum / way : 0; }
  };

  double memory_, damping_;
  PerWay area_, turning_, engaged_;  // N·s/mm, N·mm·s/rad, share of travel spent cutting
  Vec3 arm_{0};
  double idle_ = 0;  // mm of travel since the last cut
};

}  // namespace riffler::haptics
