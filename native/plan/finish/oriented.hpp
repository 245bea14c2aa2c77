// Finishing rows with axes that change along them.
#pragma once

#include <vector>

#include "plan/finish/patterns.hpp"

namespace riffler::plan {

/// Cuts pieces of rows of the ball at the tool's tip along the axes of the option `axes`. `frame`: of the rows;
/// `links`: to each next piece, at feed, or none. Adds to `out`..
void cut_oriented(const SetupScene& scene, const Tool& tool, const FinishOptions& options, const Mat3& frame,
                  const std::vector<CutPiece>& pieces, const std::vector<std::vector<Vec3>>& links,
                  const Progress& progress, FinishResult& out);

}  // namespace riffler::plan
