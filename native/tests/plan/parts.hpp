// Parts with valleys whose two-contact curves are known.
#pragma once

#include <cmath>
#include <vector>

#include "geom/math.hpp"
#include "mesh/shapes.hpp"

namespace riffler::plan {

/// A rotation by `angle` (rad) about `axis`, and then a shift.
struct PartPlacement {
  Mat3 turn{1};
  Vec3 shift{0};

  static PartPlacement about(const Vec3& axis, double angle, const Vec3& shift) {
    const Vec3 a = glm::normalize(axis);
    const double c = std::cos(angle), s = std::sin(angle);
    Mat3 m(0);
    for (int k = 0; k < 3; ++k) {
      Vec3 e(0);
      e[k] = 1;
      m[k] = c * e + s * glm::cross(a, e) + (1 - c) * glm::dot(a, e) * a;
    }
    return {m, shift};
  }
  Vec3 operator()(const Vec3& p) const { return turn * p + shift; }
  Vec3 back(const Vec3& p) const { return glm::transpose(turn) * (p - shift); }
  Mesh operator()(Mesh mesh) const {
    for (Vec3& v : mesh.vertices) v = (*this)(v);
    return mesh;
  }
};

/// A closed prism along x from 0 to `length` below the outline (y, z), which runs towards -y and whose floor is at z =
/// `bottom`. The outline's y must decrease.
inline Mesh trench(const std::vector<Vec2>& outline, double bottom, double length) {
  Mesh mesh;
  const int n = static_cast<int>(outline.size());
  for (int end = 0; end < 2; ++end)
    for (int low = 0; low < 2; ++low)
      for (const Vec2& p : outline) mesh.vertices.emplace_back(end * length, p.x, low ? bottom : p.y);
  const auto at = [n](int end, int low, int i) { return (2 * end + low) * n + i; };
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.emplace_back(a, b, c), mesh.triangles.emplace_back(a, c, d);
  };
  for (int i = 0; i + 1 < n; ++i) {
    quad(at(0, 0, i), at(0, 0, i + 1), at(1, 0, i + 1), at(1, 0, i));
    quad(at(0, 1, i), at(1, 1, i), at(1, 1, i + 1), at(0, 1, i + 1));
    quad(at(0, 0, i), at(0, 1, i), at(0, 1, i + 1), at(0, 0, i + 1));
    quad(at(1, 0, i), at(1, 0, i + 1), at(1, 1, i + 1), at(1, 1, i));
  }
  quad(at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0));
  quad(at(0, 0, n - 1), at(0, 1, n - 1), at(1, 1, n - 1), at(1, 0, n - 1));
  return mesh;
}

/// A groove between two planes at the angle `theta`, 8 mm deep, bottom at (y, z) = (0, -8), rounded by `blend` in
/// `facets`.
inline Mesh groove(double theta, double length = 40, double blend = 0, int facets = 0) {
  const double half = 8 * std::tan(theta / 2), wide = half + 8;
  std::vector<Vec2> outline{{wide, 0}, {half, 0}};
  const double turn = (kPi - theta) / 2, z = -8 + blend / std::sin(theta / 2);
  for (int i = 0; i <= facets; ++i) {
    const double a = facets > 0 ? turn - 2 * turn * i / facets : 0;
    outline.emplace_back(blend * std::sin(a), facets > 0 ? z - blend * std::cos(a) : -8);
  }
  outline.insert(outline.end(), {{-half, 0}, {-wide, 0}});
  return trench(outline, -20, length);
}

/// A closed cylinder about z.
inline Mesh cylinder_mesh(double radius, double from, double to, int around) {
  Mesh mesh;
  for (int i = 0; i < around; ++i)
    for (const double z : {from, to})
      mesh.vertices.emplace_back(radius * std::cos(2 * kPi * i / around), radius * std::sin(2 * kPi * i / around), z);
  mesh.vertices.emplace_back(0, 0, from), mesh.vertices.emplace_back(0, 0, to);
  for (int i = 0; i < around; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % around), n = 2 * around;
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}, {b, a, n}, {a + 1, b + 1, n + 1}});
  }
  return mesh;
}

inline Mesh inside_out(Mesh mesh) {
  for (Vec3i& t : mesh.triangles) std::swap(t.y, t.z);
  return mesh;
}

/// Every triangle with vertices of its own, some of them a little off.
inline Mesh cracked(const Mesh& mesh, double by) {
  Mesh out;
  for (const Vec3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      out.vertices.push_back(mesh.vertices[t[k]] +
                             by * Vec3(std::sin(17.0 * static_cast<double>(out.vertices.size())), 0, 0));
      if (k == 2) {
        const int n = static_cast<int>(out.vertices.size());
        out.triangles.emplace_back(n - 3, n - 2, n - 1);
      }
    }
  return out;
}

}  // namespace riffler::plan
