// Enlarges a volume's box: existing rays stay in place, new rays are added around them.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// Moves each side of the frame outward by whole pitches until it reaches that of `wanted`, to 1e-6 of a pitch. A side
/// that already does is unchanged. If the box size is not a multiple of the pitch, an upper side may move one pitch
/// more, so that every ray keeps its place. Throws std::invalid_argument if `wanted` is not finite or its lower corner
/// is above its upper one.
Frame grown(const Frame& frame, const Box3& wanted);

/// The volume in the frame grown(frame, wanted): the same spans and normals, bit for bit, and no material in the new
/// region. Throws as the overload above does, and as Volume() does before anything is allocated.
Volume grown(const Volume& volume, const Box3& wanted, const Progress& progress = {});

}  // namespace riffler::dexel
