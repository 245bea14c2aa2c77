#include "riffler/pen/passivity_settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

namespace {

/// Bounds of one arm's Jacobian over all its postures. Column 1 is perpendicular to the arm's plane, with the end's
/// distance from the vertical axis as length. Columns 2 and 3 lie in the plane, with the links' lengths, at an angle
/// given by the elbow.
struct ArmBounds {
  std::array<double, 3> lever{};  // mm: largest length of each column
  double skew = 0;                // largest |cos| of the angle between columns 2 and 3
};

ArmBounds bounds_of(const PenGeometry& pen, Arm arm) {
  constexpr double kRight = kPi / 2;
  const ArmLinks& links = pen.arms[index(arm)];
  const auto sine = [&](double elbow) { return base::sin(std::clamp(elbow, -kRight, kRight)); };
  const double low = sine(pen.elbow_low), high = sine(pen.elbow_high);
  // The end's distance from the shoulder, an upper bound of that from the axis: c² = a² + b² + 2 a b sin(θ2 − θ3).
  const double a = links.upper, b = links.fore;
  return {{std::sqrt(a * a + b * b + 2 * a * b * high), a, b}, std::max(std::abs(low), std::abs(high))};
}

/// Properties of three joints in order: N·mm·s/rad or N·mm at each, and rad per count.
struct ArmTraits {
  std::array<double, 3> viscous{}, coulomb{}, step{};
};

ArmTraits traits_of(const PenGeometry& pen, Arm arm) {
  ArmTraits out;
  for (const PenChannel& c : pen.channels) {
    if (c.arm != arm) continue;
    const auto j = static_cast<std::size_t>(c.joint);
    out.viscous[j] = c.viscous * c.ratio * c.ratio;
    out.coulomb[j] = c.coulomb * c.ratio;
    out.step[j] = 2 * kPi / c.steps;
  }
  return out;
}

double over(double length, double loss) {
  return loss > 0 ? length / loss : std::numeric_limits<double>::infinity();
}

/// Guaranteed damping (N·s/mm) of the end in every direction: the smallest eigenvalue of J⁻ᵀ C J⁻¹, the inverse of the
/// largest of J C⁻¹ Jᵀ. In the plane, J C⁻¹ Jᵀ is the sum of two outer products, with the eigenvalues of their Gram
/// matrix.
double damping(const ArmBounds& arm, const ArmTraits& joints) {
  const auto& [upright, second, third] = arm.lever;
  const double out = over(upright * upright, joints.viscous[0]);
  const double p = over(second * second, joints.viscous[1]), q = over(third * third, joints.viscous[2]);
  const double apart = p - q, in = 0.5 * (p + q + std::sqrt(apart * apart + 4 * p * q * arm.skew * arm.skew));
  const double most = std::max(out, in);
  return std::isfinite(most) ? 1 / most : 0;
}

/// Force (N) needed to move the end in any direction: |v| = |J q̇| ≤ Σ |J_k| |q̇_k| ≤ max(|J_k| / f_k) Σ f_k |q̇_k|.
double friction(const ArmBounds& arm, const ArmTraits& joints) {
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) most = std::max(most, over(arm.lever[k], joints.coulomb[k]));
  return std::isfinite(most) ? 1 / most : 0;
}

/// Uncertainty (mm) of the end along any direction if all three joints are known to one count.
double resolution(const ArmBounds& arm, const ArmTraits& joints) {
  return geom::hypot(arm.lever[0] * joints.step[0], arm.lever[1] * joints.step[1] + arm.lever[2] * joints.step[2]);
}

/// s: one USB frame out, one frame in which the motors apply it, and one for the report
/// (pen/simulated/simulated_cable.hpp).
constexpr double kLatency = 2e-3;

}  // namespace

haptics::PassivitySettings passivity_settings(const DeviceCapability& device) {
  haptics::PassivitySettings out;
  out.resolution = {0, 0};
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k) {
    double& said = k < 3 ? out.resolution.linear : out.resolution.angular;
    said = std::max(said, device.coordinates[k].resolution);
  }
  return out;
}

haptics::PassivitySettings passivity_settings(const PenGeometry& pen, const Compensation& share) {
  double least_damping = std::numeric_limits<double>::infinity(), least_friction = least_damping, sum = 0;
  for (const Arm arm : {Arm::R, Arm::L}) {
    const ArmBounds bounds = bounds_of(pen, arm);
    const ArmTraits joints = traits_of(pen, arm);
    least_damping = std::min(least_damping, damping(bounds, joints));
    least_friction = std::min(least_friction, friction(bounds, joints));
    sum += resolution(bounds, joints);
  }
  const double kept = 1 - share.friction, half = 0.5 * pen.grip_length;
  const double damps = kept * least_damping, rubs = kept * least_friction / std::numbers::sqrt3;
  haptics::PassivitySettings out;
  out.latency = kLatency;
  // The pivot is midway between the ends, the axis along their difference.
  out.resolution = {0.5 * sum, sum / pen.grip_length};
  // What an identified pen's friction takes is credited as it happens: PenSample::dissipated.
  if (pen.uncertainty) return out;
  // The ends move at v ± w, w = ω × r with |r| half the grip: |v + w|² + |v − w|² = 2 |v|² + 2 |w|².
  out.device_damping = {2 * damps, 2 * damps * half * half};
  // v + w| + |v − w| ≥ 2 max(|v|, |w|) ≥ |v| + |w|; the sum of the magnitudes of three coordinates is at most √3 times
  // the length.
  out.device_friction = {rubs, rubs * half};
  return out;
}

/// A force f at an arm's end takes the torque |J_k| f of a joint at most. Each arm carries half of the hand's force,
/// and the torque divided by the grip's length.
haptics::Bounds slowest_change(const PenGeometry& pen, double currents) {
  double least = std::numeric_limits<double>::infinity();  // N at an arm's end per A
  for (const PenChannel& c : pen.channels) {
    const double lever = bounds_of(pen, c.arm).lever[static_cast<std::size_t>(c.joint)];
    least = std::min(least, c.torque_constant * c.ratio / lever);
  }
  return {2 * least * currents, pen.grip_length * least * currents};
}

}  // namespace riffler::pen
