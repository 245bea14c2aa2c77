// A harmonic function near one place, as a polynomial.
#pragma once

#include <array>

#include "dexel/from_mesh/field_sum.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::dexel {

/// Taylor polynomial of degree kDegree about a centre; r below is relative to the centre.
class LocalExpansion {
 public:
  static constexpr int kDegree = kExpansionDegree;

  double constant() const { return rows_[0][0]; }
  void set_constant(double c) { rows_[0][0] = c; }
  /// Coefficients of x^i y^j z^k for j = 0 … kDegree − i − k.
  const double* terms(int k, int i) const { return rows_[row(k, i)].data(); }

  /// Moves the centre by d.
  void shift(const Vec3& d);
  /// Adds the field of sources about the centre, without the constant term.
  void add(const SourceSum& sources);

  /// Bound on the difference between the polynomial and its constant term within ± half.
  double deviation(const Vec3& half) const;
  /// For any box with sides `half` (not ± half) inside ± half: bound on the difference between the polynomial and its
  /// tangent plane at the box's centre.
  double curved(const Vec3& half) const;
  /// Bound on the second derivative along z within ± half.
  double curvature_along(const Vec3& half) const;

 private:
  static constexpr int kSide = kDegree + 1, kRows = kSide * (kSide + 1) / 2;
  static constexpr int row(int k, int i) { return k * kSide - k * (k - 1) / 2 + i; }

  // rows_[row(k, i)][j] belongs to x^i y^j z^k with i + j + k ≤ kDegree; other entries stay zero.
  std::array<std::array<double, kSide>, kRows> rows_{};
};

}  // namespace riffler::dexel
