#include "marching/sight.hpp"

#include <algorithm>
#include <stdexcept>

namespace riffler::marching {

Sight::Sight(const Vec3& origin, const Vec3& direction, double far) : origin_(origin) {
  if (!geom::finite(origin)) throw std::invalid_argument("origin: not finite");
  const Vec3 size = glm::abs(direction);
  const double most = std::max({size.x, size.y, size.z});
  if (!geom::finite(direction) || !(most > 0)) throw std::invalid_argument("direction: not finite or zero");
  direction_ = glm::normalize(direction / most);  // its square may overflow or underflow
  k_ = size.x == most ? 0 : size.y == most ? 1 : 2;
  i_ = (k_ + 1) % 3, j_ = (k_ + 2) % 3;
  slope_i_ = direction_[i_] / direction_[k_], slope_j_ = direction_[j_] / direction_[k_], along_ = 1 / direction_[k_];
  // Instead of 0, a slope so small that the ray does not leave the slab it is in, and no product is 0 · ∞.
  for (int a = 0; a < 3; ++a) inverse_[a] = 1 / std::copysign(std::max(std::abs(direction_[a]), 1e-280), direction_[a]);
  // Much larger than the few rounding errors, much smaller than any triangle.
  margin_ = 0x1p-48 * std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z), far});
  below_ = origin - margin_, above_ = origin + margin_;
}

}  // namespace riffler::marching
