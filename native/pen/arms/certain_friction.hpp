// Friction of an identified pen that is certainly there.
#pragma once

#include <cstddef>

#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

/// Friction of one motor that is certainly there: the lower ends of the 95 % intervals of an identified pen; nothing
/// for a pen that was not identified.
struct CertainFriction {
  double coulomb = 0, viscous = 0;  // N·mm, N·mm·s/rad at the motor
};
CertainFriction certain_friction(const PenGeometry& pen, std::size_t channel) noexcept;
/// Largest share of the described friction, dry and viscous, that is within certain_friction.
double certain_share(const PenGeometry& pen, std::size_t channel) noexcept;

}  // namespace riffler::pen
