#include "brush/displacement.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"

namespace riffler::brush {

Box3 Reach::box() const {
  Box3 out;
  out.add(centre), out.add(centre + pull);
  return out.grown(radius);
}

bool Reach::contains(const Vec3& p) const {
  const Vec3 r = p - centre;
  const double square = glm::dot(pull, pull);
  const double t = square > 0 ? std::clamp(glm::dot(r, pull) / square, 0.0, 1.0) : 0;
  return geom::squared_length(r - t * pull) <= radius * radius;
}

/// The reach is convex, so the interval is the hull of those with both balls and with the cylinder between them.
Interval Reach::along(Axis axis, double u, double v) const {
  Interval out;
  const Vec3 c = to_local(axis, centre), d = to_local(axis, pull);
  const auto ball = [&](const Vec3& m) {
    const double rest = radius * radius - (u - m.x) * (u - m.x) - (v - m.y) * (v - m.y);
    if (rest < 0) return;
    const double half = std::sqrt(rest);
    out.include(m.z - half), out.include(m.z + half);
  };
  ball(c);
  const double square = glm::dot(d, d);
  if (!(square > 0)) return out;
  ball(c + d);
  // |q + w e − t d|² = r² with t = (q + w e)·d / d², a quadratic in w.
  const Vec3 q(u - c.x, v - c.y, -c.z), e(0, 0, 1);
  const Vec3 q0 = q - d * (glm::dot(q, d) / square), e0 = e - d * (d.z / square);
  const double a = glm::dot(e0, e0), b = glm::dot(q0, e0), rest = b * b - a * (glm::dot(q0, q0) - radius * radius);
  if (!(a > 1e-12) || rest < 0) return out;
  for (const double side : {-1.0, 1.0}) {
    const double w = (-b + side * std::sqrt(rest)) / a, t = (glm::dot(q, d) + w * d.z) / square;
    if (t >= 0 && t <= 1) out.include(w);
  }
  return out;
}

Displacement::Displacement(const BrushOptions& options, const Reach& reach, const Vec3& axis)
    : kind_(options.kind),
      falloff_(options.falloff),
      strength_(options.strength),
      amount_(options.amount),
      reach_(reach),
      axis_(axis),
      point_(reach.centre) {}

bool Displacement::needs_plane() const {
  return kind_ == Kind::Flatten || kind_ == Kind::Scrape || kind_ == Kind::Fill;
}

double Displacement::weight(const Vec3& p) const {
  return strength_ * falloff_at(falloff_, glm::length(p - reach_.centre) / reach_.radius);
}

/// Smooth, so that the displacement has no jump where the surface turns away; 1 up to 60° off the axis.
double Displacement::facing(const Vec3& n) const {
  const double s = std::clamp(2 * glm::dot(n, axis_), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

Vec3 Displacement::free(const Vec3& p, const Vec3& n) const {
  const double f = weight(p);
  if (f == 0) return Vec3(0);
  const Vec3 r = p - point_;
  const double height = glm::dot(r, axis_);
  switch (kind_) {
    case Kind::Clay:
      return f * amount_ * facing(n) * axis_;
    case Kind::Inflate:
      return f * amount_ * n;
    case Kind::Flatten:
    case Kind::Scrape:
    case Kind::Fill: {
      const double over = height - amount_;
      if ((kind_ == Kind::Scrape && over < 0) || (kind_ == Kind::Fill && over > 0)) return Vec3(0);
      return -f * facing(n) * over * axis_;
    }
    case Kind::Grab:
    case Kind::SnakeHook:
      return f * reach_.pull;
    case Kind::Pinch:
      return -0.5 * f * (r - height * axis_);
    case Kind::Crease:
      return -0.5 * f * (r - height * axis_) + (strength_ > 0 ? f * f / strength_ : 0.0) * amount_ * facing(n) * axis_;
    case Kind::Twist:
      break;
  }
  const double angle = f * amount_;
  const Vec3 off = r - height * axis_;
  return (base::cos(angle) - 1) * off + base::sin(angle) * glm::cross(axis_, off);
}

Vec3 Displacement::operator()(const Vec3& p, const Vec3& n) const {
  const Vec3 d = free(p, n);
  if (reach_.contains(p + d)) return d;
  // The farthest place along d that is within the reach: convex, so a bisection finds it.
  double most = 0, beyond = 1;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (most + beyond);
    (reach_.contains(p + middle * d) ? most : beyond) = middle;
  }
  return most * d;
}

}  // namespace riffler::brush
