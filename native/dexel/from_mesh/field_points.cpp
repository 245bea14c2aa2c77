#include "dexel/from_mesh/field_points.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dexel/from_mesh/field_points.cpp"
// Keep clang-format from sorting foreach_target.h to another place.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "base/lanes-inl.hpp"
#include "geom/math.hpp"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace riffler::dexel::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

namespace {

/// Minimum distance from an edge, so that no power of its inverse overflows.
constexpr double kNearest = 1e-60;

/// The argument of x + i y, accurate to about 1e-15; 0 if both are 0.
HWY_INLINE V argument(V y, V x) {
  // Minimax on |t| ≤ tan(π/8).
  constexpr double kTerms[] = {0.999999999999999,   -0.33333333333225346, 0.19999999979064806, -0.14285712703599635,
                               0.1111105014128838,  -0.0908955196197012,  0.07673754725729674, -0.06507248974177914,
                               0.05028683586153897, -0.02536687527193499};
  const V ax = hn::Abs(x), ay = hn::Abs(y), low = hn::Min(ax, ay), high = hn::Max(ax, ay);
  const M steep = hn::Gt(low, mul(high, set(0.41421356237309503)));
  const V below = pick(steep, add(high, low), high);
  const V t = hn::Div(pick(steep, sub(low, high), low), pick(hn::Gt(below, zero()), below, set(1)));
  const V square = mul(t, t);
  V sum = set(kTerms[9]);
  for (int k = 8; k >= 0; --k) sum = add(mul(sum, square), set(kTerms[k]));
  V angle = add(mul(sum, t), pick(steep, set(kPi / 4), zero()));
  angle = pick(hn::Gt(ay, ax), sub(set(kPi / 2), angle), angle);
  angle = pick(hn::Lt(x, zero()), sub(set(kPi), angle), angle);
  return hn::CopySignToAbs(angle, y);
}

/// The direction to a point in stereographic coordinates up to a positive factor, (t : α) = (t : f α).
struct Stereographic {
  V t, f;
};
HWY_INLINE Stereographic stereographic(V z, V rr, V length) {
  const M below = hn::Lt(z, zero());
  return {pick(below, rr, add(length, z)), pick(below, sub(length, z), set(1))};
}

/// A point of the path relative to the evaluated points.
struct Seen {
  V x, y, z, rr, square, length;
};
HWY_INLINE Seen see(const PathPoint& p, V px, V py, V pz) {
  // A boundary vertex exactly above or below a point has no horizontal direction. Any direction works, because it
  // enters both its edges and cancels.
  constexpr double kNone = 1.0 / (1LL << 36);
  Seen s;
  s.x = set(p.x), s.y = set(p.y), s.z = set(p.z);
  if (p.finite) s.x = sub(s.x, px), s.y = sub(s.y, py), s.z = sub(s.z, pz);
  s.rr = add(mul(s.x, s.x), mul(s.y, s.y));
  const M over = hn::Eq(s.rr, zero());
  s.x = pick(over, set(kNone), s.x), s.rr = pick(over, set(kNone * kNone), s.rr);
  s.square = add(s.rr, mul(s.z, s.z));
  s.length = hn::Sqrt(s.square);
  return s;
}

/// Sums over the edges.
struct Sums {
  V re, im;  // product of the factors
  V gx, gy, gz;
  V curvature, piece, closest;  // for the current piece: sum, and 1 / distance²

  static HWY_INLINE Sums none() { return {set(1), zero(), zero(), zero(), zero(), zero(), zero(), zero()}; }

  HWY_INLINE void rescale() {
    const V scale = hn::Div(set(1), add(add(hn::Abs(re), hn::Abs(im)), set(1e-300)));
    re = mul(re, scale), im = mul(im, scale);
  }

  template <bool kFull>
  HWY_INLINE void edge(const PathPoint& from, const PathPoint& to, const Seen& a, const Seen& b, const Stereographic& s,
                       const Stereographic& t) {
    const V dot = add(mul(a.x, b.x), mul(a.y, b.y)), cross = sub(mul(a.x, b.y), mul(a.y, b.x));
    const V f = mul(s.f, t.f), x = add(mul(s.t, t.t), mul(f, dot)), y = mul(f, cross);
    const V turned = sub(mul(re, x), mul(im, y));
    im = add(mul(re, y), mul(im, x)), re = turned;

    const V product = mul(a.length, b.length), below = mul(product, add(product, add(dot, mul(a.z, b.z))));
    const V around = from.finite ? (to.finite ? add(a.length, b.length) : b.length) : a.length;
    const M seen = hn::Gt(below, zero());
    const V weight = hn::Div(pick(seen, around, zero()), pick(seen, below, set(1)));
    gz = add(gz, mul(cross, weight));
    if constexpr (kFull) {
      gx = add(gx, mul(sub(mul(a.y, b.z), mul(a.z, b.y)), weight));
      gy = add(gy, mul(sub(mul(a.z, b.x), mul(a.x, b.z)), weight));
    }
  }

  /// |∇(dl × r / |r|³)| ≤ 2 |dl| / |r|³, integrated over the edge or over the whole line. For the surface that a loop
  /// spans, third derivatives of 1/r are at most 6 / r⁴.
  HWY_INLINE void bound(const PathPoint& to, const Seen& a, const Seen& b, V half_x, V half_y, V half_z) {
    const V ex = sub(b.x, a.x), ey = sub(b.y, a.y), ez = sub(b.z, a.z);
    const V along = add(add(mul(a.x, ex), mul(a.y, ey)), mul(a.z, ez));
    const V t = hn::Min(hn::Max(mul(along, set(-to.inverse_square)), zero()), set(1));
    const V qx = add(a.x, mul(t, ex)), qy = add(a.y, mul(t, ey)), qz = add(a.z, mul(t, ez));
    // Let q be the edge's point nearest to the box's centre. The edge lies behind the plane through q perpendicular to
    // the line from the centre; the box extends by `reach` towards that plane.
    const V away = hn::Sqrt(add(add(mul(qx, qx), mul(qy, qy)), mul(qz, qz)));
    const V reach = add(add(mul(hn::Abs(qx), half_x), mul(hn::Abs(qy), half_y)), mul(hn::Abs(qz), half_z));
    const V d = sub(away, hn::Div(reach, hn::Max(away, set(kNearest))));
    const V inverse = hn::Div(set(1), hn::Max(d, set(kNearest))), square = mul(inverse, inverse);
    piece = add(piece, mul(hn::Min(mul(set(to.half_length), inverse), set(1)), square));
    closest = hn::Max(closest, square);
    if (!to.ends) return;
    curvature = add(curvature, hn::Min(piece, mul(set(to.area), mul(closest, closest))));
    piece = closest = zero();
  }
};

constexpr int kSide = LocalExpansion::kDegree + 1;

/// Evaluates the polynomial by Horner's scheme, z outermost.
template <bool kFull>
HWY_INLINE V far_field(const LocalExpansion& far, V x, V y, V z, V& gx, V& gy, V& gz) {
  V in_z[kSide], by_x[kSide], by_z[kSide];  // in y
  for (int j = 0; j < kSide; ++j) in_z[j] = by_x[j] = by_z[j] = zero();
  for (int k = kSide - 1; k >= 0; --k) {
    V c[kSide], slope[kSide];
    for (int j = 0; j < kSide; ++j) c[j] = slope[j] = zero();
    for (int i = kSide - 1 - k; i >= 0; --i) {
      const double* row = far.terms(k, i);
      for (int j = 0; i + j + k < kSide; ++j) {
        if constexpr (kFull) slope[j] = add(mul(slope[j], x), c[j]);
        c[j] = add(mul(c[j], x), set(row[j]));
      }
    }
    for (int j = 0; j + k < kSide; ++j) {
      by_z[j] = add(mul(by_z[j], z), in_z[j]), in_z[j] = add(mul(in_z[j], z), c[j]);
      if constexpr (kFull) by_x[j] = add(mul(by_x[j], z), slope[j]);
    }
  }
  V value = zero();
  gx = gy = gz = zero();
  for (int j = kSide - 1; j >= 0; --j) {
    if constexpr (kFull) gx = add(mul(gx, y), by_x[j]), gy = add(mul(gy, y), value);
    gz = add(mul(gz, y), by_z[j]);
    value = add(mul(value, y), in_z[j]);
  }
  return value;
}

template <bool kFull>
HWY_INLINE void evaluate(std::span<const PathPoint> path, const LocalExpansion& far, const Vec3& centre,
                         const FieldPoints& points, FieldValues& values) {
  for (std::size_t at = 0; at < kPoints; at += hn::Lanes(kD)) {
    const V px = hn::LoadU(kD, points.x + at), py = hn::LoadU(kD, points.y + at), pz = hn::LoadU(kD, points.z + at);
    const V half_x = hn::LoadU(kD, points.half_x + at), half_y = hn::LoadU(kD, points.half_y + at);
    const V half_z = hn::LoadU(kD, points.half_z + at);
    V gx, gy, gz;
    V phase = far_field<kFull>(far, sub(px, set(centre.x)), sub(py, set(centre.y)), sub(pz, set(centre.z)), gx, gy, gz);
    Sums sums = Sums::none();
    if (!path.empty()) {
      Seen a = see(path[0], px, py, pz);
      Stereographic s = stereographic(a.z, a.rr, a.length);
      for (std::size_t k = 1; k < path.size(); ++k) {
        const Seen b = see(path[k], px, py, pz);
        const Stereographic t = stereographic(b.z, b.rr, b.length);
        if (path[k].joined) {
          sums.edge<kFull>(path[k - 1], path[k], a, b, s, t);
          if (path[k - 1].finite && path[k].finite) sums.bound(path[k], a, b, half_x, half_y, half_z);
        }
        // A factor is at most the fourth power of a distance in cells, so eight factors stay within range.
        if (k % 8 == 0) sums.rescale();
        a = b, s = t;
      }
      sums.rescale();
      phase = add(phase, mul(argument(sums.im, sums.re), set(1 / (2 * kPi))));
      constexpr double kWhole = 1 / (4 * kPi);
      gz = add(gz, mul(sums.gz, set(kWhole)));
      if constexpr (kFull) gx = add(gx, mul(sums.gx, set(kWhole))), gy = add(gy, mul(sums.gy, set(kWhole)));
    }
    phase = sub(phase, set(0.5));
    hn::StoreU(sub(phase, hn::Round(phase)), kD, values.phase + at);
    if constexpr (kFull) hn::StoreU(gx, kD, values.gx + at), hn::StoreU(gy, kD, values.gy + at);
    hn::StoreU(gz, kD, values.gz + at);
    hn::StoreU(mul(sums.curvature, set(1 / kPi)), kD, values.curvature + at);
  }
}

}  // namespace

void EvaluateField(std::span<const PathPoint> path, const LocalExpansion& far, const Vec3& centre,
                   const FieldPoints& points, bool full, FieldValues& values) {
  if (full)
    evaluate<true>(path, far, centre, points, values);
  else
    evaluate<false>(path, far, centre, points, values);
}

// One edge's part of K is monotonic along a column, because the sign of dK/dz = (a × b)_z (|a| + |b|) / (4π |a| |b|
// (|a| |b| + a·b)) is constant. So its change follows from its values at the two ends, where a bound on curvature is no
// help.
void FieldVariation(std::span<const PathPoint> path, const FieldPoints& points, const double* slopes, double curvature,
                    double* variation) {
  for (std::size_t at = 0; at < kPoints; at += hn::Lanes(kD)) {
    const V px = hn::LoadU(kD, points.x + at), py = hn::LoadU(kD, points.y + at), pz = hn::LoadU(kD, points.z + at);
    const V half = hn::LoadU(kD, points.half_z + at);
    V rest = hn::LoadU(kD, slopes + at);  // the part of the slope without the near edges
    V up[2], down[2];                     // change below and above
    for (const int side : {0, 1}) up[side] = down[side] = zero();
    M vertex = hn::FirstN(kD, 0);
    const V none = zero();
    Seen a{none, none, none, none, none, none};
    Stereographic s{none, none}, s_end[2] = {s, s};
    for (std::size_t k = 0; k < path.size(); ++k) {
      const PathPoint& p = path[k];
      if (!p.finite) continue;
      const Seen b = see(p, px, py, pz);
      const Stereographic t = stereographic(b.z, b.rr, b.length);
      Stereographic t_end[2];
      for (const int side : {0, 1}) {
        const V z = side == 0 ? add(b.z, half) : sub(b.z, half);
        t_end[side] = stereographic(z, b.rr, hn::Sqrt(add(b.rr, mul(z, z))));
      }
      const M over = hn::And(hn::Eq(px, set(p.x)), hn::Eq(py, set(p.y)));
      vertex = hn::Or(vertex, hn::And(over, hn::Le(hn::Abs(b.z), half)));
      if (p.joined && path[k - 1].finite) {
        const V dot = add(mul(a.x, b.x), mul(a.y, b.y)), cross = sub(mul(a.x, b.y), mul(a.y, b.x));
        const V product = mul(a.length, b.length), below = mul(product, add(product, add(dot, mul(a.z, b.z))));
        const M seen = hn::Gt(below, zero());
        const V weight = hn::Div(pick(seen, add(a.length, b.length), zero()), pick(seen, below, set(1)));
        rest = sub(rest, mul(mul(cross, weight), set(1 / (4 * kPi))));
        const V f = mul(s.f, t.f), re = add(mul(s.t, t.t), mul(f, dot)), im = mul(f, cross);
        for (const int side : {0, 1}) {
          const V g = mul(s_end[side].f, t_end[side].f);
          const V x = add(mul(s_end[side].t, t_end[side].t), mul(g, dot)), y = mul(g, cross);
          const V change = argument(sub(mul(y, re), mul(x, im)), add(mul(x, re), mul(y, im)));
          // On a column through the edge, K may rise or fall; rounding must not decide which.
          const M either = hn::Eq(cross, zero());
          const V size = hn::Abs(change);
          up[side] = add(up[side], pick(hn::Or(either, hn::Gt(change, zero())), size, zero()));
          down[side] = add(down[side], pick(hn::Or(either, hn::Lt(change, zero())), size, zero()));
        }
      }
      a = b, s = t, s_end[0] = t_end[0], s_end[1] = t_end[1];
    }
    const V most = mul(hn::Max(hn::Max(up[0], up[1]), hn::Max(down[0], down[1])), set(1 / (2 * kPi)));
    const V smooth = add(mul(hn::Abs(rest), half), mul(set(0.5 * curvature), mul(half, half)));
    const V infinity = set(std::numeric_limits<double>::infinity());
    hn::StoreU(pick(vertex, infinity, add(most, smooth)), kD, variation + at);
  }
}

}  // namespace riffler::dexel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::dexel {

HWY_EXPORT(EvaluateField);
HWY_EXPORT(FieldVariation);

void evaluate_field(std::span<const PathPoint> path, const LocalExpansion& far, const Vec3& centre,
                    const FieldPoints& points, bool full, FieldValues& values) {
  HWY_DYNAMIC_DISPATCH(EvaluateField)(path, far, centre, points, full, values);
}

void field_variation(std::span<const PathPoint> path, const FieldPoints& points, const double* slope, double curvature,
                     double* variation) {
  HWY_DYNAMIC_DISPATCH(FieldVariation)(path, points, slope, curvature, variation);
}

}  // namespace riffler::dexel

#endif
