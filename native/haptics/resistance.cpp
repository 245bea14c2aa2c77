#include "riffler/haptics/resistance.hpp"

#include <algorithm>

#include "base/functions.hpp"

namespace riffler::haptics {

double memory_for(double pitch) {
  return std::max(0.02, pitch / 3);
}

void Resistance::PerWay::add(double amount, double length, double memory) {
  if (way == 0) {
    if (!(amount > 0)) return;
    way = 0.02;
  }
  // A resistance met evenly along the travel keeps the factor 1 − e^(−length/memory). For zero travel, the limit.
  const double kept = base::exp(-length / memory);
  const double share = length > 1e-9 * memory ? -base::expm1(-length / memory) / length : 1 / memory;
  sum = kept * sum + share * amount;
  way = kept * way + (1 - kept);
}

void Resistance::forget() {
  area_ = turning_ = engaged_ = {};
  arm_ = Vec3(0), idle_ = 0;
}

void Resistance::learn(const Twist& way, const Wrench& wrench, double dt, double reach) {
  const double force = glm::length(wrench.force), turn = glm::length(way.angular);
  // Where the force acts: on the line of the wrench, next to the tip. Where opposing forces put that line far away, use
  // the tool's end; the remaining moment is a couple.
  Vec3 arm = force > 0 ? glm::cross(wrench.force / force, wrench.torque / force) : Vec3(0);
  if (const double far = glm::length(arm); far > reach) arm *= reach / far;
  const Vec3 there = way.linear + glm::cross(way.angular, arm);
  const Vec3 couple = wrench.torque - glm::cross(arm, wrench.force);
  const double slid = glm::length(there), swung = turn * reach;
  idle_ = force > 0 ? 0 : idle_ + std::max(slid, swung);
  if (idle_ > memory_) return forget();

  const double against = slid > 0 ? std::max(0.0, -glm::dot(wrench.force, there) / slid) : force;
  const double before = area_.sum;
  area_.add(against * dt, slid, memory_);
  if (const double now = area_.sum; now > 0 && force > 0) {
    const double old = std::min(1.0, before * base::exp(-slid / memory_) / now);
    arm_ = old * arm_ + (1 - old) * arm;
  }
  engaged_.add(force > 0 ? slid : 0, slid, memory_);
  const double twist = turn > 0 ? std::max(0.0, -glm::dot(couple, way.angular) / turn) : 0;
  turning_.add(twist * reach * dt, std::max(slid, swung), memory_);
}

}  // namespace riffler::haptics
