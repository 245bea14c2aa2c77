// The .rvol file format. All numbers are little-endian.
//
//   header (96 bytes)  magic 8 | version u32 | directions, 4 characters | length of the file u64 | lower, upper, pitch
//                      7 × f64 | stored spans u64 | stored tiles u32 | CRC-32 of everything before it u32
//   then, for each grid in the order of `directions`, one "map" chunk and as many "tile" chunks as needed:
//   chunk (24 bytes)   kind, 4 characters | items u32 | spans u32 | length of the payload u64 |
//                      CRC-32 of these 20 bytes and the payload u32 | payload
//
// A map chunk has one item per tile of the grid: a column of u32, the number of the stored tile, with 0 for the empty
// tile and 1, 2, … in the order of first appearance. The items of a tile chunk are the next stored tiles: columns of
// spans per ray (u32, 1024 per tile), near ends, far ends (bits of a double, u64) and, for "xyz", u and v of the near
// and of the far normal (u16). planes.hpp defines the encoding of a column. Tiles with equal content are stored once,
// regardless of their history, so equal volumes give equal files.
#pragma once

#include <array>
#include <cstdint>

#include "base/bytes.hpp"

namespace riffler::dexel::rvol {

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'R', 'V', 'O', 'L', '\r', '\n', 0x1A};
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::size_t kHeader = 96, kChunkHeader = 24;
/// A tile chunk ends once it has this many tiles or spans: enough for deflate, and small enough to give every thread
/// work.
inline constexpr std::size_t kChunkTiles = 64, kChunkSpans = std::size_t{1} << 18;
inline constexpr std::uint32_t kMap = 0x2070616D, kTiles = 0x656C6974;  // "map ", "tile"

}  // namespace riffler::dexel::rvol
