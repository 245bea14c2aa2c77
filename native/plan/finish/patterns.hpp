// The table of finishing patterns. A pattern is one file with one function, and one line in patterns.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan/finish/cusp.hpp"
#include "plan/finish/surface.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::plan {

/// Share of the cusp that is allowed at samples, because ridges between two samples are a little higher.
inline constexpr double kCuspShare = 0.9;

/// The data of a pattern. The rows' frame has z along the tool's axis and x along the option `angle`.
struct PatternScene {
  const FinishSurface& surface;
  const CutterProfile& profile;
  const Tool& tool;
  const FinishOptions& options;
  Box3 part;                   ///< box of the part in the rows' frame, mm
  std::optional<Vec2> centre;  ///< of spiral and radial patterns, in the rows' frame; none: the middle of `part`
};

/// A curve of tips to be cut. Pieces with a smaller rank are cut first.
struct CutPiece {
  double rank = 0;
  std::vector<Vec3> tips;
  bool closed = false;  ///< whether the piece ends where it begins; it may then begin anywhere
};

/// The result of a pattern.
struct PatternRows {
  std::vector<CutPiece> pieces;
  std::vector<BlockedPlace> blocked;
  std::size_t rows = 0, added = 0;
  double spacing = 0;       ///< distance of rows on level faces, mm
  bool descending = false;  ///< pieces keep their direction and are cut from the top downwards; links are straight
  double least_slope = 0;   ///< rad: flatter faces are left to other patterns
  std::string reason;       ///< why there are no pieces, if the pattern itself is the cause
};

/// A pattern: its name, and the function that finds its rows.
struct Pattern {
  const char* name;
  PatternRows (*rows)(const PatternScene& scene, const Progress& progress);
};

/// Adds the places `more` to `all`; places with the same reason count as one.
void add_blocked(const std::vector<BlockedPlace>& more, std::vector<BlockedPlace>& all);

/// The table of patterns.
const std::vector<Pattern>& patterns();

/// Rows in planes at an angle, with further rows where the part is steep or the cutter touches another face.
PatternRows parallel_rows(const PatternScene& scene, const Progress& progress);
/// Turns from a centre outwards, with further turns as above.
PatternRows spiral_rows(const PatternScene& scene, const Progress& progress);
/// Rays from a centre, with further rays as above: more of them farther out.
PatternRows radial_rows(const PatternScene& scene, const Progress& progress);
/// Curves at equal distances from the border of the selected faces, measured on the drop surface.
PatternRows scallop_rows(const PatternScene& scene, const Progress& progress);
/// Level curves of the drop surface, for steep faces.
PatternRows waterline_rows(const PatternScene& scene, const Progress& progress);

}  // namespace riffler::plan
