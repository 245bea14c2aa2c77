#include "riffler/pen/models/rate_control.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::pen {
namespace {

constexpr double kLongestStep = 0.1;

}  // namespace

void RateSettings::validate() const {
  const auto fail = [](const char* what) { throw std::invalid_argument(std::string("rate control: ") + what); };
  if (!(bubble >= 0 && bubble < 1)) fail("bubble must be at least 0 and less than 1");
  if (!(exponent >= 1 && exponent <= 5)) fail("exponent must be between 1 and 5");
  if (!(speed > 0 && std::isfinite(speed))) fail("speed must be positive");
  if (!(turn_rate > 0 && std::isfinite(turn_rate))) fail("turn_rate must be positive");
  for (const int sign : signs)
    if (sign < -1 || sign > 1) fail("signs must be -1, 0 or 1");
}

Vec3 shaped(const Vec3& deflection, double bubble, double exponent) noexcept {
  const double length = glm::length(deflection);
  if (!(length > bubble) || !std::isfinite(length)) return Vec3(0);
  const double share = std::min((length - bubble) / (1 - bubble), 1.0);
  return base::pow(share, exponent) / length * deflection;
}

RateControl::RateControl(const RateSettings& settings) : settings_(settings) {
  settings_.validate();
}

void RateControl::push(const Vec3& translation, const Vec3& rotation) noexcept {
  Vec3 t = translation, r = rotation;
  for (int k = 0; k < 3; ++k) {
    t[k] *= settings_.signs[static_cast<std::size_t>(k)];
    r[k] *= settings_.signs[static_cast<std::size_t>(k + 3)];
  }
  velocity_ = settings_.hold_position ? Vec3(0) : settings_.speed * shaped(t, settings_.bubble, settings_.exponent);
  turning_ =
      settings_.hold_orientation ? Vec3(0) : settings_.turn_rate * shaped(r, settings_.bubble, settings_.exponent);
}

void RateControl::advance(double now) noexcept {
  const double dt = timed_ ? std::clamp(now - time_, 0.0, kLongestStep) : 0;
  timed_ = true;
  time_ = now;
  pose_.tip += dt * velocity_;
  spin_ += dt * glm::dot(turning_, pose_.axis);
  pose_.axis = glm::normalize(geom::rotate_by(pose_.axis, dt * turning_));
}

void RateControl::rest() noexcept {
  velocity_ = turning_ = Vec3(0);
  timed_ = false;
}

}  // namespace riffler::pen
