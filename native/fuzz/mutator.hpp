// Mutates bytes, like damaged files and like an attacker's.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace riffler::fuzz {

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  /// Makes one to eight changes, with pieces of `other` and words of the formats. Leaves at most `most` bytes.
  void mutate(std::vector<std::uint8_t>& bytes, std::span<const std::uint8_t> other, std::size_t most);
  std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random_() % n); }

 private:
  void change(std::vector<std::uint8_t>& bytes, std::span<const std::uint8_t> other);

  std::mt19937_64 random_;
};

}  // namespace riffler::fuzz
