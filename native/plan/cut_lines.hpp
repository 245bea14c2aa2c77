// cut_along with a prepared collider.
#pragma once

#include "riffler/collide/collider.hpp"
#include "riffler/plan/cut_along.hpp"

namespace riffler::plan {

/// `part`: part and fixtures of the scene, or the part alone if `options.fixture_distance` has a value.
CutAlongResult cut_lines(const SetupScene& scene, const Tool& tool, const std::vector<CutLine>& lines,
                         const CutAlongOptions& options, const collide::Collider& part, const Progress& progress);

}  // namespace riffler::plan
