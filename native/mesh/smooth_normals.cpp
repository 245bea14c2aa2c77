#include "mesh/smooth_normals.hpp"

#include <algorithm>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

constexpr std::size_t kNormalGrain = 1 << 14;

/// The triangles at each vertex, in ascending order, as one list.
struct CornerFans {
  std::vector<std::size_t> begin;
  std::vector<int> corner;  // 3 t + k

  explicit CornerFans(const Mesh& mesh) : begin(mesh.vertices.size() + 1), corner(3 * mesh.triangles.size()) {
    for (const Vec3i& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) ++begin[t[k] + 1];
    for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) corner[next[mesh.triangles[t][k]]++] = static_cast<int>(3 * t + k);
  }
};

double angle_at(const std::array<Vec3, 3>& p, int k) {
  const Vec3 a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
  return geom::angle_between(a, b);
}

}  // namespace

SmoothNormals::SmoothNormals(const Mesh& mesh, double crease) : corners_(mesh.triangles.size()) {
  const CornerFans fans(mesh);
  std::vector<Vec3> faces(corners_.size());
  base::parallel_for(corners_.size(), kNormalGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      auto& p = corners_[t].points;
      for (int k = 0; k < 3; ++k) p[k] = mesh.vertices[mesh.triangles[t][k]];
      faces[t] = geom::unit_or_zero(glm::cross(p[1] - p[0], p[2] - p[0]));
    }
  });
  const double least = base::cos(crease);
  base::parallel_for(corners_.size(), kNormalGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (int k = 0; k < 3; ++k) {
        const bool flat = faces[t] == Vec3(0);  // without a normal of its own, it takes part in the whole fan
        Vec3 sum{0};
        const int vertex = mesh.triangles[t][k];
        for (std::size_t i = fans.begin[vertex]; i < fans.begin[vertex + 1]; ++i) {
          const int other = fans.corner[i] / 3;
          if (flat || glm::dot(faces[t], faces[other]) >= least)
            sum += angle_at(corners_[other].points, fans.corner[i] % 3) * faces[other];
        }
        const Vec3 normal = geom::unit_or_zero(sum);
        corners_[t].normals[k] = normal == Vec3(0) ? faces[t] : normal;
      }
  });
}

Vec3 SmoothNormals::at(int t, const Vec3& p) const {
  const auto& [q, n] = corners_[t];
  const Vec3 across = glm::cross(q[1] - q[0], q[2] - q[0]);
  const double area = glm::dot(across, across);
  Vec3 sum{0};
  for (int k = 0; k < 3; ++k) {
    const double share =
        area > 0 ? glm::dot(glm::cross(q[(k + 2) % 3] - q[(k + 1) % 3], p - q[(k + 1) % 3]), across) / area : 1.0 / 3;
    sum += std::max(0.0, share) * n[k];
  }
  return geom::unit_or_zero(sum);
}

}  // namespace riffler::mesh
