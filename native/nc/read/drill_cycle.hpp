// Canned drilling cycles: the moves at one hole, along the drilling axis.
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
  double clear;    ///< final height: R, or the level before the cycle (G98)
  double peck;     ///< Q, for G73, G83 and tapping; 0: none
};

/// A move to a height (mm), with its own feed and spindle, for cycles that specify them.
struct HoleStroke {
  double height;
  double feed;                    ///< mm/min; 0: rapid
  std::optional<double> spindle;  ///< rev/min, > 0 clockwise; no value: unchanged
  Vec2 aside{0};                  ///< mm, from the hole's axis
};

/// LinuxCNC's distance to the previous bottom when a peck re-enters (G83), and its retract to break chips (G73), mm.
inline constexpr double kPeckClearance = 0.254;

/// Whether `code` (times ten) is a supported drilling cycle.
bool is_drill_cycle(int code);

/// G74 and G84: in and out at feed.
bool is_tapping_cycle(int code);

/// Calls `move(height, rapid)` for every move from R on. Throws FormatError if the cycle has more pecks than can be
/// stored.
void drill(const DrillCycle& cycle, const NcPlace& place, const std::function<void(double, bool)>& move);

}  // namespace riffler::nc
