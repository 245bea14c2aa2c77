#include "dexel/field_sum.hpp"

#if defined(__GNUC__) && defined(__x86_64__)
#define RIFFLER_VECTOR_TARGETS 1
#define RIFFLER_INLINE inline __attribute__((always_inline))
#else
#define RIFFLER_INLINE inline
#endif

namespace riffler {

namespace {

constexpr double kTiny = 1e-300;

// Nothing is reordered: every lane does the same arithmetic whatever the width of the registers.

/// The direction to each point in stereographic coordinates up to a positive factor, (t : α) = (t : f α).
RIFFLER_INLINE void project(const EdgeArrays& in, double z, double* __restrict dz, double* __restrict length,
                            double* __restrict t, double* __restrict f) {
  for (std::size_t k = 0; k <= in.n; ++k) {
    const double d = in.z[k] - z, l = __builtin_sqrt(in.rr[k] + d * d);
    dz[k] = d, length[k] = l;
    t[k] = d < 0 ? in.rr[k] : l + d;
    f[k] = d < 0 ? l - d : 1.0;
  }
}

template <bool kFull>
RIFFLER_INLINE EdgeSum sum(const EdgeArrays& in, double z) {
  double* const dz = in.scratch;
  double* const length = dz + in.n + 1;
  double* const t = length + in.n + 1;
  double* const f = t + in.n + 1;
  project(in, z, dz, length, t, f);

  double re[kLanes], im[kLanes], gx[kLanes], gy[kLanes], gz[kLanes];
  for (std::size_t q = 0; q < kLanes; ++q) re[q] = 1, im[q] = gx[q] = gy[q] = gz[q] = 0;
  for (std::size_t begin = 1, group = 1; begin <= in.n; begin += kLanes, ++group) {
    for (std::size_t q = 0; q < kLanes; ++q) {
      const std::size_t b = begin + q, a = b - 1;
      const double ff = f[a] * f[b], product = length[a] * length[b];
      const double x = t[a] * t[b] + ff * in.dot[b], y = ff * in.cross[b];
      const double turned = re[q] * x - im[q] * y;
      im[q] = re[q] * y + im[q] * x;
      re[q] = turned;

      const double below = product * (product + in.dot[b] + dz[a] * dz[b]);
      const double weight = (below > 0 ? length[a] + length[b] : 0.0) / (below > 0 ? below : 1.0);
      gz[q] += in.cross[b] * weight;
      if constexpr (kFull) {
        gx[q] += in.joined[b] * (in.y[a] * dz[b] - dz[a] * in.y[b]) * weight;
        gy[q] += in.joined[b] * (dz[a] * in.x[b] - in.x[a] * dz[b]) * weight;
      }
    }
    // A factor is at most the fourth power of a distance in cells, so that eight stay within range.
    if (group % 8 == 0)
      for (std::size_t q = 0; q < kLanes; ++q) {
        const double scale = 1 / (__builtin_fabs(re[q]) + __builtin_fabs(im[q]) + kTiny);
        re[q] *= scale, im[q] *= scale;
      }
  }
  for (std::size_t q = 0; q < kLanes; ++q) {
    const double scale = 1 / (__builtin_fabs(re[q]) + __builtin_fabs(im[q]) + kTiny);
    re[q] *= scale, im[q] *= scale;
  }
  EdgeSum out{1, 0, 0, 0, 0};
  for (std::size_t q = 0; q < kLanes; ++q) {
    const double turned = out.re * re[q] - out.im * im[q];
    out.im = out.re * im[q] + out.im * re[q];
    out.re = turned;
    out.gx += gx[q], out.gy += gy[q], out.gz += gz[q];
  }
  return out;
}

RIFFLER_INLINE PoleSum poles(const PoleArrays& in, double z) {
  double value[kLanes], slope[kLanes];
  for (std::size_t q = 0; q < kLanes; ++q) value[q] = slope[q] = 0;
  for (std::size_t begin = 0; begin < in.n; begin += kLanes)
    for (std::size_t q = 0; q < kLanes; ++q) {
      const std::size_t k = begin + q;
      const double rz = in.z[k] - z, inverse = 1 / (in.rr[k] + rz * rz), cube = inverse * __builtin_sqrt(inverse);
      const double along = in.qzz[k] * rz, dipole = in.across[k] + in.dz[k] * rz + in.trace[k];
      const double quadrupole = in.flat[k] + (2 * in.skew[k] + along) * rz;
      value[q] += (dipole - 3 * quadrupole * inverse) * cube;
      slope[q] -= (in.dz[k] - 3 * inverse * (dipole * rz + 2 * (in.skew[k] + along)) +
                   15 * quadrupole * rz * inverse * inverse) *
                  cube;
    }
  PoleSum out{0, 0};
  for (std::size_t q = 0; q < kLanes; ++q) out.value += value[q], out.slope += slope[q];
  return out;
}

RIFFLER_INLINE EdgeSum edges(const EdgeArrays& in, double z, bool full) {
  return full ? sum<true>(in, z) : sum<false>(in, z);
}

struct Sums {
  EdgeSum (*edges)(const EdgeArrays&, double, bool);
  PoleSum (*poles)(const PoleArrays&, double);
};

EdgeSum edges_baseline(const EdgeArrays& in, double z, bool full) {
  return edges(in, z, full);
}
PoleSum poles_baseline(const PoleArrays& in, double z) {
  return poles(in, z);
}

#ifdef RIFFLER_VECTOR_TARGETS
#define RIFFLER_AVX2 __attribute__((target("avx2")))
#define RIFFLER_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")))
RIFFLER_AVX2 EdgeSum edges_avx2(const EdgeArrays& in, double z, bool full) {
  return edges(in, z, full);
}
RIFFLER_AVX2 PoleSum poles_avx2(const PoleArrays& in, double z) {
  return poles(in, z);
}
RIFFLER_AVX512 EdgeSum edges_avx512(const EdgeArrays& in, double z, bool full) {
  return edges(in, z, full);
}
RIFFLER_AVX512 PoleSum poles_avx512(const PoleArrays& in, double z) {
  return poles(in, z);
}
#endif

Sums best() {
#ifdef RIFFLER_VECTOR_TARGETS
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return {edges_avx512, poles_avx512};
  if (__builtin_cpu_supports("avx2")) return {edges_avx2, poles_avx2};
#endif
  return {edges_baseline, poles_baseline};
}

const Sums& chosen() {
  static const Sums sums = best();
  return sums;
}

}  // namespace

EdgeSum sum_edges(const EdgeArrays& in, double z, bool full) {
  return chosen().edges(in, z, full);
}
PoleSum sum_poles(const PoleArrays& in, double z) {
  return chosen().poles(in, z);
}

}  // namespace riffler
