#include "nurbs/normal.hpp"

#include <cmath>

namespace riffler::nurbs {

namespace {

/// Sine of an angle below which two directions count as parallel.
constexpr double kParallel = 1e-9;
/// A derivative shorter than this, relative to the coordinates it is computed from, has fewer than four correct digits.
constexpr double kNoise = 1e-11;

/// Makes n a unit vector, unless its length is 0 compared with `size`.
bool unit(Vec3& n, double size) {
  const double length = glm::length(n);
  if (!(length > kParallel * size) || !std::isfinite(length)) return false;
  n /= length;
  return true;
}

double largest(const Vec4* net, const Degrees& degrees) {
  double most = 0;
  for (std::size_t k = 0; k < degrees.size(); ++k) most = std::fmax(most, glm::length(affine(net[k])));
  return most;
}

}  // namespace

Vec3 normal_of(const Vec4* net, const Degrees& degrees, const Vec2& at) {
  const Jet4 h = jet_of(net, degrees, at);
  const Jet3 jet = rational(h);
  const double size = largest(net, degrees), su = glm::length(jet.u), sv = glm::length(jet.v);
  const bool pole_u = su <= kNoise * size * (degrees.u + std::abs(h.u.w) / h.s.w);
  const bool pole_v = sv <= kNoise * size * (degrees.v + std::abs(h.v.w) / h.s.w);
  Vec3 n = glm::cross(jet.u, jet.v);
  if (!pole_u && !pole_v && unit(n, su * sv)) return n;
  // Where the product vanishes, take its derivative towards the middle of the net.
  const Vec2 way = Vec2(0.5) - at;
  n = way.x * (glm::cross(jet.uu, jet.v) + glm::cross(jet.u, jet.uv)) +
      way.y * (glm::cross(jet.uv, jet.v) + glm::cross(jet.u, jet.vv));
  const double second = glm::length(jet.uu) + glm::length(jet.uv) + glm::length(jet.vv);
  if (pole_u != pole_v && unit(n, (su + sv) * second)) return n;
  // At a pole of a higher order, or close to one, take the normal a little inside.
  for (const double share : {0.0, 1e-6, 1e-4, 1e-2, 0.1, 0.5, 1.0}) {
    const Jet3 inside = rational(jet_of(net, degrees, at + share * way));
    n = glm::cross(inside.u, inside.v);
    if (unit(n, glm::length(inside.u) * glm::length(inside.v))) return n;
  }
  return Vec3(0);
}

}  // namespace riffler::nurbs
