// Rational Bézier patches: nets of homogeneous control points (w x, w y, w z, w), mm, over the unit square.
// A net of degrees (p, q) is an array of (p + 1)(q + 1) points; point (i, j) has the index i (q + 1) + j.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/nurbs/patch.hpp"

namespace riffler::nurbs {

using Vec4 = glm::dvec4;

inline constexpr int kMaxOrder = kMaxDegree + 1;
inline constexpr std::size_t kMaxNet = std::size_t{kMaxOrder} * kMaxOrder;

/// Degrees of a net.
struct Degrees {
  int u = 1, v = 1;

  std::size_t size() const { return static_cast<std::size_t>((u + 1) * (v + 1)); }
  std::size_t at(int i, int j) const { return static_cast<std::size_t>(i * (v + 1) + j); }
};

/// The affine point of a homogeneous one.
inline Vec3 affine(const Vec4& h) {
  return Vec3(h) / h.w;
}

/// Value and derivatives to the second order of a homogeneous net.
struct Jet4 {
  Vec4 s, u, v, uu, uv, vv;
};
/// The same for the rational surface.
struct Jet3 {
  Vec3 s, u, v, uu, uv, vv;
};
Jet4 jet_of(const Vec4* net, const Degrees& degrees, const Vec2& at);
Jet3 rational(const Jet4& h);

/// The point at `at`.
Vec4 point_of(const Vec4* net, const Degrees& degrees, const Vec2& at);
/// The point at t of a curve of `count` control points.
Vec4 curve_point(const Vec4* points, int count, double t);

/// Splits a net at the middle of u (`along_u`) or of v by de Casteljau's algorithm, which makes convex combinations
/// only. `first` and `second` may not overlap with `net`.
void halve(const Vec4* net, const Degrees& degrees, bool along_u, Vec4* first, Vec4* second);

/// A span of a patch between neighbouring knots, as a Bézier net about the surface's origin.
struct BezierSpan {
  std::size_t patch = 0;
  Degrees degrees;
  std::vector<Vec4> net;
  Vec2 lower{0}, upper{1};  // of the patch's domain

  Vec2 to_patch(const Vec2& local) const;
};

/// Appends the spans of a patch, u outermost, with coordinates relative to `origin`.
void append_spans(const Patch& patch, std::size_t index, const Vec3& origin, std::vector<BezierSpan>& spans);

}  // namespace riffler::nurbs
