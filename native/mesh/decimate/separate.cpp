#include "mesh/decimate/separate.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "geom/float32.hpp"
#include "mesh/weld.hpp"

namespace riffler::mesh {

namespace {

constexpr int kSteps = 2;  // float32 steps along each axis

double stepped(double x, int steps) {
  auto value = static_cast<float>(x);
  const float to = std::copysign(std::numeric_limits<float>::infinity(), static_cast<float>(steps));
  for (int k = 0; k < std::abs(steps); ++k) value = std::nextafter(value, to);
  return static_cast<double>(value);
}

/// The triangles at each vertex.
class VertexFans {
 public:
  explicit VertexFans(const Mesh& mesh) : begin_(mesh.vertices.size() + 1, 0), triangles_(3 * mesh.triangles.size()) {
    for (const Vec3i& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) ++begin_[t[k]];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    for (std::size_t i = triangles_.size(); i-- > 0;)
      triangles_[--begin_[mesh.triangles[i / 3][static_cast<int>(i % 3)]]] = static_cast<int>(i / 3);
  }
  std::span<const int> of(std::size_t v) const {
    return std::span(triangles_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<int> triangles_;
};

/// Whether all triangles of the fan of v keep their sides when v moves to p.
bool keeps_sides(const Mesh& mesh, std::span<const int> fan, int v, const Vec3& p) {
  for (const int triangle : fan) {
    const Vec3i& t = mesh.triangles[triangle];
    std::array<Vec3, 3> old, now;
    for (int k = 0; k < 3; ++k) old[k] = mesh.vertices[t[k]], now[k] = geom::to_float32(t[k] == v ? p : old[k]);
    if (!(glm::dot(glm::cross(old[1] - old[0], old[2] - old[0]), glm::cross(now[1] - now[0], now[2] - now[0])) > 0))
      return false;
  }
  return true;
}

}  // namespace

double separation_reach(double largest) {
  return kSteps * std::sqrt(3.0) * std::ldexp(largest, -23);
}

void separate(Mesh& mesh, const std::vector<char>& movable) {
  Welder<Vec3> taken(mesh.vertices.size());
  const auto is_free = [&](const Vec3& p) {
    const std::size_t before = taken.points().size();
    return taken.add(geom::to_float32(p)) == static_cast<int>(before);
  };
  for (std::size_t v = 0; v < movable.size(); ++v)
    if (!movable[v]) is_free(mesh.vertices[v]);
  std::optional<VertexFans> fans;  // rarely needed
  for (std::size_t v = 0; v < movable.size(); ++v) {
    if (!movable[v] || is_free(mesh.vertices[v])) continue;
    if (!fans) fans.emplace(mesh);
    const auto at_other_place = [&] {
      const Vec3 home = mesh.vertices[v];
      for (int reach = 1; reach <= kSteps; ++reach)
        for (int x = -reach; x <= reach; ++x)
          for (int y = -reach; y <= reach; ++y)
            for (int z = -reach; z <= reach; ++z) {
              const Vec3 p(stepped(home.x, x), stepped(home.y, y), stepped(home.z, z));
              if (!keeps_sides(mesh, fans->of(v), static_cast<int>(v), p) || !is_free(p)) continue;
              mesh.vertices[v] = p;
              return true;
            }
      return false;
    };
    at_other_place();
  }
}

}  // namespace riffler::mesh
