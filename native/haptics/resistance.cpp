#include "haptics/resistance.hpp"

#include <algorithm>
#include <cmath>

namespace riffler {

namespace {

/// Mean over the last `memory` of what was met evenly along a way, 1 − e^(−way/memory) of it new, per unit of its
/// integral. Of no way the limit.
double share(double way, double memory) {
  return way > 1e-9 * memory ? -std::expm1(-way / memory) / way : 1 / memory;
}

}  // namespace

void Resistance::learn(const Twist& way, const Wrench& wrench, double dt, double reach) {
  const double force = glm::length(wrench.force), turn = glm::length(way.angular);
  // Where the force acts: on the line of the wrench, next to the tip. Of forces that cancel each other it would be far
  // away, and is where the tool ends; what is missing is the couple.
  Vec3 arm = force > 0 ? glm::cross(wrench.force / force, wrench.torque / force) : Vec3(0);
  if (const double far = glm::length(arm); far > reach) arm *= reach / far;
  const Vec3 there = way.linear + glm::cross(way.angular, arm);
  const Vec3 couple = wrench.torque - glm::cross(arm, wrench.force);

  const double slid = glm::length(there), kept = std::exp(-slid / memory_);
  const double against = slid > 0 ? std::max(0.0, -glm::dot(wrench.force, there) / slid) : force;
  const double met = share(slid, memory_) * against * dt;
  impulse_ *= kept;
  if (met > 0) arm_ = (impulse_ * arm_ + met * arm) / (impulse_ + met);
  impulse_ += met;
  engaged_ = kept * engaged_ + (force > 0 ? 1 - kept : 0);

  const double swung = turn * reach, twist = turn > 0 ? std::max(0.0, -glm::dot(couple, way.angular) / turn) : 0;
  const double forgotten = std::exp(-std::max(slid, swung) / memory_);
  turning_ = forgotten * turning_ + share(swung, memory_) * twist * reach * dt;
}

}  // namespace riffler
