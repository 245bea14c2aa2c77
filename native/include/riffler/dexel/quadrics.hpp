// Makes spheres and cylinders as volumes with exact rays, without facets.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// Lengths in mm.
struct Sphere {
  Vec3 centre;
  double radius;
};

/// `centre` is the midpoint of the axis, lengths in mm. `axis` may have any length but 0; its sign has no effect.
struct Cylinder {
  Vec3 centre;
  double radius, height;
  Vec3 axis{0, 0, 1};
};

/// The smallest box around the solid. Throws std::invalid_argument, naming the argument, for numbers that are not
/// finite, sizes that are not positive, an axis of length 0, or a solid so small that its box has no extent.
Box3 bounds(const Sphere& solid);
Box3 bounds(const Cylinder& solid);

/// The solid, clipped by the frame's box. Each span end is where its ray crosses the quadric or a cap, to double
/// rounding, and carries the surface normal there, or the box's normal where the box clips. Throws
/// std::invalid_argument as bounds() and Volume() do, and if the box contains the whole solid but all rays of a
/// direction miss it.
Volume sphere(const Sphere& solid, const Frame& frame, const Progress& progress = {});
Volume cylinder(const Cylinder& solid, const Frame& frame, const Progress& progress = {});

}  // namespace riffler::dexel
