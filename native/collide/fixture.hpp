// A vise, a clamp: a dexel volume of its own pitch, with the force of its dexels on a tool.
#pragma once

#include <cstddef>

#include "collide/assembly.hpp"
#include "collide/contact.hpp"
#include "collide/deadline.hpp"
#include "collide/surface.hpp"
#include "collide/tool_frame.hpp"
#include "dexel/volume.hpp"
#include "mesh/closest.hpp"

namespace riffler {

/// Its shape is that of its mesh (marching/to_mesh.hpp says what that keeps), and its inside counts.
class Fixture {
 public:
  /// `mesh` is that of `volume`, not empty.
  Fixture(const Volume& volume, const Mesh& mesh);

  const Surface& surface() const { return surface_; }
  bool holds(const Vec3& p) const;
  /// Whether any of it can be nearer to the tool than `distance`.
  bool near(const Assembly& assembly, const ToolFrame& frame, double distance) const;

  /// Adds |f| = k Δz A of every dexel, Δz its length in the tool and A the square of the pitch, from the middle of that
  /// length towards the middle of what it is in: cutter, shank or holder (4.9)–(4.11). Torque about the tip.
  /// Rays of the grid that defines the volume; stretches shorter than a hundredth of the pitch may be missed. After the
  /// deadline every fourth row stands for four.
  void add_force(const Assembly& assembly, const ToolFrame& frame, double stiffness, Deadline& deadline,
                 Contact& contact, Counts& counts) const;

 private:
  /// Of one dexel whose part in the tool is `length` long, about `middle` in the tool's frame.
  void add_dexel(const Assembly& assembly, const ToolFrame& frame, const Vec3& middle, double length, double stiffness,
                 Contact& contact) const;

  Volume volume_;
  Surface surface_;
  Closest sides_;
  Sphere whole_;  // round all of it
};

}  // namespace riffler
