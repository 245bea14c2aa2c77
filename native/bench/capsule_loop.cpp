#include "bench/capsule_loop.hpp"

#include <algorithm>
#include <cmath>

#include "bench/scenes.hpp"

namespace riffler::bench {

namespace {

constexpr double kRadius = 3;

}  // namespace

CapsuleLoop::CapsuleLoop(double pitch)
    : h_(pitch),
      nx_(static_cast<int>(std::lround(kBlock.x / pitch))),
      ny_(static_cast<int>(std::lround(kBlock.y / pitch))) {
  reset();
}

void CapsuleLoop::reset() {
  top_.assign(static_cast<std::size_t>(nx_) * ny_, kBlock.z);
}

double CapsuleLoop::removed() const {
  double lost = 0;
  for (const double z : top_) lost += kBlock.z - z;
  return lost * h_ * h_;
}

void CapsuleLoop::run() {
  const double h = h_, r = kRadius;
  const int nx = nx_, ny = ny_;
  for (int k = 0; k < kMoves; ++k) {
    const Vec3 a = centre(k), v = centre(k + 1) - a;
    const double vv = glm::dot(v, v), vz = v.z;
    const int i0 = std::max(0, static_cast<int>((std::min(a.x, a.x + v.x) - r) / h));
    const int i1 = std::min(nx - 1, static_cast<int>((std::max(a.x, a.x + v.x) + r) / h));
    const int j0 = std::max(0, static_cast<int>((std::min(a.y, a.y + v.y) - r) / h));
    const int j1 = std::min(ny - 1, static_cast<int>((std::max(a.y, a.y + v.y) + r) / h));
    for (int i = i0; i <= i1; ++i)
      for (int j = j0; j <= j1; ++j) {
        const double x = (i + 0.5) * h - a.x, y = (j + 0.5) * h - a.y;
        double& z = top_[static_cast<std::size_t>(i) * ny + j];
        const auto end = [&](double t) {
          const double dx = x - t * v.x, dy = y - t * v.y, d = r * r - dx * dx - dy * dy;
          return d >= 0 ? a.z + t * vz - std::sqrt(d) : 1e300;
        };
        double low = std::min(end(0), end(1));
        // Side of the capsule: w = p − a − t v with t = (p − a) · v / v², |w| = r.
        const double b = x * v.x + y * v.y, qa = 1 - vz * vz / vv, qb = -b * vz / vv,
                     qc = x * x + y * y - b * b / vv - r * r;
        const double disc = qb * qb - qa * qc;
        if (disc >= 0) {
          const double s = (-qb - std::sqrt(disc)) / qa, t = (b + s * vz) / vv;
          if (t >= 0 && t <= 1) low = std::min(low, a.z + s);
        }
        if (low < z) z = low;
      }
  }
}

}  // namespace riffler::bench
