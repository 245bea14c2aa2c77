// Sums of two doubles, of which the second is smaller than the last place of the first: numbers of about 100 bits.
// Method: T. J. Dekker, A floating-point technique for extending the available precision (1971).
#pragma once

#include <cstddef>

namespace riffler::base {

struct NumberPair {
  double high = 0, low = 0;
};

/// a + b exactly, for |a| ≥ |b| or a = 0.
inline NumberPair ordered_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b exactly (Knuth).
inline NumberPair exact_sum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// a · b exactly, where neither halves of 26 bits overflow nor the product's rest is subnormal.
inline NumberPair exact_product(double a, double b) {
  const double product = a * b, wide_a = 0x1p27 * a + a, wide_b = 0x1p27 * b + b;
  const double a1 = wide_a - (wide_a - a), a2 = a - a1, b1 = wide_b - (wide_b - b), b2 = b - b1;
  return {product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2};
}

inline NumberPair sum(const NumberPair& a, const NumberPair& b) {
  const NumberPair s = exact_sum(a.high, b.high);
  return ordered_sum(s.high, s.low + (a.low + b.low));
}

inline NumberPair product(const NumberPair& a, const NumberPair& b) {
  const NumberPair p = exact_product(a.high, b.high);
  return ordered_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

inline NumberPair quotient(const NumberPair& a, const NumberPair& b) {
  const double q = a.high / b.high;
  const NumberPair p = exact_product(q, b.high);
  return ordered_sum(q, (((a.high - p.high) - p.low) + a.low - q * b.low) / b.high);
}

/// c₀ + c₁ x + c₂ x² … by Horner's rule.
template <std::size_t N>
double polynomial(const double (&c)[N], double x) {
  double out = c[N - 1];
  for (std::size_t k = N - 1; k-- > 0;) out = out * x + c[k];
  return out;
}

}  // namespace riffler::base
