// Boxes and what is made of them: turned, joined, taken apart.
#pragma once

#include <utility>

#include "riffler/mesh/mesh.hpp"

namespace riffler::shapes {

inline Mesh box(const Vec3& lower, const Vec3& upper) {
  Mesh m;
  for (int k = 0; k < 8; ++k)
    m.vertices.emplace_back(k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z);
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

inline Mesh flipped(Mesh m) {
  for (Vec3i& t : m.triangles) std::swap(t.y, t.z);
  return m;
}

inline Mesh joined(Mesh a, const Mesh& b) {
  const int n = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Vec3i& t : b.triangles) a.triangles.push_back(t + Vec3i(n));
  return a;
}

/// Every triangle with vertices of its own.
inline Mesh unwelded(const Mesh& m) {
  Mesh out;
  for (const Vec3i& t : m.triangles) {
    const int n = static_cast<int>(out.vertices.size());
    for (int k = 0; k < 3; ++k) out.vertices.push_back(m.vertices[t[k]]);
    out.triangles.emplace_back(n, n + 1, n + 2);
  }
  return out;
}

}  // namespace riffler::shapes
