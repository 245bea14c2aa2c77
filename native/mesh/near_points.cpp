#include "mesh/near_points.hpp"

#include <algorithm>
#include <cmath>

#include "base/mix.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/weld.hpp"

namespace riffler::mesh {

namespace {

/// Vertices at edges of one triangle, ascending.
std::vector<int> open_vertices(const Mesh& mesh) {
  std::vector<int> out;
  const Adjacency adjacency(mesh);
  for (int half = 0; half < static_cast<int>(3 * mesh.triangles.size()); ++half)
    if (adjacency.is_open(half)) out.push_back(start_of(mesh, half)), out.push_back(end_of(mesh, half));
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

NearPoints::NearPoints(double size, std::size_t points) : size_(size), heads_(std::bit_ceil(2 * points + 1), -1) {
  points_.reserve(points);
}

int NearPoints::find_or_add(const Vec3& p) {
  const Vec3 cell = glm::floor(p / size_);
  for (int k = 0; k < 27; ++k) {
    const Vec3 near = cell + Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    for (int at = heads_[slot(near)]; at >= 0; at = points_[static_cast<std::size_t>(at)].next)
      if (const Point& q = points_[static_cast<std::size_t>(at)]; q.cell == near && glm::length(q.p - p) <= size_)
        return at;
  }
  int& head = heads_[slot(cell)];
  points_.push_back({p, cell, head});
  return head = static_cast<int>(points_.size()) - 1;
}

std::size_t NearPoints::slot(const Vec3& cell) const {
  const Vec3 c = cell + 0.0;  // −0 becomes 0
  std::uint64_t h = base::mix_bits(std::bit_cast<std::uint64_t>(c.x));
  h = base::mix_bits(h + std::bit_cast<std::uint64_t>(c.y)), h = base::mix_bits(h + std::bit_cast<std::uint64_t>(c.z));
  return h & (heads_.size() - 1);
}

double rounding_of(const Mesh& mesh) {
  const Box3 box = bounds(mesh);
  const Vec3 far = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  return 8 * std::ldexp(std::max({far.x, far.y, far.z}), -52);
}

std::optional<Mesh> join_near(const Mesh& mesh) {
  const std::vector<int> rim = open_vertices(mesh);
  const double reach = rim.empty() ? 0 : rounding_of(mesh);
  if (!(reach > 0)) return {};
  NearPoints near(reach, rim.size());
  std::vector<int> first, moved(mesh.vertices.size(), -1);
  bool any = false;
  for (const int v : rim) {
    const auto number = static_cast<std::size_t>(near.find_or_add(mesh.vertices[v]));
    if (number == first.size()) {
      first.push_back(v);
    } else if (mesh.vertices[first[number]] != mesh.vertices[v]) {
      moved[v] = first[number], any = true;
    }
  }
  if (!any) return {};
  Mesh out = mesh;
  for (Vec3i& t : out.triangles)
    for (int k = 0; k < 3; ++k)
      if (moved[t[k]] >= 0) t[k] = moved[t[k]];
  return out;
}

Mesh welded(const Mesh& mesh) {
  Welder<Vec3> welder(mesh.vertices.size());
  std::vector<int> same(mesh.vertices.size());
  welder.add(mesh.vertices, same.data());
  Mesh out;
  out.vertices.assign(welder.points().begin(), welder.points().end());
  out.triangles = mesh.triangles;
  for (Vec3i& t : out.triangles) t = {same[t.x], same[t.y], same[t.z]};
  if (std::optional<Mesh> joined = join_near(out)) return *std::move(joined);
  return out;
}

}  // namespace riffler::mesh
