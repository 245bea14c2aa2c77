// Binomial coefficients of Bernstein polynomials.
#pragma once

#include <array>
#include <cstddef>

#include "riffler/nurbs/patch.hpp"

namespace riffler::nurbs {

/// Those up to degree 2 kMaxDegree.
struct Binomials {
  std::array<std::array<double, 2 * kMaxDegree + 1>, 2 * kMaxDegree + 1> rows{};

  constexpr Binomials() {
    for (std::size_t n = 0; n < rows.size(); ++n) {
      rows[n][0] = 1;
      for (std::size_t k = 1; k <= n; ++k) rows[n][k] = rows[n - 1][k - 1] + (k < n ? rows[n - 1][k] : 0);
    }
  }
  constexpr double operator()(int n, int k) const {
    return rows[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
  }
};
inline constexpr Binomials kBinomials;

}  // namespace riffler::nurbs
