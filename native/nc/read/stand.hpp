// What is known of where the tip is.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace riffler::nc {

/// Of a coordinate of the tip.
enum class TipStand : std::uint8_t {
  Given,    ///< the program named it
  Start,    ///< as before the program, taken for 0
  Machine,  ///< where in the part it is depends on the machine
};

/// Of X Y Z.
using TipStands = std::array<TipStand, 3>;

inline bool has_stand(const TipStands& stands, TipStand stand) {
  return std::ranges::find(stands, stand) != stands.end();
}

/// The letters of those that are `stand`, with `apart` between them.
inline std::string axes_of(const TipStands& stands, TipStand stand, std::string_view apart = "") {
  std::string out;
  for (std::size_t k = 0; k < stands.size(); ++k)
    if (stands[k] == stand) out.append(out.empty() ? "" : apart).append(1, "XYZ"[k]);
  return out;
}

}  // namespace riffler::nc
