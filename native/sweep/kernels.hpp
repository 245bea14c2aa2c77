// The loops over rays, compiled for several instruction sets; the best that the machine has is chosen at run time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sweep/ray_window.hpp"
#include "sweep/straight_part.hpp"
#include "sweep/turning_part.hpp"

namespace riffler::sweep {

/// Cuts what a straight part sweeps out of the rays of the window.
void cut_straight(const StraightBody& body, RayWindow& window);
/// The same for a turning part.
void cut_turning(const TurningBody& body, RayWindow& window);

/// Names of the instruction sets that this machine can use, best first.
std::vector<std::string> instruction_sets();
/// Uses only this one from now on; "" for the best again. Throws std::invalid_argument for one that is not in the list.
void use_instruction_set(const std::string& name);

}  // namespace riffler::sweep
