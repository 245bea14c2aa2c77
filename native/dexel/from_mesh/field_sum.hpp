// The sums over the far part of a boundary, in SIMD lanes selected at run time.
#pragma once

#include <cstddef>

#include "base/lanes.hpp"

namespace riffler::dexel {

inline constexpr std::size_t kSourceLanes = base::kLanes;

/// Sources far from the origin; n is a multiple of kSourceLanes. Kinds of source:
/// - edges from a to a + e, with w = a × e;
/// - if `endless` is 1, lines from a to infinity in the direction of a + e, with w = ± a × e;
/// - if `dipoles`, small surfaces at a with the area vectors −w; e and endless are ignored.
/// Padding has a = (1, 0, 0) and zeros.
struct SourceArrays {
  const double *ax, *ay, *az, *ex, *ey, *ez, *wx, *wy, *wz, *endless;
  std::size_t n;
  bool dipoles;
};

inline constexpr int kExpansionDegree = 5;

/// K of the sources, expanded about the origin. With the solid harmonics
///     R_n^m(p) = Σ_k (−1)^k ((x + iy) / 2)^(m+k) ((x − iy) / 2)^k z^(n−m−2k) / (k! (m+k)! (n−m−2k)!)
/// the terms of degree n ≥ 1 are Re(conj(R_n^0) c_n^0) + 2 Σ_{m>0} Re(conj(R_n^m) c_n^m).
struct SourceSum {
  static constexpr int kTerms = kExpansionDegree * (kExpansionDegree + 3) / 2;
  static constexpr int term(int n, int m) { return n * (n + 1) / 2 + m - 1; }

  double c_re[kTerms], c_im[kTerms];
  double re, im;   // scaled product of the edges' factors at the origin: its argument is half the solid angle
  double dipoles;  // K of the dipoles at the origin
};

SourceSum sum_sources(const SourceArrays& in);

}  // namespace riffler::dexel
