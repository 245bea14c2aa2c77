#include "geom/hypot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace riffler::geom::hypot_test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Hypot, IsExactWhereTheHypotenuseIsANumber) {
  for (const double unit : {1.0, 0x1p-1074, 0x1p-1060, 0x1p-600, 0x1p-450, 0x1p499, 0x1p1018})
    for (const auto& [a, b, c] : {std::array{3.0, 4.0, 5.0}, {5.0, 12.0, 13.0}, {20.0, 21.0, 29.0}}) {
      EXPECT_EQ(hypot(a * unit, b * unit), c * unit);
      EXPECT_EQ(hypot(-b * unit, a * unit), c * unit);
    }
}

TEST(Hypot, HasTheSameBitsAtEveryScale) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> side(0.5, 1);
  std::uniform_int_distribution<int> smaller(0, 29);
  for (int power = -990; power <= 1020; ++power)
    for (int i = 0; i < 20; ++i) {
      const double x = side(random), y = std::ldexp(side(random), -smaller(random)), h = hypot(x, y);
      ASSERT_EQ(hypot(std::ldexp(y, power), std::ldexp(x, power)), std::ldexp(h, power))
          << x << ' ' << y << ' ' << power;
    }
}

TEST(Hypot, HandlesZeroInfinityAndNan) {
  EXPECT_EQ(hypot(0, 0), 0);
  EXPECT_FALSE(std::signbit(hypot(-0.0, -0.0)));
  EXPECT_EQ(hypot(0, -7.25), 7.25);
  EXPECT_EQ(hypot(0x1p-1074, 0), 0x1p-1074);
  EXPECT_EQ(hypot(-kInf, 1), kInf);
  EXPECT_EQ(hypot(kNan, -kInf), kInf);
  EXPECT_TRUE(std::isnan(hypot(kNan, 1)));
  EXPECT_TRUE(std::isnan(hypot(0, kNan)));
  EXPECT_TRUE(std::isnan(hypot(kNan, 0)));
  EXPECT_EQ(hypot(std::numeric_limits<double>::max(), std::numeric_limits<double>::max()), kInf);
  EXPECT_EQ(hypot(std::numeric_limits<double>::max(), 1), std::numeric_limits<double>::max());
}

TEST(Hypot, IsWithinHalfAUnitOfTheLastPlace) {
  if constexpr (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "no wider numbers to compare with";
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> side(-1, 1), power(-30, 30);
  long double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x = side(random), y = side(random) * std::exp2(power(random)), h = hypot(x, y);
    const long double exact = std::sqrt(static_cast<long double>(x) * x + static_cast<long double>(y) * y);
    const double ulp = std::nextafter(h, kInf) - h;
    worst = std::max(worst, std::abs(h - exact) / ulp);
  }
  EXPECT_LT(worst, 0.502L);
}

TEST(Hypot, HasTheseBitsOnEverySystem) {
  std::mt19937_64 random(11);
  std::uint64_t sum = 0;
  const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 100000; ++i) {
    const double x = draw(), y = draw();
    sum = std::rotl(sum, 5) ^ std::bit_cast<std::uint64_t>(hypot(x, y));
  }
  EXPECT_EQ(sum, 16295578536664438148u);
}

}  // namespace
}  // namespace riffler::geom::hypot_test
