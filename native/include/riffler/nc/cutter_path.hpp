// From cuts to a program: approach, cut, retract.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "riffler/nc/link_rule.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// One cut: a row of cutter locations that become feed moves in order.
struct CutterPath {
  std::vector<Pose> poses;   ///< at least one
  std::vector<double> feed;  ///< mm/min at the tip: one for all rows or one per row
  double spindle = 0;        ///< rev/min, as in Move
  int tool = 1;
};

/// The space through which a tool may move in rapid between cuts.
struct Clearance {
  /// z (mm) above stock, part, fixtures and every tip; where it is not given: the top of `occupied` and of all tips,
  /// plus `distance`.
  std::optional<double> safe_height;
  /// mm around what is occupied.
  double distance = 10;
  /// Stock, part and fixtures, as far as they are known.
  Box3 occupied;
};

/// Each path becomes: rapid at safe height to above its first point, along the tool's axis; feed in to that point; its
/// rows as feed moves, none merged; rapid out along the axis to safe height. An axis that would reach safe height only
/// far away (tilt over 60°) first leaves the occupied box sideways, then rises. No rapid passes through the occupied
/// box and the tips' box except along the axis at the two ends of a cut. Throws std::invalid_argument naming the path
/// and the row for what Program::append refuses, an empty path, a feed that is not positive, a safe height below an
/// occupied point.
///
/// With a collider in `links` part and fixtures count as occupied, and approaches and retracts are resolved with
/// cutter, shank and holder (nc/links.hpp): where the way along the axis is not clear another one is taken. That may
/// cross stock, so it is fed up to where everything ends, unless `links.lead_in` says that all but the last stretch is
/// air. RowError names the path, the row and the place where there is no clear one, and a tool whose shape is not
/// known.
Program program_from_paths(std::span<const CutterPath> paths, std::map<int, Tool> tools,
                           const Clearance& clearance = {}, const LinkRule& links = {});

}  // namespace riffler::nc
