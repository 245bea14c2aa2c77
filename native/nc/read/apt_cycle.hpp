// CYCLE/… of APT files as CAM systems write it: the moves at each GOTO until CYCLE/OFF.
#pragma once

#include <functional>
#include <optional>

#include "nc/read/apt_lexer.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::nc {

/// Lengths in mm from the programmed point along the tool's axis.
struct AptCycle {
  double depth = 0;        ///< FEDTO: depth of the bottom below the point
  double clearance = 0;    ///< RAPTO: height above the point where rapid motion ends
  double retract = 0;      ///< RTRCTO: final height; default: clearance
  double first_peck = 0;   ///< 1STPECK; 0: no pecking
  double peck = 0;         ///< SUBPECK or INCR: pecks after the first
  double feed = 0;         ///< mm/min; 0: feed of FEDRAT
  bool feeds_out = false;  ///< retracts at feed: taps, reamers and boring bars
};

/// The cycle that a statement CYCLE/… starts; no value for OFF, INIT or ON. `unit`: mm per length unit. Throws
/// FormatError for unknown words, and for numbers without words, whose meaning depends on the post processor.
std::optional<AptCycle> apt_cycle(const AptStatement& statement, const AptLexer& lexer, double unit,
                                  const NcPlace& place);

/// Calls `move(pose, rapid)` for every move of the cycle at `point`.
void apt_cycle_moves(const AptCycle& cycle, const Pose& point, const std::function<void(const Pose&, bool)>& move);

}  // namespace riffler::nc
