// Sine, cosine, tangent and their inverses (base/functions.hpp).
//
// An argument is reduced to |x| ≤ π/4 by subtracting a multiple of π/2 in three exact steps (W. J. Cody and W. Waite,
// Software Manual for the Elementary Functions, 1980), or, where it is large, by multiplying it by those bits of 2/π
// that matter (M. H. Payne and R. N. Hanek, Radian reduction for trigonometric functions, 1983). Polynomials
// interpolate at Chebyshev's points; their coefficients were computed with 400 bits and then rounded.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/functions.hpp"
#include "base/number_pair.hpp"

namespace riffler::base {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr NumberPair kQuarterTurn{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};  // π/2
constexpr NumberPair kHalfTurn{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};     // π

/// sin x = x + x³ P(x²) and cos x = 1 − x²/2 + x⁴ P(x²), |x| ≤ π/4.
constexpr double kSine[] = {-0x1.5555555555555p-3, 0x1.1111111111110p-7,   -0x1.a01a01a019937p-13,
                            0x1.71de3a54607a5p-19, -0x1.ae64541295cdfp-26, 0x1.61217ee5cca1bp-33,
                            -0x1.ab17bdcbd3414p-41};
constexpr double kCosine[] = {0x1.5555555555555p-5,   -0x1.6c16c16c16c16p-10, 0x1.a01a01a019d0ap-16,
                              -0x1.27e4fb7712ca2p-22, 0x1.1eed8deb82809p-29,  -0x1.9394b9eb4d56dp-37,
                              0x1.ab78473be59d7p-45};
/// atan x = x + x³ P(x²), |x| ≤ 15/32; the second for |x| ≤ 1/32.
constexpr double kArctangent[] = {
    -0x1.5555555555555p-2, 0x1.9999999999997p-3,  -0x1.24924924921b5p-3, 0x1.c71c71c6f286bp-4,  -0x1.745d173bca6a2p-4,
    0x1.3b13afca2f9c0p-4,  -0x1.1110ee99b5595p-4, 0x1.e1dd7d5dba864p-5,  -0x1.aef6245e9e039p-5, 0x1.847ec853ad7c9p-5,
    -0x1.5adfe552a04a2p-5, 0x1.2176e5fdc0f52p-5,  -0x1.85472dc3555adp-6, 0x1.2941fb09bcb98p-7};
constexpr double kShortArctangent[] = {-0x1.5555555555555p-2, 0x1.999999999988cp-3, -0x1.2492492282c2dp-3,
                                       0x1.c71c44b12f1f2p-4, -0x1.7393b9af45e23p-4};
/// atan(k/16) for k = 7 … 16.
constexpr int kFirstArc = 7;
constexpr NumberPair kArcs[] = {
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56}, {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56}, {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},  {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},  {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56}, {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};
/// asin x = x + x³ P(x²), |x| ≤ 1/2.
constexpr double kArcsine[] = {0x1.5555555555556p-3, 0x1.3333333332ec4p-4, 0x1.6db6db6e3292ep-5, 0x1.f1c71c1d4aa0dp-6,
                               0x1.6e8bb1d89492bp-6, 0x1.1c4d343fa57f6p-6, 0x1.c9cf3759fd8ffp-7, 0x1.78246f32d075cp-7,
                               0x1.524ea8b3aad31p-7, 0x1.653a8f8cfd43cp-8, 0x1.1d661531b222ep-6, -0x1.e7a24f548c99fp-7,
                               0x1.d78189767524ep-6};

/// 2/π in binary, after 64 zeros.
constexpr std::uint32_t kTwoOverPi[] = {
    0x00000000, 0x00000000, 0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041,
    0xfe5163ab, 0xdebbc561, 0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e,
    0xe88235f5, 0x2ebb4484, 0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b,
    0x1ff897ff, 0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d,
    0x7527bac7, 0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab};
constexpr double kLarge = 0x1p20;  // below it, multiples of the parts of π/2 are exact

/// The angle without the quarter turns nearest to it, |rest| ≤ π/4 and a little.
struct Reduced {
  NumberPair rest;
  unsigned quarters = 0;  // of which the last two bits count
};

/// |x| ≥ kLarge. Bits of 2/π that make whole turns are skipped, and 192 are used: x has 53, no double is nearer to a
/// multiple of π/2 than by 62, and the rest keeps over 70.
Reduced reduce_large(double x) {
  int exponent = 0;
  const auto m = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(x), &exponent), 53));
  const int start = exponent - 53 - 2 + 64;  // the first bit that is used
  std::array<std::uint32_t, 6> bits;         // the lowest first
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t word = static_cast<std::size_t>(start) / 32 + 5 - k;
    const std::uint64_t two = std::uint64_t{kTwoOverPi[word]} << 32 | kTwoOverPi[word + 1];
    bits[k] = static_cast<std::uint32_t>(two >> (32 - start % 32));
  }
  std::array<std::uint32_t, 6> turns{};  // m · bits: two bits of quarter turns, then their fraction
  for (std::size_t j = 0; j < 2; ++j) {
    std::uint64_t carry = 0;
    const std::uint64_t factor = j == 0 ? m & 0xffffffff : m >> 32;
    for (std::size_t k = 0; k + j < 6; ++k) {
      carry += factor * bits[k] + turns[k + j];
      turns[k + j] = static_cast<std::uint32_t>(carry), carry >>= 32;
    }
  }
  Reduced out{.rest = {}, .quarters = turns[5] >> 30};
  bool negative = (turns[5] >> 29 & 1) != 0;
  turns[5] &= 0x3fffffff;
  if (negative) {  // one quarter turn more, and 1 − the fraction backwards
    std::uint64_t carry = 1;
    for (std::uint32_t& word : turns) {
      carry += std::uint32_t{~word};
      word = static_cast<std::uint32_t>(carry), carry >>= 32;
    }
    turns[5] &= 0x3fffffff, ++out.quarters;
  }
  for (int k = 5; k >= 0; --k)
    out.rest = sum(out.rest, {std::ldexp(static_cast<double>(turns[static_cast<std::size_t>(k)]), 32 * k - 190), 0});
  out.rest = product(out.rest, kQuarterTurn);
  if (negative != (x < 0)) out.rest = {-out.rest.high, -out.rest.low};
  if (x < 0) out.quarters = 0U - out.quarters;
  return out;
}

/// x finite.
Reduced reduce(double x) {
  if (std::abs(x) <= 0.5 * kQuarterTurn.high) return {.rest = {x, 0}, .quarters = 0};
  if (std::abs(x) >= kLarge) return reduce_large(x);
  constexpr double first = 0x1.921fb54400000p+0, second = 0x1.0b4611a600000p-34, third = 0x1.3198a2e000000p-69,
                   last = 0x1.b839a252049c1p-104;  // π/2: three times 33 bits, and the rest
  constexpr double to_integer = 0x1.8p52;
  const double n = (x * 0x1.45f306dc9c883p-1 + to_integer) - to_integer;
  const NumberPair a = exact_sum(x - n * first, -(n * second)), b = exact_sum(a.high, -(n * third));
  return {.rest = ordered_sum(b.high, b.low + (a.low - n * last)),
          .quarters = static_cast<unsigned>(static_cast<int>(n))};
}

/// Sine of the rest: high + low is not yet rounded, and low may be large.
NumberPair sine_of(const NumberPair& x) {
  const double z = x.high * x.high;
  return {x.high, x.high * z * polynomial(kSine, z) + x.low * (1 - 0.5 * z)};
}

NumberPair cosine_of(const NumberPair& x) {
  const double z = x.high * x.high, half = 0.5 * z, high = 1 - half;
  return {high, ((1 - high) - half) + (z * z * polynomial(kCosine, z) - x.high * x.low)};
}

NumberPair negated_if(bool negative, const NumberPair& x) {
  return negative ? NumberPair{-x.high, -x.low} : x;
}

NumberPair sine_of(const Reduced& x) {
  return negated_if((x.quarters & 2) != 0, (x.quarters & 1) != 0 ? cosine_of(x.rest) : sine_of(x.rest));
}

NumberPair cosine_of(const Reduced& x) {
  return negated_if(((x.quarters + 1) & 2) != 0, (x.quarters & 1) != 0 ? sine_of(x.rest) : cosine_of(x.rest));
}

/// The arc tangent of small / big, 0 ≤ small ≤ big, both finite and big > 0.
NumberPair arctangent(double small, double big) {
  if (big > 0x1p960) small *= 0x1p-600, big *= 0x1p-600;
  const double q = small / big;
  if (q < 0x1p-60) return {q, 0};
  if (small < 0x1p-800) small *= 0x1p800, big *= 0x1p800;
  const NumberPair p = exact_product(q, big);
  const double rest = ((small - p.high) - p.low) / big;  // q + rest is the quotient
  if (q < 0.4375) {
    const double z = q * q;
    return {q, q * z * polynomial(kArctangent, z) + rest * (1 - z)};
  }
  const auto k = static_cast<int>(16 * q + 0.5);
  const double at = 0.0625 * k, t = ((q - at) + rest) / (1 + q * at), z = t * t;
  const NumberPair& arc = kArcs[k - kFirstArc];
  return {arc.high, arc.low + (t + t * z * polynomial(kShortArctangent, z))};
}

/// from − x or from + x, rounded once.
double from_angle(const NumberPair& from, const NumberPair& x, bool minus) {
  const NumberPair s = exact_sum(from.high, minus ? -x.high : x.high);
  return s.high + (s.low + (from.low + (minus ? -x.low : x.low)));
}

/// asin x for |x| ≤ 1/2 and a little.
NumberPair small_arcsine(const NumberPair& x) {
  const double z = x.high * x.high;
  return {x.high, x.high * z * polynomial(kArcsine, z) + x.low * (1 + 0.5 * z)};
}

/// acos x = 2 asin √((1 − x)/2) for x ≥ 1/2.
NumberPair large_arccosine(double x) {
  const double z = 0.5 * (1 - x), s = std::sqrt(z);
  if (!(z > 0)) return {};
  const NumberPair square = exact_product(s, s);
  const NumberPair half = small_arcsine({s, ((z - square.high) - square.low) / (2 * s)});
  return {2 * half.high, 2 * half.low};
}

}  // namespace

double sin(double x) {
  if (!std::isfinite(x)) return kNan;
  if (std::abs(x) < 0x1p-27) return x;
  const NumberPair s = sine_of(reduce(x));
  return s.high + s.low;
}

double cos(double x) {
  if (!std::isfinite(x)) return kNan;
  const NumberPair c = cosine_of(reduce(x));
  return c.high + c.low;
}

double tan(double x) {
  if (!std::isfinite(x)) return kNan;
  if (std::abs(x) < 0x1p-27) return x;
  const Reduced reduced = reduce(x);
  const NumberPair s = sine_of(reduced), c = cosine_of(reduced);
  const NumberPair t = quotient(ordered_sum(s.high, s.low), ordered_sum(c.high, c.low));
  return t.high + t.low;
}

double asin(double x) {
  const double size = std::abs(x);
  if (!(size <= 1)) return kNan;
  if (size < 0x1p-27) return x;
  if (size > 0.5) return std::copysign(from_angle(kQuarterTurn, large_arccosine(size), true), x);
  const NumberPair a = small_arcsine({x, 0});
  return a.high + a.low;
}

double acos(double x) {
  const double size = std::abs(x);
  if (!(size <= 1)) return kNan;
  if (size <= 0.5) return from_angle(kQuarterTurn, small_arcsine({x, 0}), true);
  const NumberPair a = large_arccosine(size);
  return x > 0 ? a.high + a.low : from_angle(kHalfTurn, a, true);
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNan;
  double up = std::abs(y), along = std::abs(x);
  if (std::isinf(up) || std::isinf(along)) up = std::isinf(up) ? 1 : 0, along = std::isinf(along) ? 1 : 0;
  if (up == 0 && along == 0) along = 1;  // by the sign of x: 0 or π
  const bool steep = up > along, back = std::signbit(x);
  const NumberPair a = steep ? arctangent(along, up) : arctangent(up, along);
  const double angle = steep  ? from_angle(kQuarterTurn, a, !back)
                       : back ? from_angle(kHalfTurn, a, true)
                              : a.high + a.low;
  return std::copysign(angle, y);
}

double atan(double x) {
  return atan2(x, 1);
}

}  // namespace riffler::base
