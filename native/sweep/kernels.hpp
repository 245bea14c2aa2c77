// The loops over rays, compiled for several instruction sets; the best one that the machine supports is used at run
// time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sweep/hull_part.hpp"
#include "sweep/ray_window.hpp"
#include "sweep/straight_part.hpp"
#include "sweep/swept_normals.hpp"
#include "sweep/turning_part.hpp"

namespace riffler::sweep {

/// Removes the swept volume of a straight part from the rays of the window.
void cut_straight(const StraightBody& body, RayWindow& window);
/// Same for a turning part.
void cut_turning(const TurningBody& body, RayWindow& window);
/// Same for a part of a hand tool's move.
void cut_hull(const HullBody& body, RayWindow& window);

/// Computes the normals out of the material, which face the tool, of complete ends (swept_normals.hpp). The ends may be
/// inaccurate by a tolerance.
void compute_normals(const SweptSurface& surface, SweptEnds& ends);

/// Names of the instruction sets that this machine supports, best first.
std::vector<std::string> instruction_sets();
/// Restricts the kernels to one instruction set; "" selects the best again. Throws std::invalid_argument for a name
/// that is not in the list.
void use_instruction_set(const std::string& name);

}  // namespace riffler::sweep
