// Drilling and tapping cycles of Heidenhain controls: what happens at one hole, along the tool (TNC 640, User's Manual
// for Cycle Programming).
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "nc/read/drill_cycle.hpp"
#include "nc/read/heidenhain_values.hpp"
#include "nc/source.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// A feed in a cycle's parameters that stands for FMAX.
inline constexpr double kHeidenhainFmax = 99'999.999;

/// What a cycle needs beside its parameters.
struct HeidenhainCycleSetting {
  double unit = 1;       ///< mm
  double feed_unit = 1;  ///< mm/min that an F of 1 is
  double speed = 0;      ///< rev/min of the spindle
  double height = 0;     ///< mm, of the tip where the cycle is called
  /// Of cycle 1: set-up clearance, depth, depth of a peck, dwell, feed. Of cycle 2: set-up clearance, depth, dwell,
  /// feed.
  std::array<std::optional<double>, 5> old{};
};

/// Whether the cycle is a hole that is read: 1, 2, 200 to 203, 205, 206, 207, 209, 241.
bool is_heidenhain_hole(int number);

/// Calls `move` for every stroke of cycle `number`. FormatError for parameters that are missing or out of range, and
/// for more pecks than can be held.
void heidenhain_hole(int number, const HeidenhainCycleSetting& setting, const HeidenhainValues& values,
                     const NcPlace& place, const std::function<void(const HoleStroke&)>& move);

}  // namespace riffler::nc
