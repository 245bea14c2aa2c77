#include "stress/identified_damping.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "pen/arms/joint_losses.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "riffler/pen/passivity_settings.hpp"
#include "stress/random.hpp"

namespace riffler::stress {

namespace {

constexpr int kTries = 50;  // poses drawn for each that must be reached

/// Settings from the friction that is certain, as for a pen whose file has these values.
haptics::PassivitySettings certain_settings(pen::PenGeometry geometry) {
  for (std::size_t k = 0; k < pen::kPenChannels; ++k) {
    const pen::CertainFriction certain = certain_friction(geometry, k);
    geometry.channels[k].coulomb = certain.coulomb, geometry.channels[k].viscous = certain.viscous;
  }
  geometry.uncertainty.reset();
  return passivity_settings(geometry);
}

}  // namespace

/// In closed form (O. K. Smith, "Eigenvalues of a symmetric 3 × 3 matrix", Comm. ACM 4(4), 1961), which also works for
/// singular matrices.
double least_eigenvalue(const Mat3& m) {
  const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3;
  const Mat3 off = m - mean * Mat3(1);
  double squares = 0;
  for (int k = 0; k < 3; ++k) squares += glm::dot(off[k], off[k]);
  const double spread = std::sqrt(squares / 6);
  if (!(spread > 0)) return mean;
  const double angle = std::acos(std::clamp(0.5 * glm::determinant(off / spread), -1.0, 1.0)) / 3;
  return mean + 2 * spread * std::cos(angle + 2.0943951023931953);
}

IdentifiedDamping identified_damping(const pen::PenGeometry& geometry, int postures) {
  if (!geometry.uncertainty)
    throw std::invalid_argument(geometry.name + " was not identified: run riffler pen identify");
  const pen::PenKinematics kinematics(geometry);
  const auto damping = [&](const pen::PenPosture& posture) {
    return std::max(0.0, least_eigenvalue(pivot_damping(kinematics, posture)));
  };
  const pen::PenPosture home = kinematics.posture(kinematics.home_angles());
  std::vector<double> found;
  Random random(1);
  const Box3& box = geometry.workspace;
  for (int k = 0; k < kTries * postures && static_cast<int>(found.size()) < postures; ++k) {
    const Vec3 share(random.uniform(), random.uniform(), random.uniform());
    const Pose pose{geometry.turn * (box.lower + share * (box.upper - box.lower)) + geometry.origin,
                    glm::normalize(home.pose.axis + 0.5 * random.uniform() * random.direction())};
    const pen::PenInverse inverse = kinematics.inverse(pose);
    if (inverse.reached()) found.push_back(damping(kinematics.posture(inverse.angles)));
  }
  if (static_cast<int>(found.size()) < postures)
    throw std::invalid_argument(geometry.name + ": its arms reach only " + std::to_string(found.size()) + " of " +
                                std::to_string(kTries * postures) +
                                " poses of its workspace: are limits.lower and "
                                "limits.upper right?");
  std::ranges::sort(found);
  const haptics::PassivitySettings worst = certain_settings(geometry);
  return {damping(home),
          found[found.size() / 2],
          found.front(),
          worst.resolution.linear,
          std::sqrt(3) * worst.device_friction.linear,
          static_cast<int>(found.size())};
}

}  // namespace riffler::stress
