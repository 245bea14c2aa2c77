// A fixture (vise, clamp): a dexel volume with its own pitch, and the force of its material on a tool.
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

/// A solid fixture with the shape of its mesh (marching/to_mesh.hpp states what the mesh preserves).
class Fixture {
 public:
  /// `mesh`: the mesh of `volume`, not empty. `spacing`: size of the boxes that push, mm; no box is smaller than the
  /// pitch.
  Fixture(const Volume& volume, const Mesh& mesh, double spacing);

  const Surface& surface() const { return surface_; }
  bool holds(const Vec3& p) const;
  /// Whether any of it may be nearer to the tool than `distance` (mm).
  bool near(const Assembly& assembly, const ToolFrame& frame, double distance) const;

  /// Adds the force of the material inside the tool: k times its volume. Each box pushes against the normal of the
  /// tool's surface nearest to it, or, with `to_centre`, towards the centre of the part of the tool that contains it
  /// (cutter, shank or holder). The latter is (4.9)–(4.11) with dexels cut into short boxes, so that the direction of
  /// the rays does not matter. The tool takes the part of each box (collide/material_boxes.hpp) behind its tangent
  /// plane: the force is continuous, and so is its derivative except for faces that approach flat. Torque is about the
  /// tip. After the deadline, nodes of any size represent their contents.
  void add_force(const Assembly& assembly, const ToolFrame& frame, double stiffness, bool to_centre, Deadline& deadline,
                 Contact& contact, Counts& counts) const;

 private:
  MaterialBoxes boxes_;
  Surface surface_;
  mesh::Closest sides_;
  BoundingSphere whole_;  // bounding sphere
};

}  // namespace riffler::collide
