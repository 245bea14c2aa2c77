// Quadric error metric.
#pragma once

#include "geom/vec.hpp"

namespace riffler {

/// Sum of the squared distances from planes, each times its area, mm⁴ (Garland & Heckbert, SIGGRAPH 97, section 5).
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

  double operator()(const Vec3& p) const {
    const Vec3 a{xx * p.x + xy * p.y + zx * p.z, xy * p.x + yy * p.y + yz * p.z, zx * p.x + yz * p.y + zz * p.z};
    return glm::dot(p, a + 2.0 * b) + c;
  }
};

}  // namespace riffler
