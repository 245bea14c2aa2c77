#include "riffler/haptics/passivity.hpp"

#include <algorithm>
#include <cmath>

#include "riffler/base/check.hpp"

namespace riffler::haptics {

namespace {

constexpr double kMeanPeriods = 3;  // of the mean rate

}  // namespace

void PassivitySettings::validate() const {
  base::require_positive(period, "period");
  base::require_between(jitter, 0, period, "jitter");
  base::require_between(latency, 0, 8 * period, "latency");
  require_not_negative(device_rate, "device_rate");
  require_not_negative(acceleration, "acceleration");
  require_not_negative(resolution, "resolution");
  require_not_negative(max_damping, "max_damping");
  require_not_negative(device_damping, "device_damping");
  require_not_negative(device_friction, "device_friction");
  base::require_not_negative(reserve, "reserve");
  base::require_not_negative(storage, "storage");
  if (storage < reserve) throw std::invalid_argument("storage must be at least reserve");
}

Passivity::Passivity(const PassivitySettings& settings) : settings_(settings) {
  settings.validate();
  reset();
}

void Passivity::reset() {
  energy_ = settings_.reserve;
  rate_ = mean_rate_ = {};
  applied_ = {};
  last_dt_ = settings_.period;
  way_ = {}, way_time_ = {};
  kept_ = 1, damped_ = 0;
  on_the_way_ = {};
  waiting_ = static_cast<std::size_t>(std::ceil(settings_.latency / settings_.period - 1e-9));
}

/// Lower bound of what the device itself took from the hand. Damping: among all motions over a given displacement, the
/// steady one loses the least (Cauchy–Schwarz). Friction: the path is at least as long as the displacement, which is
/// known to one step. To make that step matter little, displacements are accumulated until they are several steps long.
double Passivity::dissipated(const Twist& displacement, double dt) {
  double sum = 0;
  for (int k = 0; k < kCoordinates; ++k) {
    double& time = way_time_[static_cast<std::size_t>(k)];
    way_[k] += displacement[k], time += std::max(0.0, dt);
    if (std::abs(way_[k]) < 8 * settings_.resolution[k]) continue;
    const double way = std::abs(way_[k]) - settings_.resolution[k];
    if (way > 0) sum += settings_.device_friction[k] * way;
    if (way > 0 && time > 0) sum += settings_.device_damping[k] * way * way / time;
    way_[k] = time = 0;
  }
  return sum;
}

void Passivity::observe(const Wrench& held, const Twist& displacement, double dt, double lost) {
  if (!finite(held) || !finite(displacement) || !std::isfinite(dt)) {
    rate_ = mean_rate_ = {};
    applied_ = finite(held) ? held : Wrench{};
    return;
  }
  energy_ += dissipated(displacement, dt) - power(held, displacement);
  if (lost > 0 && std::isfinite(lost)) energy_ += lost;
  // Cap the credit, never the debt. Energy not stored in an object was dissipated, by friction or cutting, and must not
  // pay for a later fault: no object stores more than `storage`, and none stores anything while the wrench is zero.
  energy_ = std::min(energy_, held == Wrench{} ? settings_.reserve : settings_.storage);
  applied_ = held;
  if (!(dt > 0)) return;
  rate_ = 1 / dt * displacement, last_dt_ = dt;
  // A short tick after a late one has a large rate, but little weight.
  const double share = 1 / (dt + kMeanPeriods * settings_.period);
  mean_rate_ = (1 - share * dt) * mean_rate_ + share * displacement;
}

double Passivity::unsure(int k, double rate, std::size_t ahead) const {
  const double hold = settings_.period, longest = hold + settings_.jitter;
  // Between the mean rates of the last tick and of the hold lie half of each and everything between; either end of
  // either displacement is known to half a step.
  const double from_middle_to_middle = (2 * static_cast<double>(ahead) + 1) * longest + last_dt_;
  return settings_.acceleration[k] * longest * from_middle_to_middle / 2 +
         settings_.resolution[k] * (1 + hold / last_dt_) + settings_.jitter * std::abs(rate);
}

double Passivity::duration(const Wrench& change) const {
  const auto seconds = [](const Vec3& way, double rate) { return rate > 0 ? glm::length(way) / rate : 0; };
  return seconds(change.force, settings_.device_rate.linear) + seconds(change.torque, settings_.device_rate.angular);
}

/// What the device applies a hold later.
Wrench Passivity::followed(const Wrench& applied, const Wrench& wanted) const {
  const Wrench change = wanted - applied;
  const double time = duration(change);
  return time <= settings_.period ? wanted : applied + settings_.period / time * change;
}

double Passivity::fall(const Wrench& applied) const {
  return std::max(0.0, power(applied, mean_rate_)) * duration(applied) / 2;
}

/// The device applies each wrench, or still approaches it. A wrench scaled down after the controller delivers no
/// more than this, since negative deliveries count as zero.
double Passivity::on_the_way(const Capability& device, Wrench& applied) const {
  const Twist rate{rate_.linear * device.axes, rate_.angular * device.axes};
  const auto delivered = [&](const Wrench& held, std::size_t n) {
    const Wrench force{held.force * device.axes, held.torque * device.axes};
    double sum = 0;
    for (int k = 0; k < kCoordinates; ++k)
      sum += force[k] * rate[k] * settings_.period + std::abs(force[k]) * unsure(k, rate[k], n);
    return sum;
  };
  double sum = 0;
  for (std::size_t n = 0; n < waiting_; ++n) {
    applied = followed(applied, on_the_way_[n]);
    sum += std::max({0.0, delivered(on_the_way_[n], n), delivered(applied, n)});
  }
  return sum;
}

Wrench Passivity::control(const Wrench& wanted, const Capability& device) {
  const double hold = settings_.period;
  // In the device's coordinates, in which each damping acts on one coordinate only.
  const auto local = [&](const Vec3& v) { return v * device.axes; };
  const Wrench force{local(wanted.force), local(wanted.torque)};
  const Twist rate{local(rate_.linear), local(rate_.angular)};

  // Largest energy that `wanted` can deliver during its hold and more than zero while the device lets it fall, and
  // smallest energy that full damping takes from the hand.
  Wrench applied = applied_;
  const double in_transit = on_the_way(device, applied), falls = fall(applied);
  double delivered = fall(followed(applied, wanted)) - falls, taken = 0;
  Wrench damping;
  for (int k = 0; k < kCoordinates; ++k) {
    const double off = unsure(k, rate[k], waiting_);
    delivered += force[k] * rate[k] * hold + std::abs(force[k]) * off;
    const double sure = std::abs(rate[k]) * hold - off;
    if (!device.push[static_cast<std::size_t>(k)] || sure <= 0) continue;
    damping[k] = -settings_.max_damping[k] * rate[k];
    taken += std::abs(damping[k]) * sure;
  }
  // The energy of a sum is at most the sum of energies, so kept · delivered − damped · taken is an upper bound.
  const double held = energy_ - in_transit - falls;
  kept_ = 1, damped_ = 0;
  Wrench out = wanted;
  if (delivered > held) {
    if (taken > 0) damped_ = std::min(1.0, (delivered - held) / taken);
    if (delivered > 0) kept_ = std::clamp((held + damped_ * taken) / delivered, 0.0, 1.0);
    const Wrench injected{device.axes * damping.force, device.axes * damping.torque};
    out = kept_ * wanted + damped_ * injected;
  }
  if (waiting_ > 0) {
    std::move(on_the_way_.begin() + 1, on_the_way_.begin() + static_cast<std::ptrdiff_t>(waiting_),
              on_the_way_.begin());
    on_the_way_[waiting_ - 1] = finite(out) ? out : Wrench{};
  }
  return out;
}

}  // namespace riffler::haptics
