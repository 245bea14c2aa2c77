// From cuts to a program: approaches, cuts and retracts.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "riffler/nc/link_rule.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// One cut: cutter locations that become consecutive feed moves.
struct CutterPath {
  std::vector<Pose> poses;   ///< at least one
  std::vector<double> feed;  ///< mm/min at the tip: one for all rows or one per row
  double spindle = 0;        ///< rev/min, as in Move
  int tool = 1;
};

/// The space in which a tool may make rapid moves between cuts.
struct Clearance {
  /// z (mm) above stock, part, fixtures and every tip. Default: the top of `occupied` and of all tips, plus `distance`.
  std::optional<double> safe_height;
  /// Margin around occupied space, mm.
  double distance = 10;
  /// Box around stock, part and fixtures, where known, mm.
  Box3 occupied;
};

/// A program with every path as a cut. Per path: rapid at safe height to a point above the path's first point, along
/// the tool's axis; feed in to that point; the rows as feed moves, none merged; rapid out along the axis to safe
/// height. If the axis is tilted by more than 60°, the retract leaves the occupied box sideways and then rises. Rapids
/// pass through the box around occupied space and tips only along the axis at the two ends of a cut. Throws
/// std::invalid_argument naming path and row for what Program::append refuses, an empty path, a feed that is not
/// positive, or a safe height below an occupied point.
///
/// With a collider in `links`, part and fixtures count as occupied, and approaches and retracts are checked with
/// cutter, shank and holder (nc/links.hpp). Where the move along the axis is not clear, another one is taken. It may
/// cross stock, so it runs at feed up to the end of occupied space unless `links.lead_in` declares all but the last
/// part to be air. Throws RowError naming path, row and place where no clear move exists, and for a tool without a
/// known shape.
Program program_from_paths(std::span<const CutterPath> paths, std::map<int, Tool> tools,
                           const Clearance& clearance = {}, const LinkRule& links = {});

}  // namespace riffler::nc
