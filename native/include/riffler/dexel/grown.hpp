// A volume in a larger box: rays stay where they stand, and more are put beside them.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// The frame with each side moved outward by whole pitches until it lies at or beyond that of `wanted`, to 1e-6 of a
/// pitch; a side that already does stays. The upper sides may move one pitch more, where the box's size is no whole
/// number of pitches, so that all rays keep a place. Throws std::invalid_argument where `wanted` is not finite or has a
/// lower corner above the upper one.
Frame grown(const Frame& frame, const Box3& wanted);

/// The volume in grown(frame, wanted): the same spans and normals, bit for bit, and no material in what is new. Throws
/// as grown() and, before anything is allocated, as Volume() do.
Volume grown(const Volume& volume, const Box3& wanted, const Progress& progress = {});

}  // namespace riffler::dexel
