// Six encoders measure five degrees of freedom: the sixth number is the grip's length, which is known. Where it does
// not come out, a count was lost or the homing was bad.
#pragma once

#include <array>

#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

struct GripCheck {
  double stretch = 0;  // mm: |r_L − r_R| less the grip's length
  bool fits = false;   // within the grip's tolerance
};

GripCheck check_grip(const PenKinematics& pen, const PenPosture& posture) noexcept;

/// How many counts too few and too many of one channel alone, all else right, are the first to be noticed in this
/// posture, not rounded: beyond them check_grip no longer fits. Infinite where no number of them is: joints that move
/// the end square to the grip change its length in the second order only, and some not at all. Exact: joints move the
/// ends on circles. A posture that does not fit has zeros.
struct NoticedCounts {
  double few = 0, many = 0;
};
std::array<NoticedCounts, kPenChannels> noticed_counts(const PenKinematics& pen, const PenPosture& posture) noexcept;

enum class GripFault : unsigned char {
  None,     // the grip fits in all postures
  Channel,  // one channel's counter is wrong, by a constant number of counts that explains all postures
  Several,  // no single channel explains them: bad homing, or another pen's geometry
  Unclear,  // too few postures, or too alike: move the pen
};

struct GripVerdict {
  GripFault fault = GripFault::Unclear;
  std::size_t channel = 0;  // of GripFault::Channel
  double counts = 0;        // by which it reads too many
  double left = 0;          // mm, root mean square: what the best explanation leaves of the stretch
};

/// Collects postures after a misfit, to find which counter it is: one posture cannot tell, since any channel that moves
/// the ends apart explains it; different ones can. Only postures that differ are kept, the last ones.
class GripDiagnosis {
 public:
  explicit GripDiagnosis(const PenKinematics& pen) noexcept : pen_(&pen) {}

  void clear() noexcept { size_ = 0; }
  /// Allocates nothing. `pen` must be homed as when the postures were taken.
  void add(const PenPosture& posture) noexcept;
  std::size_t postures() const noexcept { return size_ < kKept ? size_ : kKept; }
  /// Up to some milliseconds: not for the haptic step.
  GripVerdict verdict() const noexcept;

 private:
  static constexpr std::size_t kKept = 64;

  struct Fit {
    double left, counts;
  };
  /// Root mean square of the stretch with `counts` taken from one channel, for the best number of them.
  Fit fit(std::size_t channel) const noexcept;
  Fit fit_from(std::size_t channel, double counts) const noexcept;

  const PenKinematics* pen_;
  std::array<JointAngles, kKept> angles_{};
  std::size_t size_ = 0;  // ever added
};

}  // namespace riffler::pen
