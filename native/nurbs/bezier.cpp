#include "nurbs/bezier.hpp"

#include <algorithm>
#include <array>

namespace riffler::nurbs {

namespace {

using Basis = std::array<double, kMaxOrder>;

/// Raises Bernstein polynomials of degree `degree` - 1 in `b` to `degree`.
void raise(Basis& b, int degree, double t) {
  b[static_cast<std::size_t>(degree)] = t * b[static_cast<std::size_t>(degree) - 1];
  for (int i = degree - 1; i > 0; --i) {
    const auto k = static_cast<std::size_t>(i);
    b[k] = t * b[k - 1] + (1 - t) * b[k];
  }
  b[0] *= 1 - t;
}

/// Bernstein polynomials of one degree at t, with two derivatives.
struct Bernstein {
  Basis value{}, first{}, second{};

  Bernstein(int degree, double t) {
    Basis b{};
    b[0] = 1;
    for (int d = 1; d <= degree; ++d) {
      if (d == degree - 1) derive_twice(b, degree);
      if (d == degree) derive(b, degree);
      raise(b, d, t);
    }
    value = b;
  }

 private:
  /// From those of degree - 1.
  void derive(const Basis& b, int degree) {
    for (int i = 0; i <= degree; ++i) {
      const auto k = static_cast<std::size_t>(i);
      first[k] = degree * ((i > 0 ? b[k - 1] : 0) - (i < degree ? b[k] : 0));
    }
  }
  /// From those of degree - 2.
  void derive_twice(const Basis& b, int degree) {
    const auto at = [&](int i) { return i >= 0 && i <= degree - 2 ? b[static_cast<std::size_t>(i)] : 0.0; };
    for (int i = 0; i <= degree; ++i)
      second[static_cast<std::size_t>(i)] = degree * (degree - 1) * (at(i - 2) - 2 * at(i - 1) + at(i));
  }
};

/// Multi-affine value (blossom) of a B-spline of `degree` on the interval of knot `j`, for `from` copies of a and then
/// copies of b as arguments; `d` has the degree + 1 control points and is overwritten. Arguments in the interval make
/// convex combinations only.
Vec4 blossom(std::array<Vec4, kMaxOrder>& d, const std::vector<double>& knots, std::size_t j, int degree, int from,
             double a, double b) {
  const auto p = static_cast<std::size_t>(degree);
  for (std::size_t r = 1; r <= p; ++r) {
    const double x = static_cast<int>(r) <= from ? a : b;
    for (std::size_t i = p; i >= r; --i) {
      const double low = knots[j - p + i], high = knots[j + 1 + i - r];
      const double alpha = (x - low) / (high - low);
      d[i] = (1 - alpha) * d[i - 1] + alpha * d[i];
    }
  }
  return d[p];
}

/// Indices of the knots that begin an interval of positive length within the domain.
std::vector<std::size_t> intervals(const std::vector<double>& knots, int degree) {
  std::vector<std::size_t> found;
  const auto p = static_cast<std::size_t>(degree);
  for (std::size_t j = p; j + p + 1 < knots.size(); ++j)
    if (knots[j] < knots[j + 1]) found.push_back(j);
  return found;
}

}  // namespace

Jet4 jet_of(const Vec4* net, const Degrees& degrees, const Vec2& at) {
  const Bernstein bu(degrees.u, at.x), bv(degrees.v, at.y);
  Jet4 jet{Vec4(0), Vec4(0), Vec4(0), Vec4(0), Vec4(0), Vec4(0)};
  for (int i = 0; i <= degrees.u; ++i) {
    Vec4 s(0), v(0), vv(0);
    for (int j = 0; j <= degrees.v; ++j) {
      const auto k = static_cast<std::size_t>(j);
      const Vec4& h = net[degrees.at(i, j)];
      s += bv.value[k] * h, v += bv.first[k] * h, vv += bv.second[k] * h;
    }
    const auto k = static_cast<std::size_t>(i);
    jet.s += bu.value[k] * s, jet.u += bu.first[k] * s, jet.uu += bu.second[k] * s;
    jet.v += bu.value[k] * v, jet.uv += bu.first[k] * v, jet.vv += bu.value[k] * vv;
  }
  return jet;
}

Jet3 rational(const Jet4& h) {
  Jet3 r;
  const double w = h.s.w;
  r.s = Vec3(h.s) / w;
  r.u = (Vec3(h.u) - h.u.w * r.s) / w;
  r.v = (Vec3(h.v) - h.v.w * r.s) / w;
  r.uu = (Vec3(h.uu) - 2 * h.u.w * r.u - h.uu.w * r.s) / w;
  r.uv = (Vec3(h.uv) - h.u.w * r.v - h.v.w * r.u - h.uv.w * r.s) / w;
  r.vv = (Vec3(h.vv) - 2 * h.v.w * r.v - h.vv.w * r.s) / w;
  return r;
}

Vec4 curve_point(const Vec4* points, int count, double t) {
  std::array<Vec4, kMaxOrder> d;
  std::copy(points, points + count, d.begin());
  for (int r = count - 1; r > 0; --r)
    for (std::size_t i = 0; i < static_cast<std::size_t>(r); ++i) d[i] = (1 - t) * d[i] + t * d[i + 1];
  return d[0];
}

Vec4 point_of(const Vec4* net, const Degrees& degrees, const Vec2& at) {
  std::array<Vec4, kMaxOrder> rows;
  for (int i = 0; i <= degrees.u; ++i)
    rows[static_cast<std::size_t>(i)] = curve_point(net + degrees.at(i, 0), degrees.v + 1, at.y);
  return curve_point(rows.data(), degrees.u + 1, at.x);
}

void halve(const Vec4* net, const Degrees& degrees, bool along_u, Vec4* first, Vec4* second) {
  const int p = along_u ? degrees.u : degrees.v, lines = along_u ? degrees.v : degrees.u;
  const std::size_t step = along_u ? degrees.at(1, 0) : 1, next = along_u ? 1 : degrees.at(1, 0);
  std::copy(net, net + degrees.size(), second);
  for (std::size_t line = 0; line <= static_cast<std::size_t>(lines); ++line) {
    Vec4* d = second + line * next;
    Vec4* f = first + line * next;
    f[0] = d[0];
    for (int r = p; r > 0; --r) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(r); ++i)
        d[i * step] = 0.5 * (d[i * step] + d[(i + 1) * step]);
      f[static_cast<std::size_t>(p - r + 1) * step] = d[0];
    }
  }
}

Vec2 BezierSpan::to_patch(const Vec2& local) const {
  const auto mix = [](double a, double b, double t) { return t == 1 ? b : std::clamp(a + t * (b - a), a, b); };
  return {mix(lower.x, upper.x, local.x), mix(lower.y, upper.y, local.y)};
}

void append_spans(const Patch& patch, std::size_t index, const Vec3& origin, std::vector<BezierSpan>& spans) {
  const auto p = static_cast<std::size_t>(patch.degree_u), q = static_cast<std::size_t>(patch.degree_v);
  const Degrees degrees{patch.degree_u, patch.degree_v};
  std::array<Vec4, kMaxOrder> d;
  for (const std::size_t i : intervals(patch.knots_u, patch.degree_u)) {
    const double a = patch.knots_u[i], b = patch.knots_u[i + 1];
    std::vector<Vec4> rows((p + 1) * patch.count_v);  // Bézier in u, still B-splines in v
    for (std::size_t j = 0; j < patch.count_v; ++j)
      for (std::size_t k = 0; k <= p; ++k) {
        for (std::size_t l = 0; l <= p; ++l) {
          const std::size_t at = (i - p + l) * patch.count_v + j;
          d[l] = Vec4(patch.weights[at] * (patch.points[at] - origin), patch.weights[at]);
        }
        rows[k * patch.count_v + j] = blossom(d, patch.knots_u, i, patch.degree_u, static_cast<int>(p - k), a, b);
      }
    for (const std::size_t j : intervals(patch.knots_v, patch.degree_v)) {
      BezierSpan span{
          index, degrees, std::vector<Vec4>(degrees.size()), {a, patch.knots_v[j]}, {b, patch.knots_v[j + 1]}};
      for (std::size_t k = 0; k <= p; ++k)
        for (std::size_t l = 0; l <= q; ++l) {
          std::copy_n(rows.data() + k * patch.count_v + j - q, q + 1, d.begin());
          span.net[k * (q + 1) + l] =
              blossom(d, patch.knots_v, j, patch.degree_v, static_cast<int>(q - l), span.lower.y, span.upper.y);
        }
      spans.push_back(std::move(span));
    }
  }
}

}  // namespace riffler::nurbs
