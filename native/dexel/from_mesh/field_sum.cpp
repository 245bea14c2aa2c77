#include "dexel/from_mesh/field_sum.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dexel/from_mesh/field_sum.cpp"
// Keep clang-format from sorting foreach_target.h to another place.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "base/lanes-inl.hpp"
#include "geom/math.hpp"

#ifndef RIFFLER_SOURCE_LANES
#define RIFFLER_SOURCE_LANES
namespace riffler::dexel {
/// A SourceSum per lane.
struct SourceLanes {
  double c_re[SourceSum::kTerms][kSourceLanes], c_im[SourceSum::kTerms][kSourceLanes];
  double re[kSourceLanes], im[kSourceLanes], dipoles[kSourceLanes];
};
}  // namespace riffler::dexel
#endif

// Uses only operations that IEEE 754 rounds correctly, none fused, and assigns sources to lanes independently of the
// vector width. So every instruction set gives the same bits.

HWY_BEFORE_NAMESPACE();
namespace riffler::dexel::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

namespace {

constexpr double kGauss = 0.28867513459481287;  // 1 / (2 √3)
constexpr int kOrder = kExpansionDegree + 1;

constexpr int place(int n, int m) {
  return n * (n + 1) / 2 + m;
}
constexpr int kPlaces = place(kOrder, kOrder) + 1;

/// Decaying solid harmonics S_n^m, m ≥ 0: 1 / |r − p| = Σ conj(R_n^m(p)) S_n^m(r) over n and −n ≤ m ≤ n, with S_n^−m =
/// (−1)^m conj(S_n^m). They are (n − m)! P_n^m(cos θ) e^(imφ) / |r|^(n+1).
struct Harmonics {
  V re[kPlaces], im[kPlaces];
};

/// Adds the harmonics of r times g^(n−1). Returns 1 / |r|.
HWY_INLINE V add_harmonics(V x, V y, V z, V g, Harmonics& sum) {
  const V inverse = hn::Div(set(1), add(add(mul(x, x), mul(y, y)), mul(z, z))), root = hn::Sqrt(inverse);
  const V u = mul(x, inverse), v = mul(y, inverse), w = mul(z, inverse);
  V power[kOrder + 1];
  power[1] = set(1);
  for (int n = 2; n <= kOrder; ++n) power[n] = mul(power[n - 1], g);
  const auto put = [&](int n, int m, V re, V im) HWY_ATTR {
    if (n == 0) return;
    const int k = place(n, m);
    sum.re[k] = add(sum.re[k], mul(power[n], re));
    if (m > 0) sum.im[k] = add(sum.im[k], mul(power[n], im));
  };
  V diagonal_re = root, diagonal_im = zero();
  for (int m = 0; m <= kOrder; ++m) {
    if (m > 0) {
      const V f = set(2.0 * m - 1), re = mul(f, diagonal_re), im = mul(f, diagonal_im);
      diagonal_re = sub(mul(u, re), mul(v, im)), diagonal_im = add(mul(u, im), mul(v, re));
    }
    V before_re = zero(), before_im = zero(), re = diagonal_re, im = diagonal_im;
    put(m, m, re, im);
    for (int n = m + 1; n <= kOrder; ++n) {
      const V a = mul(set(2.0 * n - 1), w), b = mul(set((n - 1.0) * (n - 1) - m * m), inverse);
      const V next_re = sub(mul(a, re), mul(b, before_re)), next_im = sub(mul(a, im), mul(b, before_im));
      before_re = re, before_im = im, re = next_re, im = next_im;
      put(n, m, re, im);
    }
  }
  return root;
}

/// The factor whose argument is half the solid angle that an edge from a to b sweeps along the ray. dot and cross are
/// a·b and (a × b)_z without the contributions of z (field.hpp). The length of a direction changes only a positive
/// factor.
HWY_INLINE void turn(V az, V aa, V bz, V bb, V dot, V cross, V& re, V& im) {
  const auto project = [](V z, V rr, V& t, V& f) HWY_ATTR {
    const V length = hn::Sqrt(add(rr, mul(z, z)));
    const auto below = hn::Lt(z, zero());
    t = hn::IfThenElse(below, rr, add(length, z)), f = hn::IfThenElse(below, sub(length, z), set(1));
  };
  V ta, fa, tb, fb;
  project(az, aa, ta, fa), project(bz, bb, tb, fb);
  const V f = mul(fa, fb), x = add(mul(ta, tb), mul(f, dot)), y = mul(f, cross);
  const V turned = sub(mul(re, x), mul(im, y));
  im = add(mul(re, y), mul(im, x)), re = turned;
  const V scale = hn::Div(set(1), add(add(hn::Abs(re), hn::Abs(im)), set(1e-300)));
  re = mul(re, scale), im = mul(im, scale);
}

}  // namespace

void SumSources(const SourceArrays& in, SourceLanes& out) {
  for (std::size_t at = 0; at < kSourceLanes; at += hn::Lanes(kD)) {
    V c_re[SourceSum::kTerms], c_im[SourceSum::kTerms];
    for (int k = 0; k < SourceSum::kTerms; ++k) c_re[k] = c_im[k] = zero();
    V re = set(1), im = zero(), dipoles = zero();
    for (std::size_t k = at; k < in.n; k += kSourceLanes) {
      const auto load = [&](const double* p) HWY_ATTR { return hn::LoadU(kD, p + k); };
      const V ax = load(in.ax), ay = load(in.ay), az = load(in.az), wx = load(in.wx), wy = load(in.wy),
              wz = load(in.wz);
      Harmonics s;
      for (int p = 0; p < kPlaces; ++p) s.re[p] = s.im[p] = zero();
      V weight = set(1 / (4 * kPi));
      if (in.dipoles) {
        const V root = add_harmonics(ax, ay, az, set(1), s);
        const V along = add(add(mul(wx, ax), mul(wy, ay)), mul(wz, az));
        dipoles = sub(dipoles, mul(mul(along, weight), mul(root, mul(root, root))));
      } else {
        const V ex = load(in.ex), ey = load(in.ey), ez = load(in.ez), endless = load(in.endless);
        const V bx = add(ax, ex), by = add(ay, ey), bz = add(az, ez);
        turn(az, add(mul(ax, ax), mul(ay, ay)), bz, add(mul(bx, bx), mul(by, by)), add(mul(ax, bx), mul(ay, by)), wz,
             re, im);
        weight = mul(weight, set(0.5));
        for (const double t : {0.5 - kGauss, 0.5 + kGauss})
          add_harmonics(add(ax, mul(set(t), ex)), add(ay, mul(set(t), ey)), add(az, mul(set(t), ez)),
                        sub(set(1), mul(endless, set(t))), s);
      }
      // w · ∇ S_n^m = −w_z S_{n+1}^m − (w_x − i w_y) S_{n+1}^{m+1} / 2 + (w_x + i w_y) S_{n+1}^{m−1} / 2.
      const V ux = mul(mul(set(0.5), weight), wx), uy = mul(mul(set(0.5), weight), wy), uz = mul(weight, wz);
      for (int n = 1; n <= kExpansionDegree; ++n) {
        const V part = set(in.dipoles ? 1 : 1.0 / n);
        for (int m = 0; m <= n; ++m) {
          const int p = place(n + 1, m), t = SourceSum::term(n, m);
          V sum_re = mul(uz, s.re[p]), sum_im = mul(uz, s.im[p]);
          sum_re = add(sum_re, add(mul(ux, s.re[p + 1]), mul(uy, s.im[p + 1])));
          sum_im = add(sum_im, sub(mul(ux, s.im[p + 1]), mul(uy, s.re[p + 1])));
          if (m == 0) {
            sum_re = add(sum_re, add(mul(ux, s.re[p + 1]), mul(uy, s.im[p + 1])));
          } else {
            sum_re = sub(sum_re, sub(mul(ux, s.re[p - 1]), mul(uy, s.im[p - 1])));
            sum_im = sub(sum_im, add(mul(ux, s.im[p - 1]), mul(uy, s.re[p - 1])));
            c_im[t] = sub(c_im[t], mul(part, sum_im));
          }
          c_re[t] = sub(c_re[t], mul(part, sum_re));
        }
      }
    }
    for (int k = 0; k < SourceSum::kTerms; ++k)
      hn::StoreU(c_re[k], kD, out.c_re[k] + at), hn::StoreU(c_im[k], kD, out.c_im[k] + at);
    hn::StoreU(re, kD, out.re + at), hn::StoreU(im, kD, out.im + at), hn::StoreU(dipoles, kD, out.dipoles + at);
  }
}

}  // namespace riffler::dexel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::dexel {

HWY_EXPORT(SumSources);

SourceSum sum_sources(const SourceArrays& in) {
  SourceLanes lanes;
  HWY_DYNAMIC_DISPATCH(SumSources)(in, lanes);
  const auto sum = [](const double* l) { return ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7])); };
  static_assert(kSourceLanes == 8);
  SourceSum out;
  for (int k = 0; k < SourceSum::kTerms; ++k) out.c_re[k] = sum(lanes.c_re[k]), out.c_im[k] = sum(lanes.c_im[k]);
  out.dipoles = sum(lanes.dipoles);
  out.re = 1, out.im = 0;
  for (std::size_t q = 0; q < kSourceLanes; ++q) {
    const double turned = out.re * lanes.re[q] - out.im * lanes.im[q];
    out.im = out.re * lanes.im[q] + out.im * lanes.re[q];
    out.re = turned;
  }
  return out;
}

}  // namespace riffler::dexel

#endif
