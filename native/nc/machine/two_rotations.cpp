#include "nc/machine/two_rotations.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"

namespace riffler::nc {

double angle_about(const Vec3& k, const Vec3& from, const Vec3& to) {
  const Vec3 side = glm::cross(k, from);
  return base::atan2(glm::dot(side, to), glm::dot(glm::cross(side, k), to));
}

std::optional<TwoRotations::Angles> TwoRotations::angles(const Vec3& from, const Vec3& to, int branch) const {
  // Between the two rotations the direction is z: its component along `second` is that of `from`, its component along
  // `first` that of `to`. Perpendicular to `first` it has the length that `to` has there, which preserves precision
  // near the pole.
  const double cosine = glm::dot(first, second);
  const Vec3 across = glm::cross(first, second);
  const double sine = glm::length(across), up = glm::dot(first, to);
  const double long_ = glm::length(glm::cross(first, to));
  const Vec3 e = (second - cosine * first) / sine, f = across / sine;
  const double along = (glm::dot(second, from) - cosine * up) / sine, square = (long_ - along) * (long_ + along);
  // At the edge of the reachable range, up to rounding, the two solutions coincide.
  if (square < -1e-12) return {};
  const double side = std::sqrt(std::max(0.0, square));
  const Vec3 z = up * first + along * e + (branch == 0 ? side : -side) * f;
  return Angles{angle_about(first, z, to), angle_about(second, from, z)};
}

}  // namespace riffler::nc
