#include "riffler/dexel/span.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::dexel {

namespace {
double sign(double x) {
  return x < 0 ? -1.0 : 1.0;
}
}  // namespace

PackedNormal PackedNormal::pack(const Vec3& n) {
  const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0)) return pack({0, 0, 1});
  double u = n.x / sum, v = n.y / sum;
  if (n.z < 0) {
    const double folded = (1 - std::abs(v)) * sign(u);
    v = (1 - std::abs(u)) * sign(v);
    u = folded;
  }
  const auto quantise = [](double x) {
    return static_cast<std::int16_t>(std::lround(std::clamp(x, -1.0, 1.0) * 32767));
  };
  return {quantise(u), quantise(v)};
}

Vec3 PackedNormal::unpack() const {
  Vec3 n{u / 32767.0, v / 32767.0, 0};
  n.z = 1 - std::abs(n.x) - std::abs(n.y);
  if (n.z < 0) {
    const double x = n.x;
    n.x = (1 - std::abs(n.y)) * sign(x);
    n.y = (1 - std::abs(x)) * sign(n.y);
  }
  return n / glm::length(n);
}

}  // namespace riffler::dexel
