// The table of finishing patterns. A pattern is one file with one function, and one line in patterns.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan/finish/cusp.hpp"
#include "plan/finish/surface.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::plan {

/// The share of the cusp that rows leave where it is measured: what lies between two samples is a little higher.
inline constexpr double kCuspShare = 0.9;

/// What a pattern works with. The rows' frame has z along the tool's axis and x along the option `angle`.
struct PatternScene {
  const FinishSurface& surface;
  const CutterProfile& profile;
  const Tool& tool;
  const FinishOptions& options;
  Box3 part;                   ///< box of the part in the rows' frame, mm
  std::optional<Vec2> centre;  ///< of patterns about one, in the rows' frame
};

/// One curve of tips to be cut, and the order in which it is to be cut: pieces with a smaller rank first.
struct CutPiece {
  double rank = 0;
  std::vector<Vec3> tips;
  bool closed = false;  ///< ends where it begins, and may begin anywhere
};

/// What a pattern has found.
struct PatternRows {
  std::vector<CutPiece> pieces;
  std::vector<BlockedPlace> blocked;
  std::size_t rows = 0, added = 0;
  double spacing = 0;       ///< mm, of rows on level faces
  bool descending = false;  ///< pieces keep their direction and are cut from the top downwards; links are straight
  std::string reason;       ///< why there are no pieces, if it is the pattern's own
};

/// A pattern: its name, and the function that finds its rows.
struct Pattern {
  const char* name;
  PatternRows (*rows)(const PatternScene& scene, const Progress& progress);
};

/// Adds places to others; those with the same reason count as one.
void add_blocked(const std::vector<BlockedPlace>& more, std::vector<BlockedPlace>& all);

/// The table.
const std::vector<Pattern>& patterns();

/// Rows in planes at an angle, with more of them where the part is steep or the cutter reaches another face.
PatternRows parallel_rows(const PatternScene& scene, const Progress& progress);
/// Turns from a centre outwards, with more of them as above.
PatternRows spiral_rows(const PatternScene& scene, const Progress& progress);
/// Rays from a centre, with more of them as above: the farther out the more.
PatternRows radial_rows(const PatternScene& scene, const Progress& progress);
/// Curves at equal distances from the border of what is meant, measured on the drop surface.
PatternRows scallop_rows(const PatternScene& scene, const Progress& progress);
/// Levels of the drop surface, for steep faces.
PatternRows waterline_rows(const PatternScene& scene, const Progress& progress);

}  // namespace riffler::plan
