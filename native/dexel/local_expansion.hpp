// A harmonic function near one place as a polynomial.
#pragma once

#include <array>
#include <vector>

#include "dexel/field_sum.hpp"
#include "geom/vec.hpp"

namespace riffler {

/// Taylor polynomial of degree kDegree about a centre; r below is relative to the centre.
class LocalExpansion {
 public:
  static constexpr int kDegree = kExpansionDegree;

  double constant() const { return rows_[0][0]; }
  void set_constant(double c) { rows_[0][0] = c; }
  Vec3 gradient() const { return {rows_[row(0, 1)][0], rows_[0][1], rows_[row(1, 0)][0]}; }

  /// Moves the centre by d.
  void shift(const Vec3& d);
  /// Adds what the sources about the centre give, all but the constant.
  void add(const SourceArrays& sources);

  /// Within a box of sides `half` (not ± half) that lies within ± half: bound of how far the polynomial is from its
  /// tangent plane at that box's centre.
  double curved(const Vec3& half) const;
  /// Bound of the second derivative along z within ± half.
  double curvature_along(const Vec3& half) const;

  /// The polynomial in z on the column through (x, y): its coefficients.
  using Column = std::array<double, kDegree + 1>;
  Column column(double x, double y) const;
  /// Value and gradient.
  double at(const Vec3& r, Vec3& gradient) const;

 private:
  static constexpr int kSide = kDegree + 1, kRows = kSide * (kSide + 1) / 2;
  static constexpr int row(int k, int i) { return k * kSide - k * (k - 1) / 2 + i; }

  // rows_[row(k, i)][j] belongs to x^i y^j z^k, i + j + k ≤ kDegree; the rest stays zero.
  std::array<std::array<double, kSide>, kRows> rows_{};
};

}  // namespace riffler
