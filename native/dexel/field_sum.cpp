#include "dexel/field_sum.hpp"

#if defined(__GNUC__) && defined(__x86_64__)
#define RIFFLER_VECTOR_TARGETS 1
#define RIFFLER_INLINE inline __attribute__((always_inline))
#else
#define RIFFLER_INLINE inline
#endif

namespace riffler {

namespace {
constexpr double kPi = 3.14159265358979323846;
constexpr double kGauss = 0.28867513459481287;  // 1 / (2 √3)
}  // namespace

// Nothing is reordered: every lane does the same arithmetic whatever the width of the registers.

/// The loops over lanes, compiled once for each set of instructions.
struct FieldLanes {
  using SourceLanes = FieldSums::SourceLanes;

  /// b[i][j]: terms of 1 / |y − p| in the powers x^i y^j of p, and those with one z. |α| |y|² b_α = (2 |α| − 1) Σ y_i
  /// b_{α − e_i} − (|α| − 1) Σ b_{α − 2 e_i}, since Σ b_α is a generating function of Legendre polynomials.
  struct Inverse {
    static constexpr int kSide = kExpansionDegree + 2;
    double flat[kSide][kSide][kSourceLanes], once[kSide][kSide][kSourceLanes];
  };

  static RIFFLER_INLINE void inverse(const double* x, const double* y, const double* z, Inverse& out) {
    double over[kSourceLanes];
    for (std::size_t q = 0; q < kSourceLanes; ++q) {
      over[q] = 1 / (x[q] * x[q] + y[q] * y[q] + z[q] * z[q]);
      out.flat[0][0][q] = __builtin_sqrt(over[q]);
    }
    for (int i = 0; i < Inverse::kSide; ++i)
      for (int j = 0; i + j < Inverse::kSide; ++j) {
        const int n = i + j;
        double* __restrict b = out.flat[i][j];
        if (n > 0) {
          const double first = (2.0 * n - 1) / n, second = (n - 1.0) / n;
          double sum[kSourceLanes];
          for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] = 0;
          if (i > 0)
            for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] += first * x[q] * out.flat[i - 1][j][q];
          if (j > 0)
            for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] += first * y[q] * out.flat[i][j - 1][q];
          if (i > 1)
            for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] -= second * out.flat[i - 2][j][q];
          if (j > 1)
            for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] -= second * out.flat[i][j - 2][q];
          for (std::size_t q = 0; q < kSourceLanes; ++q) b[q] = sum[q] * over[q];
        }
        if (n + 1 >= Inverse::kSide) continue;
        const double first = (2.0 * n + 1) / (n + 1), second = static_cast<double>(n) / (n + 1);
        double sum[kSourceLanes];
        for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] = first * z[q] * b[q];
        if (i > 0)
          for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] += first * x[q] * out.once[i - 1][j][q];
        if (j > 0)
          for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] += first * y[q] * out.once[i][j - 1][q];
        if (i > 1)
          for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] -= second * out.once[i - 2][j][q];
        if (j > 1)
          for (std::size_t q = 0; q < kSourceLanes; ++q) sum[q] -= second * out.once[i][j - 2][q];
        for (std::size_t q = 0; q < kSourceLanes; ++q) out.once[i][j][q] = sum[q] * over[q];
      }
  }

  /// Adds (w · ∇) of the terms, by which a term of degree n in K is made of those of degree n + 1, times g^n.
  static RIFFLER_INLINE void derive(const Inverse& b, const double* wx, const double* wy, const double* wz,
                                    const double* g, const double* dipole, SourceLanes& out) {
    double power[kExpansionDegree + 1][kSourceLanes];  // g^n / n, of dipoles 1
    for (std::size_t q = 0; q < kSourceLanes; ++q) {
      double p = 1;
      for (int n = 1; n <= kExpansionDegree; ++n) p *= g[q], power[n][q] = p * (1.0 / n + dipole[q] * (1 - 1.0 / n));
    }
    for (int i = 0; i <= kExpansionDegree; ++i)
      for (int j = 0; i + j <= kExpansionDegree; ++j) {
        if (i + j > 0)
          for (std::size_t q = 0; q < kSourceLanes; ++q)
            out.terms[0][i][j][q] +=
                power[i + j][q] * (wx[q] * ((i + 1) * b.flat[i + 1][j][q]) + wy[q] * ((j + 1) * b.flat[i][j + 1][q]) +
                                   wz[q] * b.once[i][j][q]);
        if (i + j == kExpansionDegree) continue;
        for (std::size_t q = 0; q < kSourceLanes; ++q)
          out.terms[1][i][j][q] +=
              power[i + j + 1][q] *
              (wx[q] * ((i + 1) * b.once[i + 1][j][q]) + wy[q] * ((j + 1) * b.once[i][j + 1][q]) -
               wz[q] * ((i + 2) * (i + 1) * b.flat[i + 2][j][q] + (j + 2) * (j + 1) * b.flat[i][j + 2][q]));
      }
  }

  static RIFFLER_INLINE void sources(const SourceArrays& in, SourceLanes& out) {
    out = {};
    Inverse b;
    for (std::size_t begin = 0; begin < in.n; begin += kSourceLanes) {
      double wx[kSourceLanes], wy[kSourceLanes], wz[kSourceLanes], x[kSourceLanes], y[kSourceLanes], z[kSourceLanes],
          g[kSourceLanes];
      for (std::size_t q = 0; q < kSourceLanes; ++q) {
        const std::size_t k = begin + q;
        constexpr double kWeight = -0.5 / (4 * kPi);
        wx[q] = kWeight * in.wx[k], wy[q] = kWeight * in.wy[k], wz[q] = kWeight * in.wz[k];
      }
      for (const double s : {0.5 - kGauss, 0.5 + kGauss}) {
        for (std::size_t q = 0; q < kSourceLanes; ++q) {
          const std::size_t k = begin + q;
          x[q] = in.ax[k] + s * in.ex[k], y[q] = in.ay[k] + s * in.ey[k], z[q] = in.az[k] + s * in.ez[k];
          g[q] = 1 - in.endless[k] * s;
        }
        inverse(x, y, z, b);
        derive(b, wx, wy, wz, g, in.dipole + begin, out);
      }
    }
  }

  static void sources_baseline(const SourceArrays& in, SourceLanes& out) { sources(in, out); }

#ifdef RIFFLER_VECTOR_TARGETS
  // Neither target may bring fused multiply-adds in: results would differ.
  __attribute__((target("avx2"))) static void sources_avx2(const SourceArrays& in, SourceLanes& out) {
    sources(in, out);
  }
  __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512"))) static void sources_avx512(
      const SourceArrays& in, SourceLanes& out) {
    sources(in, out);
  }
#endif

  static std::vector<FieldSums> available() {
    std::vector<FieldSums> sums;
    const auto add = [&](auto sources) {
      FieldSums s;
      s.sources_ = sources;
      sums.push_back(s);
    };
#ifdef RIFFLER_VECTOR_TARGETS
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
      add(sources_avx512);
    if (__builtin_cpu_supports("avx2")) add(sources_avx2);
#endif
    add(sources_baseline);
    return sums;
  }
};

const std::vector<FieldSums>& FieldSums::available() {
  static const std::vector<FieldSums> sums = FieldLanes::available();
  return sums;
}

// Lanes are joined out here, in the baseline's instructions.
SourceSum FieldSums::sources(const SourceArrays& in) const {
  SourceLanes lanes;
  sources_(in, lanes);
  SourceSum out{};
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i + k <= kExpansionDegree; ++i)
      for (int j = 0; i + j + k <= kExpansionDegree; ++j)
        for (std::size_t q = 0; q < kSourceLanes; ++q) out.terms[k][i][j] += lanes.terms[k][i][j][q];
  return out;
}

}  // namespace riffler
