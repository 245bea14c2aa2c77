#include "pen/arms/joint_losses.hpp"

#include <cmath>

#include "geom/math.hpp"

namespace riffler::pen {

namespace {

constexpr std::int32_t kCounts = 8;  // credited at once: the count of uncertainty costs an eighth of it
constexpr double kSingular = 1e-3;   // limit of arm_dexterity

/// J⁻ᵀ C J⁻¹: N·s/mm at the arm's end.
Mat3 end_damping(const PenKinematics& pen, const PenPosture& posture, Arm arm) {
  Mat3 friction(0);
  const PenGeometry& g = pen.geometry();
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = g.channels[k];
    if (c.arm == arm) friction[c.joint][c.joint] = certain_friction(g, k).viscous * c.ratio * c.ratio;
  }
  const Mat3 back = glm::inverse(posture.arms[index(arm)].jacobian);
  return glm::transpose(back) * friction * back;
}

}  // namespace

Mat3 pivot_damping(const PenKinematics& pen, const PenPosture& posture) noexcept {
  const PenGeometry& g = pen.geometry();
  for (std::size_t arm = 0; arm < 2; ++arm)
    if (!(std::abs(arm_dexterity(g.arms[arm], posture.angles[arm])) > kSingular)) return Mat3(0);
  if (!g.uncertainty || !(posture.length > 0)) return Mat3(0);
  const Mat3 right = end_damping(pen, posture, Arm::R), left = end_damping(pen, posture, Arm::L);
  // The ends move at v ± w. w is square to the grip: two of the columns b; along the grip nothing gives.
  const Mat3 sum = right + left, difference = left - right;
  const Vec3 along = posture.apart / posture.length;
  const Vec3 other = std::abs(along.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 first = glm::normalize(glm::cross(along, other)), second = glm::cross(along, first);
  const double a = glm::dot(first, sum * first), b = glm::dot(first, sum * second), c = glm::dot(second, sum * second);
  const double det = a * c - b * b;
  if (!(det > 0)) return Mat3(0);
  const Vec3 p = difference * first, q = difference * second;
  // Schur complement: sum − [p q] [a b; b c]⁻¹ [p q]ᵀ.
  const Mat3 free = sum - (c * glm::outerProduct(p, p) - b * (glm::outerProduct(p, q) + glm::outerProduct(q, p)) +
                           a * glm::outerProduct(q, q)) /
                              det;
  return g.turn * free * glm::transpose(g.turn);
}

JointLosses::JointLosses(const PenGeometry& pen, const Compensation& share) noexcept {
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = pen.channels[k];
    const CertainFriction friction = certain_friction(pen, k);
    const double kept = 1 - share.friction;
    joints_[k] = {kept * friction.coulomb, kept * friction.viscous, kTwoPi * c.ratio / c.steps};
  }
}

double JointLosses::add(const EncoderCounts& raw, double time) noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    Joint& j = joints_[k];
    if (!begun_) j.from = raw[k], j.since = time;
    const auto turned =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(raw[k]) - static_cast<std::uint32_t>(j.from));
    const double counts = std::abs(static_cast<double>(turned));
    if (counts < kCounts) continue;
    const double turn = (counts - 1) * j.turn;  // both ends are known to half a count
    sum += j.coulomb * turn;
    if (time > j.since) sum += j.viscous * turn * turn / (time - j.since);
    j.from = raw[k], j.since = time;
  }
  begun_ = true;
  return sum;
}

}  // namespace riffler::pen
