// What is known of the tip's position.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace riffler::nc {

/// Knowledge of one coordinate of the tip.
enum class TipStand : std::uint8_t {
  Given,    ///< programmed
  Start,    ///< as before the program: taken as 0
  Machine,  ///< its place in the part depends on the machine
};

/// One entry each for X, Y and Z.
using TipStands = std::array<TipStand, 3>;

inline bool has_stand(const TipStands& stands, TipStand stand) {
  return std::ranges::find(stands, stand) != stands.end();
}

/// The letters of the axes in state `stand`, separated by `apart`.
inline std::string axes_of(const TipStands& stands, TipStand stand, std::string_view apart = "") {
  std::string out;
  for (std::size_t k = 0; k < stands.size(); ++k)
    if (stands[k] == stand) out.append(out.empty() ? "" : apart).append(1, "XYZ"[k]);
  return out;
}

}  // namespace riffler::nc
