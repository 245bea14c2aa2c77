// Pens like a described one whose true values differ from the description, as a built pen's do.
#pragma once

#include <cstdint>

#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

/// `described` with other torque constants (± 15 %), dry and viscous friction (0.6 to 1.5 times), moments of weight
/// (± 30 %), inertias of the joints, mass and inertia of the grip (± 15 %), each drawn uniformly. Lengths, gears and
/// limits stay. The same for the same seed on every platform.
PenGeometry random_pen(const PenGeometry& described, std::uint64_t seed);

}  // namespace riffler::pen
