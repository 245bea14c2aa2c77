// Meshes whose properties are known.
#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Closed box with its edges on the axes' directions, 12 triangles.
inline Mesh box_mesh(const Vec3& lower, const Vec3& upper) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Every triangle into four, `times` times.
inline Mesh subdivided(Mesh mesh, int times) {
  for (; times > 0; --times) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return at->second;
    };
    Triangles triangles;
    for (const Vec3i& t : mesh.triangles) {
      const int a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
      triangles.insert(triangles.end(), {Vec3i(t.x, a, c), Vec3i(t.y, b, a), Vec3i(t.z, c, b), Vec3i(a, b, c)});
    }
    mesh.triangles = std::move(triangles);
  }
  return mesh;
}

/// An octahedron, subdivided, its vertices moved onto the sphere.
inline Mesh sphere_mesh(double radius, int times) {
  Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  mesh = subdivided(std::move(mesh), times);
  for (Vec3& v : mesh.vertices) v = radius * glm::normalize(v);
  return mesh;
}

inline Mesh torus_mesh(double major, double minor, int around, int across) {
  constexpr double kTurn = 6.283185307179586;
  Mesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = kTurn * i / around, v = kTurn * j / across, r = major + minor * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
      const int i2 = (i + 1) % around, j2 = (j + 1) % across;
      const int a = i * across + j, b = i2 * across + j, c = i2 * across + j2, d = i * across + j2;
      mesh.triangles.emplace_back(a, b, c), mesh.triangles.emplace_back(a, c, d);
    }
  return mesh;
}

/// An open sheet of n × n squares with heights.
template <class Height>
Mesh sheet_mesh(int n, double size, const Height& height) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = size * i / n, y = size * j / n;
      mesh.vertices.emplace_back(x, y, height(x, y));
      if (i == n || j == n) continue;
      const int a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.emplace_back(a, b, b + 1), mesh.triangles.emplace_back(a, b + 1, a + 1);
    }
  return mesh;
}

/// Both side by side, nothing welded.
inline Mesh both(Mesh a, const Mesh& b) {
  const int n = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Vec3i& t : b.triangles) a.triangles.push_back(t + n);
  return a;
}

inline Mesh moved(Mesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

}  // namespace riffler::mesh
