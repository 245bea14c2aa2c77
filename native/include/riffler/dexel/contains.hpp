// Points in a volume.
#pragma once

#include <span>
#include <vector>

#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// Of each point (mm), whether it lies in the material, by the nearest ray of each direction: of three directions, two
/// decide. Points outside of the volume's box, and points that are not finite, lie outside of the material.
std::vector<char> contains(const Volume& volume, std::span<const Vec3> points);

}  // namespace riffler::dexel
