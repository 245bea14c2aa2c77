// A box of twelve triangles, outward.
#pragma once

#include "riffler/mesh/mesh.hpp"

namespace riffler::test {

inline Mesh box_mesh(const Vec3& lower, const Vec3& upper) {
  Mesh m;
  for (int k = 0; k < 8; ++k)
    m.vertices.push_back({k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z});
  for (const Vec3i& t :
       {Vec3i(0, 2, 1), Vec3i(1, 2, 3), Vec3i(4, 5, 6), Vec3i(5, 7, 6), Vec3i(0, 1, 4), Vec3i(1, 5, 4), Vec3i(2, 6, 3),
        Vec3i(3, 6, 7), Vec3i(0, 4, 2), Vec3i(2, 4, 6), Vec3i(1, 3, 5), Vec3i(3, 7, 5)})
    m.triangles.push_back(t);
  return m;
}

}  // namespace riffler::test
