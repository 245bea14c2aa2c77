// A vise, a clamp: a dexel volume of its own pitch, with the force of its material on a tool.
#pragma once

#include <cstddef>

#include "collide/deadline.hpp"
#include "collide/material_boxes.hpp"
#include "collide/surface.hpp"
#include "collide/tool_frame.hpp"
#include "mesh/closest.hpp"
#include "riffler/collide/assembly.hpp"
#include "riffler/collide/contact.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::collide {

/// Its shape is that of its mesh (marching/to_mesh.hpp says what that keeps), and its inside counts.
class Fixture {
 public:
  /// `mesh` is that of `volume`, not empty. `spacing`: of the pieces that push, mm; none is narrower than the pitch.
  Fixture(const Volume& volume, const Mesh& mesh, double spacing);

  const Surface& surface() const { return surface_; }
  bool holds(const Vec3& p) const;
  /// Whether any of it can be nearer to the tool than `distance`.
  bool near(const Assembly& assembly, const ToolFrame& frame, double distance) const;

  /// Adds the force of what of its material is in the tool: k times the volume, each piece of it towards the middle of
  /// what it is in: cutter, shank or holder. That is (4.9)–(4.11) with dexels cut into short pieces, so that the
  /// direction of the rays does not matter. Material is in boxes (collide/material_boxes.hpp), of which the tool cuts
  /// off what lies behind its tangent plane: the force is continuous, and so is its derivative but for faces that come
  /// on flat. Torque about the tip. After the deadline nodes of any size stand for what is in them.
  void add_force(const Assembly& assembly, const ToolFrame& frame, double stiffness, Deadline& deadline,
                 Contact& contact, Counts& counts) const;

 private:
  MaterialBoxes boxes_;
  Surface surface_;
  mesh::Closest sides_;
  BoundingSphere whole_;  // round all of it
};

}  // namespace riffler::collide
