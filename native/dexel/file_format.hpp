// The .rvol file, all numbers little-endian:
//
//   header (96 bytes)  magic 8 | version u32 | directions, 4 characters | length of the file u64 | lower, upper, pitch
//                      7 × f64 | spans stored u64 | tiles stored u32 | CRC-32 of what is before it u32
//   then, for each grid in the order of `directions`, one "map" chunk and as many "tile" chunks as it takes:
//   chunk (24 bytes)   kind, 4 characters | items u32 | spans u32 | payload's length u64 | CRC-32 of the 20 bytes
//   before
//                      and the payload u32 | payload
//
// A map chunk's items are the grid's tiles: a column u32 that says which stored tile stands there, 0 for the empty one,
// 1, 2, … in order of first appearance. A tile chunk's items are the next stored tiles: columns of spans per ray (u32,
// 1024 a tile), near ends, far ends (bits of a double, u64), and for "xyz" u and v of the near and the far normal
// (u16). Columns are as planes.hpp has them. Tiles of equal content are stored once, whatever their history was: equal
// volumes are equal files.
#pragma once

#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace riffler {

static_assert(std::endian::native == std::endian::little, "the file's numbers are copied as they stand in memory");

namespace rvol {

using Bytes = std::vector<std::uint8_t>;

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'R', 'V', 'O', 'L', '\r', '\n', 0x1A};
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::size_t kHeader = 96, kChunkHeader = 24;
/// A tile chunk ends when it has this many tiles or spans: enough for deflate, small enough for every thread.
inline constexpr std::size_t kChunkTiles = 64, kChunkSpans = std::size_t{1} << 18;
inline constexpr std::uint32_t kMap = 0x2070616D, kTiles = 0x656C6974;  // "map ", "tile"

inline std::uint32_t checksum(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b = {}) {
  uLong crc = 0;
  for (const auto part : {a, b})
    if (!part.empty()) crc = crc32_z(crc, part.data(), part.size());  // a null pointer would start anew
  return static_cast<std::uint32_t>(crc);
}

template <class T>
void put(Bytes& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

template <class T>
T get(std::span<const std::uint8_t> bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace rvol
}  // namespace riffler
