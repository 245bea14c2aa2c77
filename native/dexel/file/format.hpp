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

#include <array>
#include <cstdint>

#include "base/bytes.hpp"

namespace riffler::dexel::rvol {

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'R', 'V', 'O', 'L', '\r', '\n', 0x1A};
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::size_t kHeader = 96, kChunkHeader = 24;
/// A tile chunk ends when it has this many tiles or spans: enough for deflate, small enough for every thread.
inline constexpr std::size_t kChunkTiles = 64, kChunkSpans = std::size_t{1} << 18;
inline constexpr std::uint32_t kMap = 0x2070616D, kTiles = 0x656C6974;  // "map ", "tile"

}  // namespace riffler::dexel::rvol
