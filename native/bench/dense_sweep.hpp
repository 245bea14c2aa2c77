// An independent reference for swept volumes: signed distance to the cutter's profile, least over densely sampled times
// and refined there. It shares nothing with native/sweep but the profile itself: no pieces, no steps, no hits.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geom/pose.hpp"
#include "tool/profile.hpp"

namespace riffler::reference {

/// Signed distance (negative inside) of the point (rho, z) from the closed profile.
inline double profile_distance(const Profile& profile, double rho, double z) {
  const Vec2 p{rho, z};
  double distance = std::numeric_limits<double>::infinity();
  bool inside = false;
  Vec2 from{0, 0};
  const auto to_line = [&](const Vec2& a, const Vec2& b) {
    const Vec2 ab = b - a;
    const double t = std::clamp(glm::dot(p - a, ab) / std::max(glm::dot(ab, ab), 1e-300), 0.0, 1.0);
    distance = std::min(distance, glm::length(p - a - t * ab));
  };
  for (const ProfileSegment& s : profile.segments()) {
    const Vec2 to = s.to;
    if (!s.centre) {
      to_line(from, to);
      if (z >= from.y && z < to.y) inside = rho < from.x + (to.x - from.x) * (z - from.y) / (to.y - from.y);
    } else {
      const Vec2 c = *s.centre;
      const double r = glm::length(from - c), side = from.x + to.x >= 2 * c.x ? 1 : -1;
      // Heights rise along the arc and it stays on one side of its centre: nearest at the same angle if in range.
      const Vec2 d = p - c;
      const double length = glm::length(d);
      const Vec2 foot = length > 0 ? c + d * (r / length) : from;
      if (side * (foot.x - c.x) >= 0 && foot.y >= from.y && foot.y <= to.y)
        distance = std::min(distance, std::abs(length - r));
      distance = std::min({distance, glm::length(p - from), glm::length(p - to)});
      if (z >= from.y && z < to.y) inside = rho < c.x + side * std::sqrt(std::max(0.0, r * r - (z - c.y) * (z - c.y)));
    }
    from = to;
  }
  to_line(from, {0, from.y});
  return inside ? -distance : distance;
}

/// Least signed distance of the point from the cutter over the motion: positive outside of the swept volume (then the
/// true distance), negative inside. `samples` times, every local minimum refined by golden section.
inline double swept_distance(const Profile& profile, const Motion& motion, const Vec3& p, int samples = 256) {
  const auto at = [&](double t) {
    const Vec3 w = p - motion.tip(t), o = motion.axis(t);
    const double z = glm::dot(w, o);
    return profile_distance(profile, glm::length(w - z * o), z);
  };
  std::vector<double> value(samples + 1);
  for (int k = 0; k <= samples; ++k) value[k] = at(static_cast<double>(k) / samples);
  double least = std::min(value.front(), value.back());
  for (int k = 0; k <= samples; ++k) {
    const int before = std::max(0, k - 1), after = std::min(samples, k + 1);
    if (value[k] > value[before] || value[k] > value[after]) continue;
    double a = static_cast<double>(before) / samples, b = static_cast<double>(after) / samples;
    const double golden = 0.6180339887498949;
    double x = b - golden * (b - a), y = a + golden * (b - a), fx = at(x), fy = at(y);
    for (int i = 0; i < 60; ++i) {
      if (fx < fy)
        b = y, y = x, fy = fx, x = b - golden * (b - a), fx = at(x);
      else
        a = x, x = y, fx = fy, y = a + golden * (b - a), fy = at(y);
    }
    least = std::min({least, value[k], fx, fy});
  }
  return least;
}

}  // namespace riffler::reference
