#include "nurbs/foot.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::nurbs {

namespace {

/// Half the squared distance from the origin with its derivatives.
struct Slope {
  double value, u, v, uu, uv, vv;
  double gauss_uu, gauss_uv, gauss_vv;  // of the tangents only: never negative

  explicit Slope(const Jet3& s)
      : value(0.5 * glm::dot(s.s, s.s)),
        u(glm::dot(s.s, s.u)),
        v(glm::dot(s.s, s.v)),
        gauss_uu(glm::dot(s.u, s.u)),
        gauss_uv(glm::dot(s.u, s.v)),
        gauss_vv(glm::dot(s.v, s.v)) {
    uu = gauss_uu + glm::dot(s.s, s.uu), uv = gauss_uv + glm::dot(s.s, s.uv), vv = gauss_vv + glm::dot(s.s, s.vv);
  }
};

/// Solves [a b; b c] x = -(r, s). False unless the matrix is positive definite.
bool solve(double a, double b, double c, double r, double s, Vec2& x) {
  const double det = a * c - b * b;
  if (!(a > 0 && c > 0 && det > 1e-14 * a * c)) return false;
  x = Vec2(b * s - c * r, b * r - a * s) / det;
  return true;
}

/// Whether the minimum is beyond the border at t.
bool held(double t, double slope) {
  return (t <= 0 && slope > 0) || (t >= 1 && slope < 0);
}

/// Newton's step, or, with `tangents`, that of Gauss and Newton, which needs no second derivatives of the surface: in
/// small nets those are rounding only.
Vec2 step(const Slope& f, bool tangents, bool hold_u, bool hold_v) {
  const auto along = [&](double slope, double newton, double gauss) {
    const double bend = newton > 0 && !tangents ? newton : gauss;
    return bend > 0 ? -slope / bend : 0.0;
  };
  if (hold_u) return {0, hold_v ? 0 : along(f.v, f.vv, f.gauss_vv)};
  if (hold_v) return {along(f.u, f.uu, f.gauss_uu), 0};
  Vec2 x(0);
  if (!tangents && solve(f.uu, f.uv, f.vv, f.u, f.v, x)) return x;
  if (solve(f.gauss_uu, f.gauss_uv, f.gauss_vv, f.u, f.v, x)) return x;
  return {along(f.u, f.uu, f.gauss_uu), along(f.v, f.vv, f.gauss_vv)};
}

/// The nearest of the corners and `at`.
Vec2 best_start(const Vec4* net, const Degrees& degrees, const Vec2& at) {
  const Vec4 middle = point_of(net, degrees, at);
  double nearest = glm::dot(affine(middle), affine(middle));
  Vec2 best = at;
  for (int k = 0; k < 4; ++k) {
    const Vec3 p = affine(net[degrees.at(k / 2 * degrees.u, k % 2 * degrees.v)]);
    if (glm::dot(p, p) < nearest) nearest = glm::dot(p, p), best = Vec2(k / 2, k % 2);
  }
  return best;
}

/// Moves along x, or a part of it, to a smaller distance.
bool move(const Vec4* net, const Degrees& degrees, const Vec2& x, Vec2& at, Slope& f) {
  for (double share = 1; share > 1e-3; share *= 0.25) {
    const Vec2 next = glm::clamp(at + share * x, 0.0, 1.0);
    if (next == at) return false;
    const Slope g(rational(jet_of(net, degrees, next)));
    if (!(g.value < f.value)) continue;
    at = next, f = g;
    return true;
  }
  return false;
}

}  // namespace

double walk_to_foot(const Vec4* net, const Degrees& degrees, Vec2& at) {
  at = best_start(net, degrees, at);
  Slope f(rational(jet_of(net, degrees, at)));
  for (int round = 0; round < 24; ++round) {
    const double before = f.value;
    const bool hold_u = held(at.x, f.u), hold_v = held(at.y, f.v);
    if (!move(net, degrees, step(f, false, hold_u, hold_v), at, f) &&
        !move(net, degrees, step(f, true, hold_u, hold_v), at, f))
      break;
    if (before - f.value <= 1e-15 * f.value) break;
  }
  return 2 * f.value;
}

}  // namespace riffler::nurbs
