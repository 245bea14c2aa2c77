#include "geom/float32.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>

namespace riffler::geom::float32_test {
namespace {

/// Rounds to 24 significant bits by integer arithmetic on the bits of a double (ties to even); normal numbers only.
double rounded_by_bits(double x) {
  auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t rest = bits & 0x1fffffff, half = 0x10000000;
  bits -= rest;
  if (rest > half || (rest == half && (bits & 0x20000000))) bits += 0x20000000;
  return std::bit_cast<double>(bits);
}

TEST(Float32, RoundsEveryComponent) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1000, 1000);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 v{coordinate(random), coordinate(random), coordinate(random)};
    EXPECT_EQ(to_float32(v), Vec3(rounded_by_bits(v.x), rounded_by_bits(v.y), rounded_by_bits(v.z)));
  }
}

}  // namespace
}  // namespace riffler::geom::float32_test
