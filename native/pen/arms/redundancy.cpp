#include "pen/arms/redundancy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"

namespace riffler::pen {

namespace {

constexpr double kApart = 0.02;         // rad: smallest difference of a joint between stored postures
constexpr std::size_t kFewest = 12;     // smallest number of postures
constexpr double kExplained = 1.0 / 3;  // of the tolerance: largest remainder of an explanation
constexpr double kClearly = 2;          // factor by which the second-best remainder must be larger
constexpr int kSteps = 30;              // Gauss–Newton steps
constexpr double kConverged = 1e-3;     // counts

/// From the centre of the circle on which joint `joint` moves the end, to the end.
Vec3 arm_of_circle(const ArmLinks& links, const Vec3& angles, const Vec3& end, int joint) {
  const double s1 = base::sin(angles.x), c1 = base::cos(angles.x);
  const auto in_plane = [&](double out, double up) { return Vec3(out * c1, out * s1, up); };
  if (joint == 0) return {end.x, end.y - links.shoulder, 0};
  if (joint == 1) return links.upper * in_plane(base::sin(angles.y), -base::cos(angles.y));
  return links.fore * in_plane(base::cos(angles.z), base::sin(angles.z));
}

/// Smallest angle from `from`, in the given direction (±1), at which the cosine is `c`; infinite if there is none.
double way_to_cosine(double from, double way, double c) {
  if (!(std::abs(c) <= 1)) return kInfinity;
  double least = kInfinity;
  for (const double at : {base::acos(c), -base::acos(c)}) {
    const double turn = std::fmod(way * (at - from), kTwoPi);
    least = std::min(least, turn < 0 ? turn + kTwoPi : turn);
  }
  return least;
}

}  // namespace

GripCheck check_grip(const PenKinematics& pen, const PenPosture& posture) noexcept {
  const double stretch = posture.length - pen.geometry().grip_length;
  return {stretch, std::abs(stretch) <= pen.geometry().grip_tolerance};
}

std::array<NoticedCounts, kPenChannels> noticed_counts(const PenKinematics& pen, const PenPosture& posture) noexcept {
  const PenGeometry& g = pen.geometry();
  std::array<NoticedCounts, kPenChannels> out{};
  if (!check_grip(pen, posture).fits) return out;
  const double shortest = g.grip_length - g.grip_tolerance, longest = g.grip_length + g.grip_tolerance;
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = g.channels[k];
    const std::size_t arm = index(c.arm);
    const ArmPosture& moved = posture.arms[arm];
    // On its circle the end is centre + q cos δ + t sin δ, and its squared distance from the other end is K − 2 M cos(δ
    // − φ).
    const Vec3 q = arm_of_circle(g.arms[arm], posture.angles[arm], moved.end, c.joint), t = moved.jacobian[c.joint];
    const Vec3 other = posture.arms[1 - arm].end - moved.end + q;
    const double p = glm::dot(other, q), s = glm::dot(other, t), m = geom::hypot(p, s), phase = base::atan2(s, p);
    const double sum = glm::dot(other, other) + glm::dot(q, q);
    const auto counts = [&](double way) {
      const double angle = std::min(way_to_cosine(-phase, way, (sum - longest * longest) / (2 * m)),
                                    way_to_cosine(-phase, way, (sum - shortest * shortest) / (2 * m)));
      return angle * c.steps / kTwoPi;
    };
    out[k] = {counts(-c.sign), counts(c.sign)};
  }
  return out;
}

void GripDiagnosis::add(const PenPosture& posture) noexcept {
  if (size_ > 0) {
    const JointAngles& last = angles_[(size_ - 1) % kKept];
    double most = 0;
    for (std::size_t arm = 0; arm < 2; ++arm)
      for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(posture.angles[arm][k] - last[arm][k]));
    if (!(most >= kApart)) return;
  }
  if (!std::isfinite(posture.length)) return;
  angles_[size_ % kKept] = posture.angles;
  // Beyond twice the capacity only the remainder matters.
  if (++size_ == 3 * kKept) size_ = 2 * kKept;
}

/// Fits by Gauss–Newton.
GripDiagnosis::Fit GripDiagnosis::fit_from(std::size_t channel, double counts) const noexcept {
  const PenGeometry& g = pen_->geometry();
  const PenChannel& c = g.channels[channel];
  // Rotation of this channel's joint per count, and the correction of the joint by `counts`.
  const double turn = c.sign / c.steps * kTwoPi;
  for (int step = 0;; ++step) {
    double squares = 0, slopes = 0, both = 0;
    for (std::size_t k = 0; k < postures(); ++k) {
      JointAngles angles = angles_[k];
      angles[index(c.arm)][c.joint] -= turn * counts;
      const PenPosture posture = pen_->posture(angles);
      const double stretch = posture.length - g.grip_length;
      const double growth = glm::dot(posture.apart, posture.arms[index(c.arm)].jacobian[c.joint]);
      const double slope = posture.length > 0 ? (c.arm == Arm::L ? -turn : turn) * growth / posture.length : 0;
      squares += stretch * stretch, slopes += slope * slope, both += slope * stretch;
    }
    const Fit now{std::sqrt(squares / static_cast<double>(postures())), counts};
    // At most a twentieth of a turn per step: the circles are straight only locally.
    const double change = slopes > 0 ? std::clamp(-both / slopes, -c.steps / 20, c.steps / 20) : 0;
    if (step == kSteps || std::abs(change) < kConverged) return now;
    counts += change;
  }
}

GripDiagnosis::Fit GripDiagnosis::fit(std::size_t channel) const noexcept {
  Fit best{kInfinity, 0};
  // Several starts, because over large rotations there are other minima.
  for (const double turns : {0.0, -0.04, 0.04, -0.1, 0.1}) {
    const Fit one = fit_from(channel, turns * pen_->geometry().channels[channel].steps);
    if (one.left < best.left) best = one;
  }
  return best;
}

GripVerdict GripDiagnosis::verdict() const noexcept {
  const PenGeometry& g = pen_->geometry();
  GripVerdict out;
  if (postures() < kFewest) return out;
  bool fits = true;
  for (std::size_t k = 0; k < postures(); ++k) fits = fits && check_grip(*pen_, pen_->posture(angles_[k])).fits;
  out.left = kInfinity;
  double second = kInfinity;
  for (std::size_t channel = 0; channel < kPenChannels; ++channel) {
    const Fit one = fit(channel);
    if (one.left < out.left) {
      second = out.left;
      out.left = one.left, out.channel = channel, out.counts = one.counts;
    } else {
      second = std::min(second, one.left);
    }
  }
  if (fits)
    out.fault = GripFault::None;
  else if (out.left > kExplained * g.grip_tolerance)
    out.fault = GripFault::Several;
  else
    out.fault = second > kClearly * out.left ? GripFault::Channel : GripFault::Unclear;
  return out;
}

}  // namespace riffler::pen
