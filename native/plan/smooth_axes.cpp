#include "plan/smooth_axes.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::plan {

namespace {

/// The velocity at a key, between the rates `in` and `out` of two great circles through it.
Vec3 velocity_at_key(const Vec3& in, const Vec3& out) {
  const double before = glm::length(in), after = glm::length(out);
  if (before == 0 || after == 0) return Vec3(0);
  // sum of unit vectors| / 2 is the cosine of half the angle between them: length and direction at once.
  return std::min(before, after) * 0.5 * (in / before + out / after);
}

Vec3 capped(const Vec3& v, double most) {
  const double length = glm::length(v);
  return length > most ? v * (most / length) : v;
}

}  // namespace

Vec3 along_great_circle(const Vec3& a, const Vec3& v, double u) {
  const double rate = glm::length(v), angle = rate * u;
  return rate > 0 ? base::cos(angle) * a + base::sin(angle) * (v / rate) : a;
}

Vec3 velocity_between(const Vec3& a, const Vec3& b) {
  return glm::cross(Motion({Vec3(0), a}, {Vec3(0), b}).rotation(), a);
}

SmoothAxes::SmoothAxes(std::vector<double> places, std::vector<Vec3> axes, double period)
    : places_(std::move(places)), axes_(std::move(axes)), velocities_(axes_.size(), Vec3(0)), period_(period) {
  if (axes_.size() < 2) return;
  if (period_ > 0) {
    places_.push_back(places_.front() + period_), axes_.push_back(axes_.front());
    velocities_.emplace_back(0);
  }
  const std::size_t spans = places_.size() - 1;
  const auto width = [&](std::size_t k) { return places_[k + 1] - places_[k]; };
  const auto cap = [&](std::size_t k) { return 0.5 * (kPi - angle_of(k)) / width(k); };
  for (std::size_t k = 0; k <= spans; ++k) {
    if ((k == 0 || k == spans) && !(period_ > 0)) continue;
    const std::size_t before = k > 0 ? k - 1 : spans - 1, after = k < spans ? k : 0;
    const Vec3 in = -velocity_between(axes_[before + 1], axes_[before]) / width(before);
    const Vec3 out = velocity_between(axes_[after], axes_[after + 1]) / width(after);
    velocities_[k] = capped(velocity_at_key(in, out), std::min(cap(before), cap(after)));
  }
}

double SmoothAxes::angle_of(std::size_t span) const {
  return Motion({Vec3(0), axes_[span]}, {Vec3(0), axes_[span + 1]}).angle();
}

Vec3 SmoothAxes::at(double s) const {
  if (axes_.size() == 1) return axes_.front();
  if (period_ > 0) s -= period_ * std::floor((s - places_.front()) / period_);
  if (s <= places_.front()) return axes_.front();
  if (s >= places_.back()) return axes_.back();
  const auto k = static_cast<std::size_t>(std::upper_bound(places_.begin(), places_.end(), s) - places_.begin()) - 1;
  const double width = places_[k + 1] - places_[k], u = (s - places_[k]) / width;
  if (u == 0) return axes_[k];
  const Vec3 leaving = along_great_circle(axes_[k], velocities_[k], s - places_[k]);
  const Vec3 arriving = along_great_circle(axes_[k + 1], velocities_[k + 1], s - places_[k + 1]);
  return glm::normalize(geom::slerp(leaving, arriving, u * u * (3 - 2 * u)));
}

}  // namespace riffler::plan
