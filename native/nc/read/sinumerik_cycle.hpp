// Drilling, boring and tapping cycles of Sinumerik controls: the moves at one hole, along the plane's normal (Siemens,
// Programming Manual Cycles).
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "nc/read/drill_cycle.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// Inputs of a cycle other than its parameters.
struct SinumerikCycleSetting {
  double unit = 1;       ///< mm
  double feed_unit = 1;  ///< mm/min per unit of F
  double feed = 0;       ///< mm/min; 0: none
  double speed = 0;      ///< rev/min of the spindle
  int turning = 0;       ///< 1 clockwise
};

/// The number in a cycle's name, such as "CYCLE81"; 0 if it has none.
int number_of_cycle(std::string_view name);

/// Whether CYCLE`number` is a supported hole: 81 to 89, 840.
bool is_sinumerik_hole(int number);

/// Calls `move` for every stroke of CYCLE`number`. `parameters`: in order, no value for omitted ones. Throws
/// FormatError for parameters that are missing or out of range, and for more pecks than can be stored.
void sinumerik_hole(int number, const SinumerikCycleSetting& setting,
                    const std::vector<std::optional<double>>& parameters, const NcPlace& place,
                    const std::function<void(const HoleStroke&)>& move);

}  // namespace riffler::nc
