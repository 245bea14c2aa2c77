// What the hand is given in a tick whose step is not done in time.
#pragma once

#include "riffler/haptics/settings.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

struct WrenchExtrapolatorSettings {
  double ahead = 2e-3;          ///< s for which the last change goes on after a step, ever slower
  double fade = 20e-3;          ///< s after the last step at which the wrench is gone
  Bounds rate{2'000, 120'000};  ///< N/s, N·mm/s: no more of a change than this goes on, or comes with the next step
  Bounds most{5, 300};          ///< N, N·mm: neither what is held over nor its parts grow beyond

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// Without a new step the wrench goes on from the last two and comes to nothing; with the next one it turns towards
/// that from where it is. It never changes faster than `rate`: ticks and steps may fail and come back in any order.
class WrenchExtrapolator {
 public:
  /// Validates.
  explicit WrenchExtrapolator(const WrenchExtrapolatorSettings& settings = {});

  /// A tick with the step's wrench, dt s after the last tick. dt ≤ 0, or a wrench that is not finite, is as `missed`.
  Wrench stepped(const Wrench& wrench, double dt);
  /// A tick without.
  Wrench missed(double dt);
  /// s since the last step.
  double age() const { return age_; }
  void reset();

 private:
  Wrench towards(const Wrench& goal, double dt);

  WrenchExtrapolatorSettings settings_;
  Wrench out_, last_, slope_;  // slope: per second, between the last two steps
  double age_ = 0;
  bool begun_ = false;
};

}  // namespace riffler::haptics
