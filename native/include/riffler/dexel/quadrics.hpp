// Spheres and cylinders as volumes, made of exact rays: no facets.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// mm.
struct Sphere {
  Vec3 centre;
  double radius;
};

/// `centre` is the middle of the axis, mm; `axis` has any length but 0 and either sense.
struct Cylinder {
  Vec3 centre;
  double radius, height;
  Vec3 axis{0, 0, 1};
};

/// The box that the solid touches on all sides. Throws std::invalid_argument, naming the argument, for numbers that are
/// not finite, sizes that are not positive, an axis of length 0, and a solid so small that its box has no size.
Box3 bounds(const Sphere& solid);
Box3 bounds(const Cylinder& solid);

/// The solid, clipped by the frame's box. Each end of a span is where its ray crosses the quadric or a cap, to the
/// rounding of doubles, and carries the normal of the surface there, or of the box where that clips. Throws
/// std::invalid_argument as bounds() and Volume() do, and where the box holds all of the solid, but the rays of a
/// direction all miss it.
Volume sphere(const Sphere& solid, const Frame& frame, const Progress& progress = {});
Volume cylinder(const Cylinder& solid, const Frame& frame, const Progress& progress = {});

}  // namespace riffler::dexel
