// Drilling, boring and tapping cycles of Sinumerik controls: what happens at one hole, along the plane's normal
// (Siemens, Programming Manual Cycles).
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "nc/read/drill_cycle.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// What a cycle needs beside its parameters.
struct SinumerikCycleSetting {
  double unit = 1;       ///< mm
  double feed_unit = 1;  ///< mm/min that an F of 1 is
  double feed = 0;       ///< mm/min; 0: none
  double speed = 0;      ///< rev/min of the spindle
  int turning = 0;       ///< 1 clockwise
};

/// The number in a cycle's name, "CYCLE81"; 0 where it has none.
int number_of_cycle(std::string_view name);

/// Whether CYCLE`number` is a hole that is read: 81 to 89, 840.
bool is_sinumerik_hole(int number);

/// Calls `move` for every stroke of CYCLE`number`. `parameters`: in their order, none where one was left out.
/// FormatError for those that are missing or out of range, and for more pecks than can be held.
void sinumerik_hole(int number, const SinumerikCycleSetting& setting,
                    const std::vector<std::optional<double>>& parameters, const NcPlace& place,
                    const std::function<void(const HoleStroke&)>& move);

}  // namespace riffler::nc
