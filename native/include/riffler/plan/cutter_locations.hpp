// From an oriented path to gouge-free cutter locations, at the points and between them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/plan/path.hpp"

namespace riffler::plan {

/// Clearance, tolerance and limits of the search.
struct LocationRule {
  double clearance = 0;  ///< wanted clearance to part and fixtures, mm
  /// How far the clearance may fall below `clearance`, mm. Finishing cuts touch the part everywhere: this depth counts
  /// as touching. Points are lifted to within half of it, which leaves the other half for the moves between them.
  double tolerance = 0.01;
  double max_lift = 100;         ///< mm along the axis
  int max_inserted = 200;        ///< points added between two points of the path
  int max_evaluations = 100000;  ///< clearance evaluations between two rows
};

/// One row of the result.
struct LocationRow {
  Pose pose;
  std::ptrdiff_t point = -1;                      ///< index of the path's point; −1: inserted
  double lift = 0;                                ///< mm along the axis from the pose on the path, or on the motion
  double before = 0;                              ///< clearance before the lift, mm
  double clearance = 0;                           ///< clearance after the lift, mm
  collide::Touch touch = collide::Touch::Cutter;  ///< what the tool was lifted off, or the nearest contact
};

/// A point of the path that has no row.
struct BlockedPoint {
  std::size_t point;
  std::string reason;
};

/// A move between two rows that could not be made or proven free.
struct UnsafeWay {
  std::size_t row;   ///< from this row to the next
  double clearance;  ///< smallest clearance found, mm
  double bound;      ///< lower bound of the clearance, mm
  std::string reason;
};

/// Rows of cutter locations, and the places where none could be found.
struct CutterLocations {
  std::vector<LocationRow> rows;  ///< in path order; a closed path repeats its first point at the end
  std::vector<BlockedPoint> blocked;
  std::vector<UnsafeWay> unsafe;
  double least_clearance = 0;  ///< smallest clearance over all poses evaluated, mm
  double bound = 0;            ///< lower bound of the clearance along all rows, mm
  std::size_t evaluations = 0;

  /// Whether every point has a row and bound ≥ clearance − tolerance.
  bool good() const { return blocked.empty() && unsafe.empty(); }
};

/// Computes poses from the path's axes (plan/contact_location.hpp) and lifts those that gouge along the axis
/// (plan/lift.hpp). Between rows the tip moves on a line and the axis on a great circle (geom/pose.hpp);
/// collide/swept_search.hpp checks each move. Where a move gouges, the offending pose is lifted and inserted as a row.
/// Orientations are never changed. A point that cannot be freed has no row but an entry in `blocked`. Throws
/// std::invalid_argument for a path without axes, or naming an invalid setting. Parallel over points, then over moves.
CutterLocations cutter_locations(const PencilPath& path, const collide::Assembly& assembly,
                                 const collide::Collider& collider, const LocationRule& rule,
                                 const Progress& progress = {});

/// The same for given poses with unit axes, taken as the points of an open path.
CutterLocations cutter_locations(const std::vector<Pose>& poses, const collide::Assembly& assembly,
                                 const collide::Collider& collider, const LocationRule& rule,
                                 const Progress& progress = {});

}  // namespace riffler::plan
