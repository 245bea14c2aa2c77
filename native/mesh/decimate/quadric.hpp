// Quadric error metric.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::mesh {

/// Sum of the squared distances from planes, each weighted by its area, mm⁴ (Garland & Heckbert, SIGGRAPH 97, section
/// 5).
struct Quadric {
  // xᵀ A x + 2 bᵀ x + c
  double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
  Vec3 b{0};
  double c = 0;

  Quadric() = default;
  Quadric(const Vec3& n, const Vec3& point, double w)
      : xx(w * n.x * n.x),
        yy(w * n.y * n.y),
        zz(w * n.z * n.z),
        xy(w * n.x * n.y),
        yz(w * n.y * n.z),
        zx(w * n.z * n.x) {
    const double d = -glm::dot(n, point);
    b = (w * d) * n;
    c = w * d * d;
  }

  Quadric& operator+=(const Quadric& q) {
    xx += q.xx, yy += q.yy, zz += q.zz, xy += q.xy, yz += q.yz, zx += q.zx;
    b += q.b, c += q.c;
    return *this;
  }

  Vec3 times(const Vec3& p) const {
    return {xx * p.x + xy * p.y + zx * p.z, xy * p.x + yy * p.y + yz * p.z, zx * p.x + yz * p.y + zz * p.z};
  }

  double operator()(const Vec3& p) const { return glm::dot(p, times(p) + 2.0 * b) + c; }

  /// Sum of the weights, mm².
  double weight() const { return xx + yy + zz; }

  /// (A + hold I)⁻¹ r by cofactors. It exists for hold > 0. Where A does not constrain a direction (along a crease or
  /// in a plane), the result has a component in that direction only if r has.
  Vec3 solved(const Vec3& r, double hold) const {
    const double x = xx + hold, y = yy + hold, z = zz + hold;
    const double cx = y * z - yz * yz, cy = zx * yz - xy * z, cz = xy * yz - y * zx, co = xy * zx - x * yz;
    const double det = x * cx + xy * cy + zx * cz;
    return Vec3(cx * r.x + cy * r.y + cz * r.z, cy * r.x + (x * z - zx * zx) * r.y + co * r.z,
                cz * r.x + co * r.y + (x * y - xy * xy) * r.z) *
           (1 / det);
  }
};

}  // namespace riffler::mesh
