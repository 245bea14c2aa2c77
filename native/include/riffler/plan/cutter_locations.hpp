// From an oriented path to cutter locations that gouge nothing, at the points and between them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/plan/path.hpp"

namespace riffler::plan {

struct LocationRule {
  double clearance = 0;  ///< wanted over part and fixtures, mm
  /// How much less than `clearance` it may be, mm. Finishing cuts touch the part everywhere: less than this deep counts
  /// as touching. Points are lifted to within half of it, so that the way between them has the other half.
  double tolerance = 0.01;
  double max_lift = 100;         ///< mm along the axis
  int max_inserted = 200;        ///< points, between two of the path
  int max_evaluations = 100000;  ///< between two rows
};

/// One row of the result.
struct LocationRow {
  Pose pose;
  std::ptrdiff_t point = -1;  ///< of the path; −1: inserted
  double lift = 0;            ///< mm along the axis from where the path wants the tool, or the motion had it
  double before = 0;          ///< clearance there, mm
  double clearance = 0;       ///< clearance now, mm
  collide::Touch touch = collide::Touch::Cutter;  ///< what it was lifted off, or is nearest
};

/// A point of the path that has no row.
struct BlockedPoint {
  std::size_t point;
  std::string reason;
};

/// A way between two rows that could not be made or shown to be free.
struct UnsafeWay {
  std::size_t row;   ///< from this row to the next
  double clearance;  ///< the least seen, mm
  double bound;      ///< it is nowhere less than this, mm
  std::string reason;
};

struct CutterLocations {
  std::vector<LocationRow> rows;  ///< in the order of the path; of a loop, the first point once more at the end
  std::vector<BlockedPoint> blocked;
  std::vector<UnsafeWay> unsafe;
  double least_clearance = 0;  ///< over all poses that were looked at, mm
  double bound = 0;            ///< nowhere along the rows is the clearance less, mm
  std::size_t evaluations = 0;

  /// Every point has a row, and bound ≥ clearance − tolerance.
  bool good() const { return blocked.empty() && unsafe.empty(); }
};

/// Poses by plan/contact_location.hpp from the path's axes, lifted by plan/lift.hpp where they gouge. Between rows the
/// tip moves on a line and the axis on the great circle (geom/pose.hpp), checked by collide/swept_search.hpp; where
/// that gouges, the pose that does is lifted and becomes a row between them. Orientations are kept as they are. A point
/// that cannot be freed has no row, but an entry in `blocked`; nothing is made to fit silently. std::invalid_argument
/// for a path without axes, or naming a setting; parallel over points, then over ways between them.
CutterLocations cutter_locations(const PencilPath& path, const collide::Assembly& assembly,
                                 const collide::Collider& collider, const LocationRule& rule,
                                 const Progress& progress = {});

/// The same from `poses` with unit axes, which stand for the points of an open path.
CutterLocations cutter_locations(const std::vector<Pose>& poses, const collide::Assembly& assembly,
                                 const collide::Collider& collider, const LocationRule& rule,
                                 const Progress& progress = {});

}  // namespace riffler::plan
