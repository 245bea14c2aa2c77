// Drilling and tapping cycles of Heidenhain controls: the moves at one hole, along the tool (TNC 640, User's Manual for
// Cycle Programming).
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "nc/read/drill_cycle.hpp"
#include "nc/read/heidenhain_values.hpp"
#include "nc/source.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// The value of a cycle's feed parameter that means FMAX.
inline constexpr double kHeidenhainFmax = 99'999.999;

/// Inputs of a cycle other than its parameters.
struct HeidenhainCycleSetting {
  double unit = 1;       ///< mm
  double feed_unit = 1;  ///< mm/min per unit of F
  double speed = 0;      ///< rev/min of the spindle
  double height = 0;     ///< mm: height of the tip at the call
  /// Cycle 1: set-up clearance, depth, peck depth, dwell, feed. Cycle 2: set-up clearance, depth, dwell, feed.
  std::array<std::optional<double>, 5> old{};
};

/// Whether the cycle is a supported hole: 1, 2, 200 to 203, 205, 206, 207, 209, 241.
bool is_heidenhain_hole(int number);

/// Calls `move` for every stroke of cycle `number`. Throws FormatError for parameters that are missing or out of range,
/// and for more pecks than can be stored.
void heidenhain_hole(int number, const HeidenhainCycleSetting& setting, const HeidenhainValues& values,
                     const NcPlace& place, const std::function<void(const HoleStroke&)>& move);

}  // namespace riffler::nc
