// The passage of a column through an opening of a broken part.
#pragma once

#include <cstdint>

#include "riffler/dexel/span.hpp"

namespace riffler::dexel {

/// With w = n + K and n an integer, |w| > ½ exactly if n plus the rounded K is not zero. The rounded K changes by
/// `sign` at z, so a passage is one more signed crossing. All crossings of a column, from below the part to above it,
/// sum to zero.
struct Passage {
  std::int32_t row, column;
  double z;  ///< mm along the ray
  std::int32_t sign;
  PackedNormal normal;  ///< against K's gradient: out of the side where K is greater; only for grids with normals
};

}  // namespace riffler::dexel
