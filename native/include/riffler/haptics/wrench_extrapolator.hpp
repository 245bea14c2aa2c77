// Replacement wrench for a tick whose step is not done in time.
#pragma once

#include "riffler/haptics/settings.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Times and limits of the extrapolation.
struct WrenchExtrapolatorSettings {
  double ahead = 2e-3;          ///< s for which the last trend continues after a step, decelerating
  double fade = 20e-3;          ///< s after the last step at which the wrench reaches zero
  Bounds rate{2'000, 120'000};  ///< N/s, N·mm/s: largest rate of the output
  Bounds most{5, 300};          ///< N, N·mm: largest extrapolated wrench, also of its terms

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Without a new step the wrench continues from the last two and fades to zero. With the next step it turns from there
/// towards the new value. It never changes faster than `rate`, so steps may fail and return in any order.
class WrenchExtrapolator {
 public:
  /// Throws std::invalid_argument for invalid settings.
  explicit WrenchExtrapolator(const WrenchExtrapolatorSettings& settings = {});

  /// Output for a tick with a step's wrench, `dt` s after the last tick. For dt ≤ 0 or a wrench that is not finite: as
  /// `missed`.
  Wrench stepped(const Wrench& wrench, double dt);
  /// Output for a tick without a step, `dt` s after the last tick.
  Wrench missed(double dt);
  /// Time since the last step, s.
  double age() const { return age_; }
  /// Forgets all steps; the output starts from zero.
  void reset();

 private:
  Wrench towards(const Wrench& goal, double dt);

  WrenchExtrapolatorSettings settings_;
  Wrench out_, last_, slope_;  // slope: per second, between the last two steps
  double age_ = 0;
  bool begun_ = false;
};

}  // namespace riffler::haptics
