#include "sweep/swept_normal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace riffler::sweep {

namespace {

/// The two surfaces of a group nearest to a point of its half-plane: their normals (radius, height) and distances.
struct Nearest {
  Vec2 normal{0, 1}, second{0, 1};
  double off = std::numeric_limits<double>::infinity(), second_off = off;

  void add(const Vec2& n, double distance) {
    distance = std::abs(distance);
    if (distance < off)
      second = normal, second_off = off, normal = n, off = distance;
    else if (distance < second_off)
      second = n, second_off = distance;
  }
};

/// Distance outside a range, 0 inside it.
double beyond(double x, double low, double high) {
  return std::max({0.0, low - x, x - high});
}

double length_of(double a, double b) {
  return std::sqrt(a * a + b * b);
}

void add_side(const PieceShape& s, const Vec2& p, Nearest& out) {
  const double past = beyond(p.y, s.z0, s.z1);
  if (s.round) {
    const Vec2 d(std::max(p.x - s.e, 0.0), p.y - s.zc);
    const double length = glm::length(d);
    out.add(length > 0 ? d / length : Vec2(1, 0), length_of(length - s.r, past));
  } else {
    const double aside = (p.x - s.r0 - s.slope * (p.y - s.z0)) * s.cosine;
    out.add(Vec2(s.cosine, -s.slope * s.cosine), length_of(aside, past));
  }
}

Nearest nearest(std::span<const PieceShape> group, const Vec2& p) {
  Nearest out;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const PieceShape& s = group[k];
    add_side(s, p, out);
    if (k == 0 && s.cut0) out.add({0, -1}, length_of(p.y - s.z0, beyond(p.x, 0, s.r0)));
    if (k + 1 == group.size() && s.cut1) out.add({0, 1}, length_of(p.y - s.z1, beyond(p.x, 0, s.r1)));
  }
  return out;
}

}  // namespace

Vec3 swept_normal(std::span<const PieceShape> group, const Motion& motion, const Vec3& p, double t) {
  const Vec3 axis = motion.axis(t), w = p - motion.tip(t);
  const double z = glm::dot(w, axis);
  const Vec3 aside = w - z * axis;
  const double rho = glm::length(aside);
  const Vec3 radial =
      rho > 0 ? aside / rho : glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
  const Nearest at = nearest(group, {rho, z});
  const auto in_space = [&](const Vec2& n) { return n.x * radial + n.y * axis; };
  const Vec3 n = in_space(at.normal), velocity = motion.velocity(p, t);
  const double speed = glm::length(velocity), slide = glm::dot(n, velocity);
  const double rounding = 1e-9;
  if (t <= rounding || t >= 1 - rounding || !(std::abs(slide) > 0)) return n;
  // During the move the swept surface is where n · v = 0 (3.1); on an edge, for a normal between those of its two
  // sides. On a smooth side, t is nearly right; remove what remains of n · v.
  const bool edge =
      at.second_off <= at.off + 1e-9 * (rho + std::abs(z)) && slide * glm::dot(in_space(at.second), velocity) < 0;
  if (!edge && std::abs(slide) <= 0.15 * speed) return glm::normalize(n - (slide / (speed * speed)) * velocity);
  const Vec3 swept = glm::cross(glm::cross(axis, aside), velocity);
  const double length = glm::length(swept);
  if (!(length > 1e-9 * speed * rho)) return n;
  return swept * ((glm::dot(swept, aside) < 0 ? -1.0 : 1.0) / length);
}

}  // namespace riffler::sweep
