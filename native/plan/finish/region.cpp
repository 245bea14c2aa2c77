#include "plan/finish/region.hpp"

#include <algorithm>

#include "geom/math.hpp"

namespace riffler::plan {

namespace {
constexpr std::size_t kMostBands = 1024;
}

Region::Region(const std::vector<std::vector<Vec2>>& curves) {
  std::size_t edges = 0;
  low_ = kInfinity, high_ = -kInfinity;
  for (const std::vector<Vec2>& curve : curves)
    for (const Vec2& p : curve) low_ = std::min(low_, p.y), high_ = std::max(high_, p.y), ++edges;
  if (edges == 0) return;
  bands_.resize(std::min(edges, kMostBands));
  for (const std::vector<Vec2>& curve : curves)
    for (std::size_t k = 0, j = curve.size() - 1; k < curve.size(); j = k++) {
      const Vec2 &a = curve[k], &b = curve[j];
      for (std::size_t at = band(std::min(a.y, b.y)), end = band(std::max(a.y, b.y)); at <= end; ++at)
        bands_[at].push_back({a, b});
    }
}

bool Region::holds(const Vec2& p) const {
  if (bands_.empty() || !(p.y >= low_ && p.y <= high_)) return false;
  bool in = false;
  for (const auto& [a, b] : bands_[band(p.y)])
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  return in;
}

bool Region::within(const Vec2& p, double reach) const {
  if (bands_.empty() || p.y < low_ - reach || p.y > high_ + reach) return false;
  if (holds(p)) return true;
  for (std::size_t at = band(std::max(p.y - reach, low_)), end = band(std::min(p.y + reach, high_)); at <= end; ++at)
    for (const auto& [a, b] : bands_[at]) {
      const Vec2 way = b - a, off = p - a;
      const double length2 = glm::dot(way, way);
      const Vec2 aside = off - (length2 > 0 ? std::clamp(glm::dot(off, way) / length2, 0.0, 1.0) : 0.0) * way;
      if (glm::dot(aside, aside) <= reach * reach) return true;
    }
  return false;
}

std::size_t Region::band(double y) const {
  const double share = high_ > low_ ? (y - low_) / (high_ - low_) : 0;
  return std::min(static_cast<std::size_t>(share * static_cast<double>(bands_.size())), bands_.size() - 1);
}

}  // namespace riffler::plan
