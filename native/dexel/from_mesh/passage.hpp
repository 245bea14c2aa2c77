// Where a column passes through an opening of a broken part.
#pragma once

#include <cstdint>

#include "riffler/dexel/span.hpp"

namespace riffler::dexel {

/// A column's passage through an opening. With w = n + K and n an integer, |w| > ½ exactly where n plus K rounded to an
/// integer is not zero. Rounded K changes by `sign` at z, so a passage is one more signed crossing, and all crossings
/// of a column, from below the part to above it, sum to zero.
struct Passage {
  std::int32_t row, column;
  double z;  ///< mm along the ray
  std::int32_t sign;
  PackedNormal normal;  ///< against K's gradient, out of what lies where K is greater; only for grids with normals
};

}  // namespace riffler::dexel
