// Passes parallel to a valley, on both of its sides.
#pragma once

#include <vector>

#include "plan/valley.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/plan/path.hpp"

namespace riffler::plan {

/// Distance (mm) between passes of a ball on a plane that leaves scallops of `height` (mm).
double stepover_of_scallop(double radius, double height);

/// `count` passes at multiples of `stepover` (mm) on each side of a traced valley. Their balls touch the part at one
/// point, stored as both contacts. A pass ends where the ball does not fit, and a new one starts behind.
std::vector<PencilPath> passes_beside(const RollingBall& ball, const Valley& valley, int count, double stepover,
                                      const Progress& progress = {});

}  // namespace riffler::plan
