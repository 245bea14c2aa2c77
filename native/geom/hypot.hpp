// The hypotenuse, with the same bits on every system: those of the systems' own C libraries differ in the last one.
#pragma once

#include <cmath>
#include <limits>
#include <utility>

namespace riffler::geom {

/// What x·x lost by rounding, exactly; for `x` whose square neither overflows nor becomes subnormal.
inline double square_rest(double x, double square) {
  const double wide = 0x1p27 * x + x, high = wide - (wide - x), low = x - high;  // halves of 26 bits
  return ((high * high - square) + 2 * high * low) + low * low;
}

/// √(x² + y²) for x >= y >= 0 whose squares and their rests are normal numbers.
inline double hypot_of_middling(double x, double y) {
  const double xx = x * x, yy = y * y, root = std::sqrt(xx + yy), square = root * root;
  const double rest = ((xx - square) + yy) + ((square_rest(x, xx) - square_rest(root, square)) + square_rest(y, yy));
  return root + rest / (2 * root);
}

/// √(x² + y²) without overflow or underflow in between; nearly always the nearest number. Infinite where an argument is
/// infinite, otherwise NaN where one is NaN. Made of additions, multiplications, divisions and roots, which every
/// system rounds alike.
inline double hypot(double x, double y) {
  x = std::abs(x), y = std::abs(y);
  if (std::isinf(x) || std::isinf(y)) return std::numeric_limits<double>::infinity();
  if (x < y) std::swap(x, y);
  if (y <= x * 0x1p-27) return x;  // x + y² / 2x rounds to x
  if (x > 0x1p500) return hypot_of_middling(x * 0x1p-600, y * 0x1p-600) * 0x1p600;
  if (y < 0x1p-450) return hypot_of_middling(x * 0x1p600, y * 0x1p600) * 0x1p-600;
  return hypot_of_middling(x, y);
}

}  // namespace riffler::geom
