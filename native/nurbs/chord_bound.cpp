#include "nurbs/chord_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace riffler::nurbs {

namespace {

constexpr std::size_t kMaxRaised = std::size_t{kMaxOrder + 1} * (kMaxOrder + 1);
/// What rounding can hide, relative.
constexpr double kSafety = 1 + 1e-9;

/// The net with T subtracted from its points, where T is the plane that is tangent in the middle: A = N - w T, of one
/// degree more in each direction. Second derivatives of A / w are those of the surface, since those of T are 0, but
/// values and first derivatives are small, and so is what their products add to the bounds.
struct RaisedNet {
  Degrees degrees;
  std::array<Vec4, kMaxRaised> net;  // (A, w)

  RaisedNet(const Vec4* given, const Degrees& d) : degrees{d.u + 1, d.v + 1} {
    const Jet3 jet = rational(jet_of(given, d, Vec2(0.5)));
    std::array<Vec3, 4> corners;  // of T
    for (int k = 0; k < 4; ++k)
      corners[static_cast<std::size_t>(k)] = jet.s + (k / 2 - 0.5) * jet.u + (k % 2 - 0.5) * jet.v;
    for (int i = 0; i <= degrees.u; ++i)
      for (int j = 0; j <= degrees.v; ++j) {
        Vec4 sum(0);
        for (int k = 0; k < 4; ++k) {
          const int s = k / 2, t = k % 2;
          const double share = weight(i, s, degrees.u) * weight(j, t, degrees.v);
          if (share == 0) continue;
          const Vec4& h = given[d.at(i - s, j - t)];
          sum += share * Vec4(Vec3(h) - h.w * corners[static_cast<std::size_t>(k)], h.w);
        }
        net[degrees.at(i, j)] = sum;
      }
  }

  /// Share of a product's control point i that comes from point i - s and end s of the linear factor.
  static double weight(int i, int s, int degree) { return (s ? i : degree - i) / static_cast<double>(degree); }

  /// Largest length of a derivative of the numerator (x), and size of that of the weight (y).
  Vec2 bound(int u, int v) const {
    Vec2 most(0);
    for (int i = 0; i + u <= degrees.u; ++i)
      for (int j = 0; j + v <= degrees.v; ++j) {
        const Vec4 d = difference(i, j, u, v);
        most = glm::max(most, Vec2(glm::length(Vec3(d)), std::abs(d.w)));
      }
    double factor = 1;
    for (int k = 0; k < u; ++k) factor *= degrees.u - k;
    for (int k = 0; k < v; ++k) factor *= degrees.v - k;
    return factor * most;
  }

 private:
  Vec4 difference(int i, int j, int u, int v) const {
    if (u > 0) return difference(i + 1, j, u - 1, v) - difference(i, j, u - 1, v);
    if (v > 0) return difference(i, j + 1, u, v - 1) - difference(i, j, u, v - 1);
    return net[degrees.at(i, j)];
  }
};

}  // namespace

SecondDerivatives second_derivatives(const Vec4* net, const Degrees& degrees) {
  const RaisedNet raised(net, degrees);
  double s = 0, w = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < raised.degrees.size(); ++k) {
    s = std::max(s, glm::length(affine(raised.net[k])));
    w = std::min(w, raised.net[k].w);
  }
  // w S' = A' - w' S and so on, each term with its largest length and the smallest weight.
  const Vec2 au = raised.bound(1, 0), av = raised.bound(0, 1);
  const double su = (au.x + au.y * s) / w, sv = (av.x + av.y * s) / w;
  const Vec2 auu = raised.bound(2, 0), auv = raised.bound(1, 1), avv = raised.bound(0, 2);
  return {kSafety * (auu.x + 2 * au.y * su + auu.y * s) / w, kSafety * (auv.x + au.y * sv + av.y * su + auv.y * s) / w,
          kSafety * (avv.x + 2 * av.y * sv + avv.y * s) / w};
}

SecondDerivatives second_derivatives_in_middle(const Vec4* net, const Degrees& degrees) {
  const Jet3 jet = rational(jet_of(net, degrees, Vec2(0.5)));
  return {glm::length(jet.uu), glm::length(jet.uv), glm::length(jet.vv)};
}

}  // namespace riffler::nurbs
