// The table of finishing patterns. A pattern is one file with one function, and one line in patterns.cpp.
#pragma once

#include <string>
#include <vector>

#include "plan/finish/cusp.hpp"
#include "plan/finish/surface.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::plan {

/// What a pattern works with. The rows' frame has z along the tool's axis and x along the option `angle`.
struct PatternScene {
  const FinishSurface& surface;
  const CutterProfile& profile;
  const Tool& tool;
  const FinishOptions& options;
  Box3 part;  ///< box of the part in the rows' frame, mm
};

/// One curve of tips to be cut, and the order in which it is to be cut: pieces with a smaller rank first.
struct CutPiece {
  double rank = 0;
  std::vector<Vec3> tips;
};

/// What a pattern has found.
struct PatternRows {
  std::vector<CutPiece> pieces;
  std::vector<BlockedPlace> blocked;
  std::size_t rows = 0, added = 0;
  double spacing = 0;  ///< mm, of rows on level faces
};

/// A pattern: its name, and the function that finds its rows.
struct Pattern {
  const char* name;
  PatternRows (*rows)(const PatternScene& scene, const Progress& progress);
};

/// The table.
const std::vector<Pattern>& patterns();

/// Rows in planes at an angle, with more of them where the part is steep or the cutter reaches another face.
PatternRows parallel_rows(const PatternScene& scene, const Progress& progress);

}  // namespace riffler::plan
