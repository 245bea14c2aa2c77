#include "sweep/swept_piece.hpp"

#include <algorithm>
#include <cmath>

namespace riffler {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Interval kEverything{-kInfinity, kInfinity};
constexpr Interval kNothing{};

/// {s : q2 s² + 2 q1 s + q0 ≤ 0} for q2 ≥ 0, by roots that do not cancel. `tangent`: what, as a part of q1², rounding
/// may have taken from a double root.
Interval at_most_zero(double q2, double q1, double q0, double tangent = 0) {
  const double disc = q1 * q1 - q2 * q0;
  if (!(disc >= -tangent * q1 * q1)) return kNothing;
  const double q = -(q1 + std::copysign(std::sqrt(std::max(disc, 0.0)), q1));
  if (q == 0) return q2 > 0 ? Interval{0, 0} : (q0 <= 0 ? kEverything : kNothing);
  const double a = q2 == 0 ? std::copysign(kInfinity, q) : q / q2, b = q0 / q;
  return {std::min(a, b), std::max(a, b)};
}

/// {s : 0 ≤ at + slope · s ≤ height}.
Interval slab(double at, double slope, double height) {
  if (slope == 0) return at >= 0 && at <= height ? kEverything : kNothing;
  const double a = -at / slope, b = (height - at) / slope;
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

SweptPiece::SweptPiece(const Piece& piece, const Vec3& tip, const Vec3& axis, const Vec3& motion)
    : tip_(tip), axis_(axis), tilt_(std::hypot(axis.x, axis.y)), way_(glm::length(motion)) {
  direction_ = way_ > 0 ? motion / way_ : Vec3(0);
  if (tilt_ > 0) {
    e1_ = {-axis.z * axis.x / tilt_, -axis.z * axis.y / tilt_, tilt_};
    e2_ = {axis.y / tilt_, -axis.x / tilt_, 0};
  } else {
    e1_ = {1, 0, 0};
    e2_ = {0, axis.z, 0};
  }
  m1_ = glm::dot(direction_, e1_), m2_ = glm::dot(direction_, e2_), mo_ = glm::dot(direction_, axis);
  z0_ = bottom(piece), z1_ = top(piece);
  r0_ = radius_at(piece, z0_), r1_ = radius_at(piece, z1_);
  slope_ = (r1_ - r0_) / (z1_ - z0_);
  if (const auto* round = std::get_if<Round>(&piece)) {
    e_ = round->e, zc_ = round->zc, r_ = round->r;
    kind_ = e_ == 0 ? Kind::Ball : Kind::Torus;
    cut_bottom_ = z0_ > zc_ - r_, cut_top_ = z1_ < zc_ + r_;
  } else {
    kind_ = Kind::Frustum;
    cut_bottom_ = cut_top_ = true;
  }
  // A hit at an end of the side must not get lost to rounding: there the edge's own hits may be tangent.
  const double slack = 1e-11 * (std::abs(z0_) + std::abs(z1_) + std::max(r0_, r1_));
  // Where a ray meets the line that a cone's apex sweeps, two roots fall together and lose half of their digits.
  const double apex = 1e-7 * (z1_ - z0_);
  low_ = cut_bottom_ ? z0_ - (r0_ > 0 ? slack : apex) : -kInfinity;
  high_ = cut_top_ ? z1_ + (r1_ > 0 ? slack : apex) : kInfinity;
}

SweptPiece::Ray SweptPiece::ray(double u, double v) const {
  const double du = u - tip_.x, dv = v - tip_.y;
  return {du * e1_.x + dv * e1_.y, du * e2_.x + dv * e2_.y, du * axis_.x + dv * axis_.y, axis_.z};
}

bool SweptPiece::hit(double u, double v, SweptHit& near, SweptHit& far) const {
  const Ray ray = this->ray(u, v);
  Extremes out;
  switch (kind_) {
    case Kind::Frustum:
      frustum(ray, out);
      break;
    case Kind::Ball:
      ball(ray, out);
      break;
    case Kind::Torus:
      torus(ray, out);
      break;
  }
  if (!(out.near.s < out.far.s)) return false;
  near = out.near, far = out.far;
  near.s += tip_.z, far.s += tip_.z;
  return true;
}

Interval SweptPiece::slab_at(const Ray& ray, double way) const {
  return slab(ray.z - way * mo_ - z0_, ray.oz, z1_ - z0_);
}

Interval SweptPiece::frustum_at(const Ray& ray, double way) const {
  const Interval inside = slab_at(ray, way);
  if (inside.empty()) return kNothing;
  const double a = ray.x - way * m1_, b = ray.y - way * m2_;
  const double k = r0_ + slope_ * (ray.z - way * mo_ - z0_), grow = slope_ * ray.oz;
  const double q2 = tilt_ * tilt_ - grow * grow, q1 = a * tilt_ - k * grow, q0 = a * a + b * b - k * k;
  if (q2 >= 0) return inside.cut(at_most_zero(q2, q1, q0));
  // Steeper than the flank: the ray stays inside one nappe beyond a root; the slab lies on the nappe of radius ≥ 0.
  const double root = std::sqrt(std::max(0.0, q1 * q1 - q2 * q0)), q = -(q1 + std::copysign(root, q1));
  const double s1 = q / q2, s2 = q == 0 ? 0 : q0 / q;
  return inside.cut(grow > 0 ? Interval{std::max(s1, s2), kInfinity} : Interval{-kInfinity, std::min(s1, s2)});
}

void SweptPiece::face(const Ray& ray, double z, double radius, Surface flat, Surface rim, Extremes& out) const {
  // The face's plane cuts the section in a line: oz s − mo τ = z − ray.z.
  const double norm = std::hypot(ray.oz, mo_);
  if (norm < 1e-12) return;  // ray and motion lie in the plane: the side's own hits bound the section
  const double ds = mo_ / norm, dt = ray.oz / norm, at = (z - ray.z) / norm;
  const double s0 = at * dt, t0 = -at * ds;
  const double a = ray.x + s0 * tilt_ - t0 * m1_, b = ray.y - t0 * m2_;
  const double da = ds * tilt_ - dt * m1_, db = -dt * m2_;
  const Interval disc = at_most_zero(da * da + db * db, a * da + b * db, a * a + b * b - radius * radius);
  const Interval line =
      disc.cut(dt == 0 ? (t0 >= 0 && t0 <= way_ ? kEverything : kNothing)
                       : Interval{std::min(-t0 / dt, (way_ - t0) / dt), std::max(-t0 / dt, (way_ - t0) / dt)});
  if (line.empty() || !std::isfinite(line.near) || !std::isfinite(line.far)) return;
  const bool level = std::abs(mo_) < 1e-12;  // a face that slides in its own plane stays a face
  for (const double l : {line.near, line.far})
    out.add(s0 + l * ds, std::clamp(t0 + l * dt, 0.0, way_), !level && (l == disc.near || l == disc.far) ? rim : flat);
}

void SweptPiece::frustum(const Ray& ray, Extremes& out) const {
  for (const double way : {0.0, way_}) {
    const Interval at = frustum_at(ray, way);
    if (at.empty() || !std::isfinite(at.near) || !std::isfinite(at.far)) continue;
    const Interval inside = slab_at(ray, way);
    const bool up = ray.oz > 0;  // which face the ray enters the slab through
    out.add(at.near, way, at.near == inside.near ? (up ? Surface::Bottom : Surface::Top) : Surface::Lateral);
    out.add(at.far, way, at.far == inside.far ? (up ? Surface::Top : Surface::Bottom) : Surface::Lateral);
    if (way_ == 0) return;
  }
  face(ray, z0_, r0_, Surface::Bottom, Surface::Rim0, out);
  face(ray, z1_, r1_, Surface::Top, Surface::Rim1, out);
  // Silhouette n · V = 0: F = ρ² − k², ∂F/∂τ = 0 is a line α s + β τ + γ = 0 of the section, on which F is quadratic.
  const double k0 = r0_ + slope_ * (ray.z - z0_);
  const double alpha = slope_ * slope_ * ray.oz * mo_ - tilt_ * m1_;
  const double beta = m1_ * m1_ + m2_ * m2_ - slope_ * slope_ * mo_ * mo_;
  const double gamma = k0 * slope_ * mo_ - ray.x * m1_ - ray.y * m2_;
  const double norm = std::hypot(alpha, beta);
  if (norm < 1e-14) return;  // the motion runs along the flank: both ends and both faces bound the section
  const double ds = beta / norm, dt = -alpha / norm, s0 = -gamma * alpha / (norm * norm),
               t0 = -gamma * beta / (norm * norm);
  const double a = ray.x + s0 * tilt_ - t0 * m1_, da = ds * tilt_ - dt * m1_;
  const double b = ray.y - t0 * m2_, db = -dt * m2_;
  const double k = k0 + slope_ * (ray.oz * s0 - mo_ * t0), dk = slope_ * (ray.oz * ds - mo_ * dt);
  double q2 = da * da + db * db - dk * dk, q1 = a * da + b * db - k * dk, q0 = a * a + b * b - k * k;
  if (q2 < 0) q2 = -q2, q1 = -q1, q0 = -q0;
  const Interval roots = at_most_zero(q2, q1, q0, SweptShape::kTangent);
  if (roots.empty()) return;
  for (const double l : {roots.near, roots.far}) {
    const double s = s0 + l * ds, t = t0 + l * dt, z = ray.z + ray.oz * s - mo_ * t;
    if (t >= 0 && t <= way_ && z >= low_ && z <= high_) out.add(s, t, Surface::Lateral);
  }
}

void SweptPiece::clip_faces(const Ray& ray, Extremes& out) const {
  if (cut_bottom_) face(ray, z0_, r0_, Surface::Bottom, Surface::Rim0, out);
  if (cut_top_) face(ray, z1_, r1_, Surface::Top, Surface::Rim1, out);
}

void SweptPiece::ball(const Ray& ray, Extremes& out) const {
  // Distance from the ray to the moving centre, in the frame (e1, e2, axis).
  const double zc = ray.z - zc_;
  const bool cut = cut_bottom_ || cut_top_;
  const auto section = [&](double way) {
    const double a = ray.x - way * m1_, b = ray.y - way * m2_, c = zc - way * mo_;
    return at_most_zero(1, a * tilt_ + c * ray.oz, a * a + b * b + c * c - r_ * r_);
  };
  for (const double way : {0.0, way_}) {
    Interval at = section(way);
    Surface low = Surface::Lateral, high = Surface::Lateral;
    if (cut) {
      const Interval inside = slab_at(ray, way);
      const bool up = ray.oz > 0;
      if (inside.near > at.near) low = up ? Surface::Bottom : Surface::Top;
      if (inside.far < at.far) high = up ? Surface::Top : Surface::Bottom;
      at = at.cut(inside);
    }
    if (!at.empty()) out.add(at.near, way, low), out.add(at.far, way, high);
    if (way_ == 0) return;
  }
  if (cut) clip_faces(ray, out);
  // The cylinder about the centre's way: F = |w|² − r² with ∂F/∂τ = 0, that is τ = w · V.
  const double p0 = ray.x * m1_ + ray.y * m2_ + zc * mo_, p1 = tilt_ * m1_ + ray.oz * mo_;
  const double a = ray.x - p0 * m1_, b = ray.y - p0 * m2_, c = zc - p0 * mo_;
  const double da = tilt_ - p1 * m1_, db = -p1 * m2_, dc = ray.oz - p1 * mo_;
  const Interval side =
      at_most_zero(da * da + db * db + dc * dc, a * da + b * db + c * dc, a * a + b * b + c * c - r_ * r_);
  if (side.empty()) return;
  for (const double s : {side.near, side.far}) {
    const double t = p0 + s * p1, z = ray.z + ray.oz * s - mo_ * t;
    if (t >= 0 && t <= way_ && z >= low_ && z <= high_) out.add(s, t, Surface::Lateral);
  }
}

SweptShape SweptPiece::shape() const {
  SweptShape s{kind_, cut_bottom_, cut_top_, {},  {},  {},     {}, tilt_, axis_.z, way_, m1_,  m2_,
               mo_,   z0_,         z1_,      r0_, r1_, slope_, e_, zc_,   r_,      low_, high_};
  for (int i = 0; i < 3; ++i) s.tip[i] = tip_[i], s.axis[i] = axis_[i], s.e1[i] = e1_[i], s.e2[i] = e2_[i];
  return s;
}

Vec3 SweptPiece::normal(double u, double v, const SweptHit& hit) const {
  const Vec3 w = Vec3(u, v, hit.s) - tip_ - hit.way * direction_;
  const double z = glm::dot(w, axis_);
  const Vec3 out = w - z * axis_;
  const double rho = glm::length(out);
  const Vec3 radial = rho > 0 ? out / rho : e1_;
  switch (hit.surface) {
    case Surface::Bottom:
      return -axis_;
    case Surface::Top:
      return axis_;
    case Surface::Rim0:
    case Surface::Rim1: {
      const Vec3 n = glm::cross(glm::cross(axis_, radial), direction_);
      const double length = glm::length(n);
      if (!(length > 1e-12)) return radial;
      return n * ((glm::dot(n, radial) < 0 ? -1.0 : 1.0) / length);
    }
    case Surface::Lateral:
      break;
  }
  if (kind_ == Kind::Frustum) return (radial - slope_ * axis_) / std::hypot(1.0, slope_);
  const Vec3 n = std::max(rho - e_, 0.0) * radial + (z - zc_) * axis_;
  const double length = glm::length(n);
  return length > 0 ? n / length : radial;
}

}  // namespace riffler
