// A polynomial that is a quadratic form of a Bézier net's homogeneous points: bounded by its coefficients.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "nurbs/bezier.hpp"
#include "nurbs/binomials.hpp"

namespace riffler::nurbs {

/// G(u, v) = B(h, h) for the point h of a net of degrees (p, q) and a symmetric bilinear form B: a polynomial of
/// degrees (2 p, 2 q). G ≥ 0 wherever none of its coefficients is negative, or where it is convex and a tangent plane
/// is not.
struct Excess {
  Degrees degrees;
  std::vector<double> g;

  template <class Form>
  void set(const Vec4* net, const Degrees& of_net, const Form& form) {
    degrees = {2 * of_net.u, 2 * of_net.v};
    g.assign(degrees.size(), 0);
    for (int i = 0; i <= of_net.u; ++i)
      for (int k = 0; k <= of_net.u; ++k) {
        const double share_u = kBinomials(of_net.u, i) * kBinomials(of_net.u, k) / kBinomials(degrees.u, i + k);
        for (int j = 0; j <= of_net.v; ++j)
          for (int l = 0; l <= of_net.v; ++l) {
            const double share_v = kBinomials(of_net.v, j) * kBinomials(of_net.v, l) / kBinomials(degrees.v, j + l);
            g[degrees.at(i + k, j + l)] += share_u * share_v * form(net[of_net.at(i, j)], net[of_net.at(k, l)]);
          }
      }
  }

  double at(int i, int j) const { return g[degrees.at(i, j)]; }
  bool positive() const {
    return std::all_of(g.begin(), g.end(), [](double x) { return x >= 0; });
  }
  Vec2 bend() const;
  bool convex() const;

  /// Whether a convex G is not negative in the unit square, by its tangent plane at `at`; `h`: the net's jet there.
  template <class Form>
  static bool tangent_is_positive(const Jet4& h, const Vec2& at, const Form& form) {
    const auto lowest = [](double slope, double t) { return std::min(-slope * t, slope * (1 - t)); };
    return form(h.s, h.s) + lowest(2 * form(h.s, h.u), at.x) + lowest(2 * form(h.s, h.v), at.y) >= 0;
  }
};

/// Largest second differences along u and v, times the share in which a coefficient exceeds the polynomial.
inline Vec2 Excess::bend() const {
  Vec2 most(0);
  for (int i = 0; i <= degrees.u; ++i)
    for (int j = 0; j <= degrees.v; ++j) {
      if (i + 2 <= degrees.u) most.x = std::max(most.x, std::abs(at(i + 2, j) - 2 * at(i + 1, j) + at(i, j)));
      if (j + 2 <= degrees.v) most.y = std::max(most.y, std::abs(at(i, j + 2) - 2 * at(i, j + 1) + at(i, j)));
    }
  return {most.x * degrees.u, most.y * degrees.v};
}

/// Whether the coefficients of its second derivatives show that G is convex.
inline bool Excess::convex() const {
  double uu = std::numeric_limits<double>::infinity(), vv = uu, uv = 0;
  for (int i = 0; i <= degrees.u; ++i)
    for (int j = 0; j <= degrees.v; ++j) {
      if (i + 2 <= degrees.u) uu = std::min(uu, at(i + 2, j) - 2 * at(i + 1, j) + at(i, j));
      if (j + 2 <= degrees.v) vv = std::min(vv, at(i, j + 2) - 2 * at(i, j + 1) + at(i, j));
      if (i < degrees.u && j < degrees.v)
        uv = std::max(uv, std::abs(at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)));
    }
  if (degrees.u < 2) uu = 0;
  if (degrees.v < 2) vv = 0;
  uu *= degrees.u * (degrees.u - 1), vv *= degrees.v * (degrees.v - 1), uv *= degrees.u * degrees.v;
  return uu >= 0 && vv >= 0 && uu * vv >= uv * uv;
}

}  // namespace riffler::nurbs
