#include "dexel/flatness.hpp"

namespace riffler {

namespace {

/// The vertex of a triangle at which `measure` is greatest.
template <class Measure>
Vec3 farthest(const Mesh& mesh, const Measure& measure) {
  double most = -1;
  Vec3 best(0);
  for (const Vec3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[t[k]];
      if (const double m = measure(p); m > most) most = m, best = p;
    }
  return best;
}

}  // namespace

bool is_flat(const Mesh& mesh, double tolerance) {
  if (mesh.empty()) return true;
  // A long segment, the vertex farthest from its line, then the distance of all from that plane.
  const Vec3 a = mesh.vertices[mesh.triangles[0].x];
  const Vec3 b = farthest(mesh, [&](const Vec3& p) { return glm::length(p - a); });
  if (glm::length(b - a) <= tolerance) return true;
  const Vec3 along = glm::normalize(b - a);
  const auto off_line = [&](const Vec3& p) { return glm::length(glm::cross(p - a, along)); };
  const Vec3 c = farthest(mesh, off_line);
  if (off_line(c) <= tolerance) return true;
  const Vec3 normal = glm::normalize(glm::cross(along, c - a));
  const auto off_plane = [&](const Vec3& p) { return std::abs(glm::dot(p - a, normal)); };
  return off_plane(farthest(mesh, off_plane)) <= tolerance;
}

}  // namespace riffler
