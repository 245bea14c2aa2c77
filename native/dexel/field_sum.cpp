#include "dexel/field_sum.hpp"

#if defined(__GNUC__) && defined(__x86_64__)
#define RIFFLER_VECTOR_TARGETS 1
#define RIFFLER_INLINE inline __attribute__((always_inline))
#else
#define RIFFLER_INLINE inline
#endif

namespace riffler {

namespace {

constexpr std::size_t kLanes = FieldInput::kLanes;
constexpr double kTiny = 1e-300;

// Nothing is reordered: every lane does the same arithmetic whatever the width of the registers.

/// The direction to each point in stereographic coordinates up to a positive factor, (t : α) = (t : f α).
RIFFLER_INLINE void project(const FieldInput& in, double z, double* __restrict dz, double* __restrict length,
                            double* __restrict t, double* __restrict f) {
  for (std::size_t k = 0; k <= in.n; ++k) {
    const double d = in.z[k] - z, l = __builtin_sqrt(in.rr[k] + d * d);
    dz[k] = d, length[k] = l;
    t[k] = d < 0 ? in.rr[k] : l + d;
    f[k] = d < 0 ? l - d : 1.0;
  }
}

template <bool kFull>
RIFFLER_INLINE FieldSum sum(const FieldInput& in, double z) {
  double* const dz = in.scratch;
  double* const length = dz + in.n + 1;
  double* const t = length + in.n + 1;
  double* const f = t + in.n + 1;
  project(in, z, dz, length, t, f);

  double re[kLanes], im[kLanes], gx[kLanes], gy[kLanes], gz[kLanes];
  for (std::size_t q = 0; q < kLanes; ++q) re[q] = 1, im[q] = gx[q] = gy[q] = gz[q] = 0;
  for (std::size_t begin = 1; begin <= in.n; begin += kLanes)
    for (std::size_t q = 0; q < kLanes; ++q) {
      const std::size_t b = begin + q, a = b - 1;
      const double ff = f[a] * f[b], product = length[a] * length[b];
      const double x = t[a] * t[b] + ff * in.dot[b], y = ff * in.cross[b];
      const double turned = re[q] * x - im[q] * y;
      const double other = re[q] * y + im[q] * x;
      const double scale = 1 / (__builtin_fabs(turned) + __builtin_fabs(other) + kTiny);
      re[q] = turned * scale, im[q] = other * scale;

      const double below = product * (product + in.dot[b] + dz[a] * dz[b]);
      const double weight = (below > 0 ? length[a] + length[b] : 0.0) / (below > 0 ? below : 1.0);
      gz[q] += in.cross[b] * weight;
      if constexpr (kFull) {
        gx[q] += in.joined[b] * (in.y[a] * dz[b] - dz[a] * in.y[b]) * weight;
        gy[q] += in.joined[b] * (dz[a] * in.x[b] - in.x[a] * dz[b]) * weight;
      }
    }
  FieldSum out{1, 0, 0, 0, 0};
  for (std::size_t q = 0; q < kLanes; ++q) {
    const double turned = out.re * re[q] - out.im * im[q];
    out.im = out.re * im[q] + out.im * re[q];
    out.re = turned;
    out.gx += gx[q], out.gy += gy[q], out.gz += gz[q];
  }
  return out;
}

RIFFLER_INLINE FieldSum both(const FieldInput& in, double z, bool full) {
  return full ? sum<true>(in, z) : sum<false>(in, z);
}

FieldSum sum_baseline(const FieldInput& in, double z, bool full) {
  return both(in, z, full);
}

#ifdef RIFFLER_VECTOR_TARGETS
__attribute__((target("avx2"))) FieldSum sum_avx2(const FieldInput& in, double z, bool full) {
  return both(in, z, full);
}

__attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512"))) FieldSum sum_avx512(const FieldInput& in,
                                                                                                 double z, bool full) {
  return both(in, z, full);
}
#endif

using Sum = FieldSum (*)(const FieldInput&, double, bool);

Sum best() {
#ifdef RIFFLER_VECTOR_TARGETS
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return sum_avx512;
  if (__builtin_cpu_supports("avx2")) return sum_avx2;
#endif
  return sum_baseline;
}

}  // namespace

FieldSum sum_field(const FieldInput& in, double z, bool full) {
  static const Sum chosen = best();
  return chosen(in, z, full);
}

}  // namespace riffler
