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
}  // namespace

// Nothing is reordered: every lane does the same arithmetic whatever the width of the registers.

/// The loops over lanes, compiled once for each set of instructions.
struct FieldLanes {
  using EdgeLanes = FieldSums::EdgeLanes;
  using PoleLanes = FieldSums::PoleLanes;

  /// The direction to each point in stereographic coordinates up to a positive factor, (t : α) = (t : f α).
  static RIFFLER_INLINE void project(const EdgeArrays& in, double z, double* __restrict dz, double* __restrict length,
                                     double* __restrict t, double* __restrict f) {
    for (std::size_t k = 0; k <= in.n; ++k) {
      const double d = in.z[k] - z, l = __builtin_sqrt(in.rr[k] + d * d);
      dz[k] = d, length[k] = l;
      t[k] = d < 0 ? in.rr[k] : l + d;
      f[k] = d < 0 ? l - d : 1.0;
    }
  }

  template <bool kFull>
  static RIFFLER_INLINE void edges(const EdgeArrays& in, double z, EdgeLanes& out) {
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
      out.re[q] = re[q] * scale, out.im[q] = im[q] * scale;
      out.gx[q] = gx[q], out.gy[q] = gy[q], out.gz[q] = gz[q];
    }
  }

  static RIFFLER_INLINE void edges(const EdgeArrays& in, double z, bool full, EdgeLanes& out) {
    if (full)
      edges<true>(in, z, out);
    else
      edges<false>(in, z, out);
  }

  static RIFFLER_INLINE void poles(const PoleArrays& in, double z, PoleLanes& out) {
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
    for (std::size_t q = 0; q < kLanes; ++q) out.value[q] = value[q], out.slope[q] = slope[q];
  }

  static void edges_baseline(const EdgeArrays& in, double z, bool full, EdgeLanes& out) { edges(in, z, full, out); }
  static void poles_baseline(const PoleArrays& in, double z, PoleLanes& out) { poles(in, z, out); }

#ifdef RIFFLER_VECTOR_TARGETS
  // Neither target may bring fused multiply-adds in: results would differ.
  __attribute__((target("avx2"))) static void edges_avx2(const EdgeArrays& in, double z, bool full, EdgeLanes& out) {
    edges(in, z, full, out);
  }
  __attribute__((target("avx2"))) static void poles_avx2(const PoleArrays& in, double z, PoleLanes& out) {
    poles(in, z, out);
  }
  __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512"))) static void edges_avx512(
      const EdgeArrays& in, double z, bool full, EdgeLanes& out) {
    edges(in, z, full, out);
  }
  __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512"))) static void poles_avx512(
      const PoleArrays& in, double z, PoleLanes& out) {
    poles(in, z, out);
  }
#endif

  static std::vector<FieldSums> available() {
    std::vector<FieldSums> sums;
    const auto add = [&](auto edges, auto poles) {
      FieldSums s;
      s.edges_ = edges, s.poles_ = poles;
      sums.push_back(s);
    };
#ifdef RIFFLER_VECTOR_TARGETS
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
      add(edges_avx512, poles_avx512);
    if (__builtin_cpu_supports("avx2")) add(edges_avx2, poles_avx2);
#endif
    add(edges_baseline, poles_baseline);
    return sums;
  }
};

const std::vector<FieldSums>& FieldSums::available() {
  static const std::vector<FieldSums> sums = FieldLanes::available();
  return sums;
}

// Lanes are joined out here, in the baseline's instructions: gcc 12 fuses the multiplications of a complex product into
// fmaddsub where it may, -ffp-contract=off notwithstanding.
EdgeSum FieldSums::edges(const EdgeArrays& in, double z, bool full) const {
  EdgeLanes lanes;
  edges_(in, z, full, lanes);
  EdgeSum out{1, 0, 0, 0, 0};
  for (std::size_t q = 0; q < kLanes; ++q) {
    const double turned = out.re * lanes.re[q] - out.im * lanes.im[q];
    out.im = out.re * lanes.im[q] + out.im * lanes.re[q];
    out.re = turned;
    out.gx += lanes.gx[q], out.gy += lanes.gy[q], out.gz += lanes.gz[q];
  }
  return out;
}

PoleSum FieldSums::poles(const PoleArrays& in, double z) const {
  PoleLanes lanes;
  poles_(in, z, lanes);
  PoleSum out{0, 0};
  for (std::size_t q = 0; q < kLanes; ++q) out.value += lanes.value[q], out.slope += lanes.slope[q];
  return out;
}

}  // namespace riffler
