#include "base/functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>

namespace riffler::base::functions_test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMost = std::numeric_limits<double>::max(), kLeast = std::numeric_limits<double>::denorm_min();

/// Windows' C library has no reliable functions of 64 bits, and other systems no such numbers.
#ifdef _WIN32
constexpr bool kHasReference = false;
#else
constexpr bool kHasReference = std::numeric_limits<long double>::digits >= 64;
#endif

/// In units of the last place of `exact`.
double error(double found, long double exact) {
  const double near = std::abs(static_cast<double>(exact));
  const double place = std::nextafter(near, kInf) - near;
  return static_cast<double>(std::abs(found - exact) / place);
}

/// The largest error for arguments that `draw` gives.
template <class Own, class Exact, class Draw>
double worst(Own own, Exact exact, Draw draw) {
  double most = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x = draw();
    most = std::max(most, error(own(x), exact(static_cast<long double>(x))));
  }
  return most;
}

struct Draw {
  std::mt19937_64 random{7};
  double unit() { return static_cast<double>(random() >> 11) * 0x1p-53; }  // the same on every system
  double within(double low, double high) { return low + (high - low) * unit(); }
  double power(double low, double high) {  // of two, of either sign
    const int exponent = static_cast<int>(std::floor(within(low, high)));
    return std::ldexp(unit() < 0.5 ? -1 - unit() : 1 + unit(), exponent);
  }
};

#define RIFFLER_WORST(name, draw, most)                                                                                \
  EXPECT_LT(                                                                                                           \
      worst([](double x) { return base::name(x); }, [](long double x) { return std::name(x); }, [&] { return draw; }), \
      most)

TEST(Functions, OfAnglesAreWithinAUnitOfTheLastPlace) {
  if (!kHasReference) GTEST_SKIP() << "no functions of wider numbers to compare with";
  Draw d;
  for (const double most : {0.8, 1.0, 4.0, 1e3, 1e6, 1e7}) {
    RIFFLER_WORST(sin, d.within(-most, most), 0.8);
    RIFFLER_WORST(cos, d.within(-most, most), 0.8);
    RIFFLER_WORST(tan, d.within(-most, most), 1.0);
  }
  RIFFLER_WORST(sin, d.power(-60, 60), 0.8);
  RIFFLER_WORST(cos, d.power(-60, 60), 0.8);
  RIFFLER_WORST(tan, d.power(-60, 60), 1.0);
  // Near multiples of a quarter turn, where the reduced argument is small.
  const auto near_quarters = [&] {
    return std::floor(d.within(1, 1e5)) * (std::numbers::pi / 2) * (1 + d.within(-1e-15, 1e-15));
  };
  RIFFLER_WORST(sin, near_quarters(), 0.8);
  RIFFLER_WORST(cos, near_quarters(), 0.8);
  RIFFLER_WORST(tan, near_quarters(), 1.0);
}

TEST(Functions, OfSinesAndTangentsAreWithinAUnitOfTheLastPlace) {
  if (!kHasReference) GTEST_SKIP() << "no functions of wider numbers to compare with";
  Draw d;
  RIFFLER_WORST(asin, d.within(-1, 1), 0.7);
  RIFFLER_WORST(acos, d.within(-1, 1), 0.7);
  RIFFLER_WORST(asin, 1 - std::abs(d.power(-50, -1)), 0.7);
  RIFFLER_WORST(acos, 1 - std::abs(d.power(-50, -1)), 0.7);
  RIFFLER_WORST(acos, std::abs(d.power(-50, -1)) - 1, 0.7);
  RIFFLER_WORST(asin, d.power(-40, 0) * 0.5, 0.7);
  RIFFLER_WORST(atan, d.within(-2, 2), 0.7);
  RIFFLER_WORST(atan, d.power(-60, 60), 0.7);
  double most = 0;
  for (int i = 0; i < 500000; ++i) {
    const int size = static_cast<int>(d.within(-900, 900));
    const double y = std::ldexp(d.power(-6, 6), size), x = std::ldexp(d.power(-6, 6), size);
    most =
        std::max(most, error(base::atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))));
  }
  EXPECT_LT(most, 0.7);
}

TEST(Functions, OfExponentsAreWithinAUnitOfTheLastPlace) {
  if (!kHasReference) GTEST_SKIP() << "no functions of wider numbers to compare with";
  Draw d;
  RIFFLER_WORST(exp, d.within(-700, 709), 0.6);
  RIFFLER_WORST(exp, d.power(-60, 3), 0.6);
  RIFFLER_WORST(expm1, d.within(-1, 1), 0.7);
  RIFFLER_WORST(expm1, d.within(-40, 709), 0.7);
  RIFFLER_WORST(expm1, d.power(-60, 3), 0.7);
  RIFFLER_WORST(tanh, d.power(-60, 5), 0.7);
  RIFFLER_WORST(log, std::abs(d.power(-1000, 1000)), 0.6);
  RIFFLER_WORST(log, 1 + d.power(-50, -1), 0.6);
  RIFFLER_WORST(log2, std::abs(d.power(-1000, 1000)), 0.6);
  RIFFLER_WORST(log2, 1 + d.power(-50, -1), 0.6);
  RIFFLER_WORST(log10, std::abs(d.power(-1000, 1000)), 0.6);
  RIFFLER_WORST(log10, 1 + d.power(-50, -1), 0.6);
  double most = 0;
  for (int i = 0; i < 500000; ++i) {
    const double x = std::abs(d.power(-20, 20)), y = d.within(-30, 30);
    most = std::max(most, error(base::pow(x, y), std::pow(static_cast<long double>(x), static_cast<long double>(y))));
  }
  EXPECT_LT(most, 0.6);
}

/// References: mpmath with 1 600 bits.
TEST(Functions, OfHugeAnglesAreRight) {
  struct Case {
    double x, sine, cosine, tangent;
  };
  // The first is the double that is nearest to a multiple of π/2, of all.
  for (const auto& [x, sine, cosine, tangent] : {
           Case{std::ldexp(6381956970095103.0, 797), 1, -0x1.14ae72e6ba22fp-61, -0x1.d9ba9a7975636p+60},
           {1e22, -0x1.b453ab76bf397p-1, 0x1.0be2cef01c8f4p-1, -0x1.a0f79c1b6b257p+0},
           {kMost, 0x1.452fc98b34e97p-8, -0x1.fffe62ecfab75p-1, -0x1.4530cfe729484p-8},
           {1e6, -0x1.6664b2568d867p-2, 0x1.df9df9906d32cp-1, -0x1.7e9768ab734c0p-2},
           {3e6, -0x1.c1c972eb2f878p-1, 0x1.e93a1503a252dp-2, -0x1.d6b9606e45601p+0},
       }) {
    EXPECT_LE(error(base::sin(x), sine), 1) << x;
    EXPECT_LE(error(base::cos(x), cosine), 1) << x;
    EXPECT_LE(error(base::tan(x), tangent), 1) << x;
    EXPECT_EQ(base::sin(-x), -base::sin(x)) << x;
    EXPECT_EQ(base::cos(-x), base::cos(x)) << x;
  }
}

/// Two numbers alike, or two NaNs; zeros with their sign.
void expect_same(double found, double expected, const std::string& where) {
  EXPECT_TRUE(std::isnan(expected) ? std::isnan(found)
                                   : found == expected && std::signbit(found) == std::signbit(expected))
      << where << ": " << found << " instead of " << expected;
}

TEST(Functions, TreatZerosInfinitiesAndNanAsTheCLibraryDoes) {
  const double values[] = {0.0, -0.0, 1,     -1,   2,     -2,     3,      0.5,    -0.5,
                           -3,  kInf, -kInf, kNan, kMost, -kMost, kLeast, -kLeast};
  const auto number = [](double x) { return std::isnan(x) || std::isinf(x) || x == std::trunc(x); };
  for (const double x : values) {
    const std::string at = std::to_string(x);
    if (!std::isfinite(x) || std::abs(x) == 0 || std::abs(x) == kLeast) {
      expect_same(base::sin(x), std::sin(x), "sin " + at);
      expect_same(base::cos(x), std::cos(x), "cos " + at);
      expect_same(base::tan(x), std::tan(x), "tan " + at);
    }
    if (x != 0.5 && x != -0.5) expect_same(base::asin(x), std::asin(x), "asin " + at);
    if (x != 0.5 && x != -0.5) expect_same(base::acos(x), std::acos(x), "acos " + at);
    if (!(std::abs(x) > 0 && std::abs(x) < 10) || std::abs(x) == kLeast) {
      expect_same(base::exp(x), std::exp(x), "exp " + at);
      expect_same(base::expm1(x), std::expm1(x), "expm1 " + at);
      expect_same(base::tanh(x), std::tanh(x), "tanh " + at);
    }
    if (!(x > 1 && x < kInf) && x != 0.5 && x != kLeast) {
      expect_same(base::log(x), std::log(x), "log " + at);
      expect_same(base::log2(x), std::log2(x), "log2 " + at);
      expect_same(base::log10(x), std::log10(x), "log10 " + at);
    }
    for (const double y : values) {
      const std::string both = at + ", " + std::to_string(y);
      if (x == 0 || std::abs(x) == std::abs(y) || !std::isfinite(x) || !std::isfinite(y) || y == 0)
        expect_same(base::atan2(x, y), std::atan2(x, y), "atan2 " + both);
      if (number(std::pow(x, y))) expect_same(base::pow(x, y), std::pow(x, y), "pow " + both);
    }
  }
}

TEST(Functions, GivePowersExactly) {
  for (int k = 0; k <= 22; ++k) {
    double power = 1;
    for (int i = 0; i < k; ++i) power *= 10;
    EXPECT_EQ(base::pow(10, k), power);
    EXPECT_LE(error(base::pow(10, -k), 1 / power), 1);
    EXPECT_EQ(base::log10(power), k);
  }
  for (int k = -1074; k <= 1023; ++k) {
    EXPECT_EQ(base::log2(std::ldexp(1, k)), k);
    EXPECT_EQ(base::pow(2, k), std::ldexp(1, k));
  }
  EXPECT_EQ(base::exp(710), kInf);
  EXPECT_EQ(base::exp(-750), 0);
  EXPECT_EQ(base::sin(std::numbers::pi / 6), std::sin(std::numbers::pi / 6));
  EXPECT_EQ(base::acos(-1), std::numbers::pi);
  EXPECT_EQ(base::atan2(1, 0), std::numbers::pi / 2);
}

TEST(Functions, HaveTheseBitsOnEverySystem) {
  Draw d;
  std::uint64_t sum = 0;
  const auto add = [&](double x) { sum = std::rotl(sum, 5) ^ std::bit_cast<std::uint64_t>(x); };
  for (int i = 0; i < 20000; ++i) {
    const double x = d.power(-10, 30), y = d.within(-1, 1), z = std::abs(d.power(-40, 40));
    for (const double value : {base::sin(x), base::cos(x), base::tan(x), base::asin(y), base::acos(y), base::atan(x),
                               base::atan2(y, x), base::exp(9 * y), base::expm1(y), base::log(z), base::log2(z),
                               base::log10(z), base::pow(z, 3 * y), base::tanh(y)})
      add(value);
  }
  EXPECT_EQ(sum, 12091085065154388271u);
}

}  // namespace
}  // namespace riffler::base::functions_test
