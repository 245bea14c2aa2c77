// Oriented boxes around the triangles below each node of a sphere tree: tighter than spheres where a surface is flat.
#pragma once

#include <vector>

#include "collide/sphere_tree.hpp"
#include "collide/triangle_search.hpp"

namespace riffler::collide {

/// The boxes of the eight children of one node, with the same axes for all.
struct alignas(64) OrientedBoxes {
  double x[base::kLanes]{}, y[base::kLanes]{}, z[base::kLanes]{};  ///< centres
  double half[3][base::kLanes]{};                                  ///< half sides along the axes, mm
  Vec3 axis[3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

/// One entry for each node above the leaves; `corners`: by place in the tree. `chords`: how far the
/// surface may be from each triangle, mm; empty: 0. The axes are the coordinate axes, or the
/// principal axes of the corners where those make the boxes smaller. The same for any number of threads.
std::vector<OrientedBoxes> oriented_boxes(const SphereTree& tree, const std::vector<Corners>& corners,
                                          const std::vector<double>& chords);

}  // namespace riffler::collide
