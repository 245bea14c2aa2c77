#include "dexel/from_mesh/local_expansion.hpp"

#include <array>
#include <cmath>
#include <iterator>

namespace riffler::dexel {

void LocalExpansion::shift(const Vec3& d) {
  // Horner's scheme for each variable in turn.
  const auto add = [this](int to, int from, double factor) {
    for (int j = 0; j < kSide; ++j) rows_[to][j] += factor * rows_[from][j];
  };
  for (int i = 0; i < kDegree; ++i)
    for (int step = 0; step < kDegree - i; ++step)
      for (int k = kDegree - i - 1; k >= step; --k) add(row(k, i), row(k + 1, i), d.z);
  for (int k = 0; k < kDegree; ++k)
    for (int step = 0; step < kDegree - k; ++step)
      for (int i = kDegree - k - 1; i >= step; --i) add(row(k, i), row(k, i + 1), d.x);
  for (int k = 0; k < kDegree; ++k)
    for (int i = 0; i + k < kDegree; ++i) {
      std::array<double, kSide>& c = rows_[row(k, i)];
      for (int step = 0; step < kDegree - k - i; ++step)
        for (int j = kDegree - k - i - 1; j >= step; --j) c[j] += d.y * c[j + 1];
    }
}

namespace {

/// The terms of R_n^m with z^k, k = (n − m) mod 2: those of x^(n−k−j) y^j, real for even j, otherwise imaginary.
struct Harmonic {
  double terms[kExpansionDegree + 1];
};

std::array<Harmonic, SourceSum::kTerms> harmonics() {
  std::array<Harmonic, SourceSum::kTerms> all{};
  const auto factorial = [](int n) {
    double out = 1;
    for (int k = 2; k <= n; ++k) out *= k;
    return out;
  };
  for (int n = 1; n <= kExpansionDegree; ++n)
    for (int m = 0; m <= n; ++m) {
      const int k = (n - m) / 2, degree = n - (n - m) % 2;
      // (x + iy)^(m+k) (x − iy)^k, factor by factor: the coefficient of y^j is i^j times that of (1 + y)^(m+k) (1 −
      // y)^k.
      std::array<double, kExpansionDegree + 2> c{1};
      for (int factor = 0; factor < degree; ++factor)
        for (int j = kExpansionDegree; j > 0; --j) c[j] += factor < m + k ? c[j - 1] : -c[j - 1];
      // conj(R) c has the real part Re R Re c + Im R Im c, and counts twice for m and −m.
      const double scale =
          (m > 0 ? 2 : 1) * (k % 2 == 0 ? 1 : -1) / (factorial(k) * factorial(m + k) * std::ldexp(1.0, degree));
      for (int j = 0; j <= degree; ++j) all[SourceSum::term(n, m)].terms[j] = (j / 2 % 2 == 0 ? scale : -scale) * c[j];
    }
  return all;
}

}  // namespace

void LocalExpansion::add(const SourceSum& sources) {
  static const std::array<Harmonic, SourceSum::kTerms> all = harmonics();
  LocalExpansion more;
  for (int n = 1; n <= kDegree; ++n)
    for (int m = 0; m <= n; ++m) {
      const int t = SourceSum::term(n, m), k = (n - m) % 2, degree = n - k;
      for (int j = 0; j <= degree; ++j)
        more.rows_[row(k, degree - j)][j] += all[t].terms[j] * (j % 2 == 0 ? sources.c_re[t] : sources.c_im[t]);
    }
  // The other terms follow from Laplace's equation.
  for (int k = 2; k <= kDegree; ++k)
    for (int i = 0; i + k <= kDegree; ++i)
      for (int j = 0; i + j + k <= kDegree; ++j)
        more.rows_[row(k, i)][j] = -((i + 2) * (i + 1) * more.rows_[row(k - 2, i + 2)][j] +
                                     (j + 2) * (j + 1) * more.rows_[row(k - 2, i)][j + 2]) /
                                   (k * (k - 1));
  for (int r = 0; r < kRows; ++r)
    for (int j = 0; j < kSide; ++j) rows_[r][j] += more.rows_[r][j];
}

double LocalExpansion::deviation(const Vec3& half) const {
  double sum = -std::abs(constant()), z = 1;
  for (int k = 0; k <= kDegree; ++k, z *= half.z) {
    double x = z;
    for (int i = 0; i + k <= kDegree; ++i, x *= half.x) {
      double y = x;
      for (int j = 0; i + j + k <= kDegree; ++j, y *= half.y) sum += std::abs(rows_[row(k, i)][j]) * y;
    }
  }
  return sum;
}

// By Taylor's formula with bounds on the second derivatives within ± half: for a term of degree n they sum to n (n −
// 1).
double LocalExpansion::curved(const Vec3& half) const {
  constexpr double kSecond[] = {0, 0, 2. / 8, 6. / 8, 12. / 8, 20. / 8};
  static_assert(std::size(kSecond) == kSide);
  double sum = 0, z = 1;
  for (int k = 0; k <= kDegree; ++k, z *= half.z) {
    double x = z;
    for (int i = 0; i + k <= kDegree; ++i, x *= half.x) {
      const std::array<double, kSide>& c = rows_[row(k, i)];
      double y = x;
      for (int j = 0; i + j + k <= kDegree; ++j, y *= half.y) sum += kSecond[i + j + k] * std::abs(c[j]) * y;
    }
  }
  return sum;
}

double LocalExpansion::curvature_along(const Vec3& half) const {
  double sum = 0, z = 1;
  for (int k = 2; k <= kDegree; ++k, z *= half.z) {
    double x = k * (k - 1) * z;
    for (int i = 0; i + k <= kDegree; ++i, x *= half.x) {
      const std::array<double, kSide>& c = rows_[row(k, i)];
      double y = x;
      for (int j = 0; i + j + k <= kDegree; ++j, y *= half.y) sum += std::abs(c[j]) * y;
    }
  }
  return sum;
}

}  // namespace riffler::dexel
