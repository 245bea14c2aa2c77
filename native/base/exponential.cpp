// Exponentials, logarithms and powers (base/functions.hpp).
//
// exp x = 2ᵏ exp r with |r| ≤ ln 2 / 2, and log x = k ln 2 + 2 artanh s with s = (m − 1)/(m + 1), √½ ≤ m < √2 (W. J.
// Cody and W. Waite, Software Manual for the Elementary Functions, 1980). Logarithms keep about 65 bits, so that a
// power of any size is right to its last place. Polynomials interpolate at Chebyshev's points; their coefficients were
// computed with 400 bits and then rounded.
#include <cmath>
#include <limits>

#include "base/functions.hpp"
#include "base/number_pair.hpp"

namespace riffler::base {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

/// exp r = 1 + r + r²/2 + r³ P(r).
constexpr double kExponential[] = {0x1.5555555555555p-3,  0x1.5555555555556p-5,  0x1.1111111111111p-7,
                                   0x1.6c16c16c162cfp-10, 0x1.a01a01a019b27p-13, 0x1.a01a01a6db488p-16,
                                   0x1.71de3a5906976p-19, 0x1.27e4db5bb725ap-22, 0x1.ae643440b654bp-26,
                                   0x1.1f7315649f2d7p-29, 0x1.61b2cab08aa4cp-33};
/// 2 artanh s = 2 s + 2/3 s³ + s⁵ P(s²).
constexpr double kLogarithm[] = {0x1.999999999999ap-2, 0x1.2492492492491p-2, 0x1.c71c71c71cfdep-3,
                                 0x1.745d174512f5ep-3, 0x1.3b13b1bcae4fap-3, 0x1.1110df9bb9145p-3,
                                 0x1.e1f80050fe02dp-4, 0x1.ac4a0689e4f11p-4, 0x1.b8d8d83f51283p-4};
constexpr NumberPair kLog2{0x1.62e42fefa3800p-1, 0x1.ef35793c76730p-45};  // 42 bits, and the rest

/// exp x = (1 + rest) · 2^power.
struct Exponential {
  NumberPair rest;
  int power = 0;
};

/// |x| ≤ 800.
Exponential exponential(const NumberPair& x) {
  constexpr double second = 0x1.ef35793c76000p-45, last = 0x1.cc01f97b57a08p-87;
  const double k = std::floor(x.high * 0x1.71547652b82fep+0 + 0.5);
  const NumberPair r = exact_sum(x.high - k * kLog2.high, -(k * second));
  const NumberPair whole = ordered_sum(r.high, r.low + (x.low - k * last));
  const double z = whole.high;
  const NumberPair square = exact_product(z, 0.5 * z), most = ordered_sum(z, square.high);
  const double more = square.low + (whole.low * (1 + z) + z * z * z * polynomial(kExponential, z));
  return {.rest = ordered_sum(most.high, most.low + more), .power = static_cast<int>(k)};
}

double raised(const NumberPair& x) {
  if (x.high > 710) return kInf;
  if (x.high < -746) return 0;
  const Exponential e = exponential(x);
  const NumberPair one = ordered_sum(1, e.rest.high);
  return std::ldexp(one.high + (one.low + e.rest.low), e.power);
}

/// exp(x) − 1, |x| ≤ 700.
NumberPair raised_less_one(double x) {
  const Exponential e = exponential({x, 0});
  if (e.power == 0) return e.rest;
  const NumberPair one = ordered_sum(1, e.rest.high);
  return sum({std::ldexp(one.high, e.power), std::ldexp(one.low + e.rest.low, e.power)}, {-1, 0});
}

/// 0 < x < ∞.
NumberPair logarithm(double x) {
  int k = 0;
  double m = std::frexp(x, &k);
  if (m < 0x1.6a09e667f3bcdp-1) m *= 2, --k;
  const NumberPair s = quotient({m - 1, 0}, exact_sum(m, 1)), z = product(s, s);
  const NumberPair cube = product(product(s, z), {0x1.5555555555555p-1, 0x1.5555555555555p-55});
  const double tail = z.high * z.high * s.high * polynomial(kLogarithm, z.high);
  const NumberPair log = sum({2 * s.high, 2 * s.low}, sum(cube, {tail, 0}));
  return k == 0 ? log : sum({k * kLog2.high, k * kLog2.low}, log);
}

/// The logarithm times `factor`.
double scaled_logarithm(double x, const NumberPair& factor) {
  if (!(x >= 0)) return kNan;
  if (x == 0) return -kInf;
  if (x == kInf) return kInf;
  const NumberPair log = product(logarithm(x), factor);
  return log.high + log.low;
}

}  // namespace

double exp(double x) {
  return std::isnan(x) ? kNan : raised({x, 0});
}

double expm1(double x) {
  if (std::isnan(x)) return kNan;
  if (std::abs(x) < 0x1p-54) return x;
  if (x > 700) return raised({x, 0});
  if (x < -50) return -1;
  const NumberPair e = raised_less_one(x);
  return e.high + e.low;
}

double log(double x) {
  return scaled_logarithm(x, {1, 0});
}

double log2(double x) {
  int power = 0;
  if (std::isfinite(x) && std::frexp(x, &power) == 0.5) return power - 1;
  return scaled_logarithm(x, {0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56});
}

double log10(double x) {
  return scaled_logarithm(x, {0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57});
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (std::isnan(x) || std::isnan(y)) return kNan;
  const double size = std::abs(x);
  const bool integer = std::trunc(y) == y, odd = integer && std::abs(y) < 0x1p53 && std::fmod(y, 2) != 0;
  if (std::isinf(y)) return size == 1 ? 1 : (size > 1) == (y > 0) ? kInf : 0;
  const double sign = odd && std::signbit(x) ? -1 : 1;
  if (size == 0 || std::isinf(x)) return sign * ((size == 0) == (y > 0) ? 0 : kInf);
  if (x < 0 && !integer) return kNan;
  const NumberPair log = logarithm(size);
  const double about = log.high * y;
  if (!(std::abs(about) < 750)) return sign * (about > 0 ? kInf : 0);
  if (std::abs(about) < 0x1p-60) return sign;  // halves of y or of the logarithm would be too small
  return sign * raised(product(log, {y, 0}));
}

double tanh(double x) {
  const double size = std::abs(x);
  if (std::isnan(x)) return kNan;
  if (size < 0x1p-30) return x;
  if (size > 22) return std::copysign(1, x);
  const NumberPair e = raised_less_one(2 * size), t = quotient(e, sum(e, {2, 0}));
  return std::copysign(t.high + t.low, x);
}

}  // namespace riffler::base
