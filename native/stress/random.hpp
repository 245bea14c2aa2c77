// Random numbers from the standard library's generator. Own distributions, because those of libraries differ.
#pragma once

#include <cstdint>
#include <random>

#include "riffler/geom/vec.hpp"

namespace riffler::stress {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  /// One of many independent streams.
  Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) : bits_(mix(mix(mix(seed) ^ stream) ^ index)) {}

  std::uint64_t bits() { return bits_(); }
  /// In [0, 1).
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  double uniform(double from, double to) { return from + uniform() * (to - from); }
  /// 10 to the power of a uniform number.
  double power_of_ten(double from, double to) { return std::pow(10.0, uniform(from, to)); }
  int below(int n) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(n)); }
  bool one_in(int n) { return below(n) == 0; }
  double sign() { return one_in(2) ? 1 : -1; }
  template <class T, std::size_t N>
  const T& one_of(const T (&list)[N]) {
    return list[below(static_cast<int>(N))];
  }

  Vec3 direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 6.283185307179586), r = std::sqrt((1 - z) * (1 + z));
    return glm::normalize(Vec3(r * std::cos(angle), r * std::sin(angle), z));
  }
  /// A unit vector perpendicular to `a`.
  Vec3 square_to(const Vec3& a) {
    for (;;) {
      const Vec3 c = glm::cross(a, direction());
      if (glm::length(c) > 0.1) return glm::normalize(c);
    }
  }
  /// Plus or minus one of the coordinate axes: a direction of rays.
  Vec3 along_rays() {
    Vec3 a{0};
    a[below(3)] = sign();
    return a;
  }

 private:
  /// The finaliser of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
  static std::uint64_t mix(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
    return x ^ (x >> 31);
  }

  std::mt19937_64 bits_;
};

}  // namespace riffler::stress
