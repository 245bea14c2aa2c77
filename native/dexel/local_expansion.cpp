#include "dexel/local_expansion.hpp"

#include <cmath>
#include <iterator>

namespace riffler {

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

void LocalExpansion::add(const SourceArrays& sources) {
  const SourceSum sum = FieldSums::available().front().sources(sources);
  LocalExpansion more;
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i + k <= kDegree; ++i)
      for (int j = 0; i + j + k <= kDegree; ++j) more.rows_[row(k, i)][j] = sum.terms[k][i][j];
  // The others follow from Laplace's equation.
  for (int k = 2; k <= kDegree; ++k)
    for (int i = 0; i + k <= kDegree; ++i)
      for (int j = 0; i + j + k <= kDegree; ++j)
        more.rows_[row(k, i)][j] = -((i + 2) * (i + 1) * more.rows_[row(k - 2, i + 2)][j] +
                                     (j + 2) * (j + 1) * more.rows_[row(k - 2, i)][j + 2]) /
                                   (k * (k - 1));
  for (int r = 0; r < kRows; ++r)
    for (int j = 0; j < kSide; ++j) rows_[r][j] += more.rows_[r][j];
}

// By Taylor's formula with the second derivatives' bounds within ± half: of a term of degree n they sum up to n (n −
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

}  // namespace riffler
