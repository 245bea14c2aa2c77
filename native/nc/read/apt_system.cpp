#include "nc/read/apt_system.hpp"

#include <cmath>

namespace riffler::nc {

void AptSystem::use(const Vec3& origin, const Vec3& x, const Vec3& y, const NcPlace& place) {
  if (!(std::abs(glm::dot(x, y)) < 1e-3)) place.fail("MSYS whose axes are not at right angles");
  const Vec3 z = glm::normalize(glm::cross(x, y));
  const Mat3 axes(x, glm::cross(z, x), z);
  if (!first_) first_ = {axes, origin};
  moved_ = !(axes == first_->axes && origin == first_->origin);
  turn_ = glm::transpose(first_->axes) * axes;
  shift_ = glm::transpose(first_->axes) * (origin - first_->origin);
}

}  // namespace riffler::nc
