// Normals of what a hand tool sweeps, at ends of rays.
#pragma once

#include "sweep/steps.hpp"
#include "sweep/swept_normals.hpp"

namespace riffler::sweep {

/// Computes the normals out of the material, which face the tool, of ends that arose in a step of a hand tool: that of
/// the face which bounds, or, where two faces bound during the motion, the one between theirs along which the tool
/// slides. The ends may be inaccurate by a tolerance. Fills `ends.map`.
void hull_normals(const HullPart& part, Axis grid, SweptEnds& ends);

}  // namespace riffler::sweep
