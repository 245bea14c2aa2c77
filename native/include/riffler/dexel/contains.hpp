// Point-in-volume test.
#pragma once

#include <span>
#include <vector>

#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// For each point (mm): whether it lies in the material, by the nearest ray of each direction. With three directions,
/// two of them decide. Points outside the volume's box and points that are not finite count as outside.
std::vector<char> contains(const Volume& volume, std::span<const Vec3> points);

}  // namespace riffler::dexel
