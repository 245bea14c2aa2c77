// Compiled without coverage itself.
#include "fuzz/coverage.hpp"

#include <array>
#include <bit>

namespace {

constexpr std::size_t kPlaces = 1 << 16;
std::array<std::uint8_t, kPlaces> taken;  // by hash of a branch: how often; threads may lose a count
std::array<std::uint8_t, kPlaces> known;  // classes of counts, one bit each
std::uint64_t found = 0;
thread_local std::uintptr_t last = 0;

/// Class of a count, as in AFL: 1, 2, 3, 4–7, 8–15, 16–31, 32–127, 128–255. One more turn of a loop is new only for
/// small counts.
std::uint8_t class_of(std::uint8_t count) {
  if (count < 4) return static_cast<std::uint8_t>(1U << (count - 1));
  const int power = std::bit_width(count) - 1;  // 2 to 7
  return static_cast<std::uint8_t>(1U << (power < 5 ? power + 1 : power < 7 ? 6 : 7));
}

}  // namespace

extern "C" void __sanitizer_cov_trace_pc() {
  const auto here = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  std::uint8_t& count = taken[((here >> 1) ^ last) % kPlaces];
  if (count < 255) ++count;
  last = here;
}

namespace riffler::fuzz {

void begin_coverage() {
  taken.fill(0);
  last = 0;
}

bool is_new_coverage() {
  bool is_new = false;
  for (std::size_t k = 0; k < kPlaces; ++k) {
    if (taken[k] == 0) continue;
    const std::uint8_t seen = class_of(taken[k]);
    if ((known[k] & seen) != 0) continue;
    known[k] |= seen, is_new = true, ++found;
  }
  return is_new;
}

std::uint64_t covered() {
  return found;
}

}  // namespace riffler::fuzz
