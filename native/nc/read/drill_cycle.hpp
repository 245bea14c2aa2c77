// Canned drilling cycles: what happens at one hole, along the drilling axis.
#pragma once

#include <functional>
#include <optional>

#include "nc/source.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Heights along the drilling axis, mm.
struct DrillCycle {
  int code;        ///< times ten: 810 for G81
  double retract;  ///< R
  double bottom;   ///< Z
  double clear;    ///< where the tool goes in the end: R, or the level from before (G98)
  double peck;     ///< Q, of G73, G83 and of tapping; 0: none
};

/// A move to a height, mm, in a cycle whose parameters say each of them.
struct HoleStroke {
  double height;
  double feed;                    ///< mm/min; 0: rapid
  std::optional<double> spindle;  ///< rev/min, > 0 clockwise; none: as it turns
  Vec2 aside{0};                  ///< mm, from the hole's axis
};

/// LinuxCNC's: what a peck keeps from the ground before (G83), or breaks the chip with (G73).
inline constexpr double kPeckClearance = 0.254;

/// Whether `code` (times ten) is a drilling cycle that is read.
bool is_drill_cycle(int code);

/// G74 and G84: in and out in feed.
bool is_tapping_cycle(int code);

/// Calls `move(height, rapid)` for every move from R on. FormatError where the cycle has more pecks than can be held.
void drill(const DrillCycle& cycle, const NcPlace& place, const std::function<void(double, bool)>& move);

}  // namespace riffler::nc
