// CYCLE/… of APT files as CAM systems write it: what happens at each GOTO until CYCLE/OFF.
#pragma once

#include <functional>
#include <optional>

#include "nc/read/apt_lexer.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::nc {

/// Lengths in mm from the programmed point along the tool's axis.
struct AptCycle {
  double depth = 0;        ///< FEDTO: the bottom below the point
  double clearance = 0;    ///< RAPTO: above the point, to where it moves fast
  double retract = 0;      ///< RTRCTO: where it goes in the end; without it the clearance
  double first_peck = 0;   ///< 1STPECK; 0: no pecks
  double peck = 0;         ///< SUBPECK or INCR, of those after the first
  double feed = 0;         ///< mm/min; 0: that of FEDRAT
  bool feeds_out = false;  ///< taps, reamers and boring bars
};

/// The cycle that a statement CYCLE/… begins, or nothing where it says OFF, INIT or ON. `unit`: mm of a length.
/// FormatError for words that it does not know, and for numbers without words, which each post processor has its own
/// meaning for.
std::optional<AptCycle> apt_cycle(const AptStatement& statement, const AptLexer& lexer, double unit,
                                  const NcPlace& place);

/// Calls `move(pose, rapid)` for every move of the cycle at `point`.
void apt_cycle_moves(const AptCycle& cycle, const Pose& point, const std::function<void(const Pose&, bool)>& move);

}  // namespace riffler::nc
