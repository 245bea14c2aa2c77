// Six encoders measure five degrees of freedom: the sixth value is the grip's length, which is known. If it comes out
// wrong, a count was lost or the homing was bad.
#pragma once

#include <array>

#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

struct GripCheck {
  double stretch = 0;  // mm: |r_L − r_R| minus the grip's length
  bool fits = false;   // within the grip's tolerance
};

GripCheck check_grip(const PenKinematics& pen, const PenPosture& posture) noexcept;

/// The smallest number of missing and of excess counts on a single channel that check_grip detects in this posture, not
/// rounded. Infinite if no number is detected: joints that move the end perpendicular to the grip change its length
/// only to second order, and some not at all. Exact: joints move the ends on circles. Zero for a posture that does not
/// fit.
struct NoticedCounts {
  double few = 0, many = 0;
};
std::array<NoticedCounts, kPenChannels> noticed_counts(const PenKinematics& pen, const PenPosture& posture) noexcept;

enum class GripFault : unsigned char {
  None,     // the grip fits in all postures
  Channel,  // one channel is off by a constant number of counts that explains all postures
  Several,  // no single channel explains them: bad homing, or the geometry of another pen
  Unclear,  // too few or too similar postures: move the pen
};

struct GripVerdict {
  GripFault fault = GripFault::Unclear;
  std::size_t channel = 0;  // for GripFault::Channel
  double counts = 0;        // excess counts of that channel
  double left = 0;          // mm, root mean square: stretch left by the best explanation
};

/// Collects postures after a misfit to find the faulty counter. One posture cannot identify it, because any channel
/// that moves the ends apart explains it; different postures can. Keeps only postures that differ, the latest ones.
class GripDiagnosis {
 public:
  explicit GripDiagnosis(const PenKinematics& pen) noexcept : pen_(&pen) {}

  void clear() noexcept { size_ = 0; }
  /// Allocates nothing. `pen` must be homed as when the postures were taken.
  void add(const PenPosture& posture) noexcept;
  std::size_t postures() const noexcept { return size_ < kKept ? size_ : kKept; }
  /// Takes up to some milliseconds: not for the haptic step.
  GripVerdict verdict() const noexcept;

 private:
  static constexpr std::size_t kKept = 64;

  struct Fit {
    double left, counts;
  };
  /// Root mean square of the stretch after the best correction `counts` of one channel.
  Fit fit(std::size_t channel) const noexcept;
  Fit fit_from(std::size_t channel, double counts) const noexcept;

  const PenKinematics* pen_;
  std::array<JointAngles, kKept> angles_{};
  std::size_t size_ = 0;  // number of postures added so far
};

}  // namespace riffler::pen
