// Bit mixing for hash tables and checksums.
#pragma once

#include <cstdint>

namespace riffler::base {

/// The finaliser of MurmurHash3.
inline std::uint64_t mix_bits(std::uint64_t x) {
  x ^= x >> 33, x *= 0xff51afd7ed558ccdULL;
  x ^= x >> 33, x *= 0xc4ceb9fe1a85ec53ULL;
  return x ^ x >> 33;
}

}  // namespace riffler::base
