// Pens and poses that tests of the pen share.
#pragma once

#include "pen/arms/pens.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "stress/random.hpp"

namespace riffler::test {

/// The shipped pen, set up aslant and away from the origin.
inline pen::PenGeometry turned_pen() {
  pen::PenGeometry pen = pen::load_pen("riffler");
  const Vec3 x = glm::normalize(Vec3(1, 2, -2)), z = glm::normalize(glm::cross(x, Vec3(0.3, 1, 0)));
  pen.turn = Mat3(x, glm::cross(z, x), z);
  pen.origin = {40, -500, 120};
  return pen;
}

/// In the workspace, tilted up to 60° from the axis at home.
inline Pose random_pose(stress::Random& random, const pen::PenGeometry& geometry) {
  const pen::PenKinematics pen(geometry);
  const Vec3 home = pen.posture(pen.home_angles()).pose.axis, size = geometry.workspace.size();
  Vec3 axis;
  do axis = random.direction();
  while (glm::dot(axis, home) < 0.5);
  const Vec3 share(random.uniform(), random.uniform(), random.uniform());
  return {geometry.turn * (geometry.workspace.lower + share * size) + geometry.origin, axis};
}

}  // namespace riffler::test
