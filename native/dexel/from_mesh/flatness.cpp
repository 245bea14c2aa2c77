#include "dexel/from_mesh/flatness.hpp"

namespace riffler::dexel {

namespace {

/// Among the vertices of every `stride`-th triangle, the one with the greatest `measure`.
template <class Measure>
Vec3 farthest(const Mesh& mesh, std::size_t stride, const Measure& measure) {
  double most = -1;
  Vec3 best(0);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += stride)
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[mesh.triangles[t][k]];
      if (const double m = measure(p); m > most) most = m, best = p;
    }
  return best;
}

/// Tests every `stride`-th triangle.
bool are_flat(const Mesh& mesh, std::size_t stride, double tolerance) {
  // Find a long segment, then the vertex farthest from its line, then the distances of all vertices from that plane.
  const Vec3 a = mesh.vertices[mesh.triangles[0].x];
  const Vec3 b = farthest(mesh, stride, [&](const Vec3& p) { return glm::length(p - a); });
  if (glm::length(b - a) <= tolerance) return true;
  const Vec3 along = glm::normalize(b - a);
  const auto off_line = [&](const Vec3& p) { return glm::length(glm::cross(p - a, along)); };
  const Vec3 c = farthest(mesh, stride, off_line);
  if (off_line(c) <= tolerance) return true;
  const Vec3 normal = glm::normalize(glm::cross(along, c - a));
  const auto off_plane = [&](const Vec3& p) { return std::abs(glm::dot(p - a, normal)); };
  return off_plane(farthest(mesh, stride, off_plane)) <= tolerance;
}

}  // namespace

bool is_flat(const Mesh& mesh, double tolerance) {
  if (mesh.empty()) return true;
  // Most meshes are far from flat, and a few hundred triangles show it. A plane through other triangles may give
  // distances a few times smaller, hence the factor 16.
  const std::size_t stride = mesh.triangles.size() / 256 + 1;
  return are_flat(mesh, stride, 16 * tolerance) && are_flat(mesh, 1, tolerance);
}

}  // namespace riffler::dexel
