#include "riffler/pen/arms/arm.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/hypot.hpp"

namespace riffler::pen {

ArmPosture arm_posture(const ArmLinks& links, const Vec3& angles) noexcept {
  const double s1 = base::sin(angles.x), c1 = base::cos(angles.x);
  const double s2 = base::sin(angles.y), c2 = base::cos(angles.y);
  const double s3 = base::sin(angles.z), c3 = base::cos(angles.z);
  const double out = links.upper * s2 + links.fore * c3;  // distance from the vertical axis
  ArmPosture posture;
  posture.end = {out * c1, out * s1 + links.shoulder, links.fore * s3 - links.upper * c2};
  posture.jacobian = Mat3(Vec3(-out * s1, out * c1, 0),  //
                          links.upper * Vec3(c1 * c2, s1 * c2, s2), links.fore * Vec3(-c1 * s3, -s1 * s3, c3));
  return posture;
}

double arm_dexterity(const ArmLinks& links, const Vec3& angles) noexcept {
  const double out = links.upper * base::sin(angles.y) + links.fore * base::cos(angles.z);
  return base::cos(angles.y - angles.z) * out / (links.upper + links.fore);
}

ArmInverse arm_angles(const ArmLinks& links, const Vec3& end) noexcept {
  ArmInverse inverse;
  const double y = end.y - links.shoulder, out = geom::hypot(end.x, y), distance = geom::hypot(out, end.z);
  if (!std::isfinite(distance)) return inverse;
  const double straight = links.upper + links.fore, folded = std::abs(links.upper - links.fore);
  inverse.reach = distance > straight ? ReachResult::TooFar
                  : distance < folded ? ReachResult::TooNear
                                      : ReachResult::Reached;
  // A point on the vertical axis can be reached, but from any side.
  if (inverse.reach == ReachResult::Reached && (out == 0 || distance == 0)) inverse.reach = ReachResult::OnAxis;
  // sin and cos of θ2 − θ3 from the law of cosines, in factored form: precise near the straight and the folded arm.
  const double two = 2 * links.upper * links.fore;
  const double less = (straight - distance) * (straight + distance) / two;  // 1 − sin
  const double more = (distance - folded) * (distance + folded) / two;      // 1 + sin
  const double s = std::clamp(less < more ? 1 - less : more - 1, -1.0, 1.0);
  const double c = std::sqrt(std::max(less, 0.0) * std::max(more, 0.0));
  // With θ2 = θ3 + δ the end is (L2 + L1 sin δ, −L1 cos δ) rotated by θ3.
  const double third = base::atan2(end.z, out) - base::atan2(-links.upper * c, links.fore + links.upper * s);
  inverse.angles = {base::atan2(y, end.x), third + base::atan2(s, c), third};
  return inverse;
}

}  // namespace riffler::pen
