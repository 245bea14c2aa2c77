// Merges the vertices of curves within one brick of a mesh.
#include <algorithm>

#include "mesh/adjacency.hpp"
#include "mesh/decimate/flat_brick.hpp"
#include "mesh/decimate/star_collapse.hpp"

namespace riffler::mesh {

double FlatBrick::merge_stars(double tolerance, std::vector<Side>& sides) {
  Vertices points;
  Triangles triangles;
  points.assign(point_.begin(), point_.end()), triangles.resize(triangles_.size());
  base::BulkVector<float> errors(triangles_.size());
  std::fill(errors.begin(), errors.end(), 0.0F);
  std::vector<char> movable(whole_);
  for (int v = 0; v < static_cast<int>(movable.size()); ++v)
    movable[v] = movable[v] && start_[out_[v]] == v && winds_once(v);  // `run` may have removed it
  StarCollapser stars({points, triangles, errors}, tolerance, StarCollapser::Effort::Quick);
  stars.begin(0, points.size(), 1, [&](std::int32_t v) { return movable[v] != 0; });
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    triangles[t] = {start_[3 * t], start_[3 * t + 1], start_[3 * t + 2]};
    if (triangles[t].x >= 0) stars.add(static_cast<std::uint32_t>(t));
  }
  stars.run();
  const auto normal = [&](const Vec3i& t) { return glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]); };
  double error = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3i before(start_[3 * t], start_[3 * t + 1], start_[3 * t + 2]), &after = triangles[t];
    for (int k = 0; k < 3; ++k) start_[3 * t + k] = after[k];
    if (after.x < 0) continue;
    error = std::max<double>(error, errors[t]);
    for (int k = 0; k < 3; ++k) {
      const int a = after[k], b = after[(k + 1) % 3];
      if (movable[a] || movable[b]) continue;
      const int tip = after[(k + 2) % 3];
      const bool changed = tip != before.x && tip != before.y && tip != before.z;
      sides.push_back({vertex_[a], vertex_[b], normal(before), normal(after), changed});
    }
  }
  return error;
}

/// Whether the fan of a vertex, seen along the sum of its normals, surrounds it once.
bool FlatBrick::winds_once(int v) const {
  const Vec3& p = point_[v];
  const auto end_of = [&](int half) { return point_[start_[next_half(half)]] - p; };
  Vec3 sum(0);
  int half = out_[v];
  do {
    const int next = twin_[previous_half(half)];
    sum += glm::cross(end_of(half), end_of(next));
    half = next;
  } while (half != out_[v]);
  const Vec3 size = glm::abs(sum);
  const Vec3 across = size.x <= size.y && size.x <= size.z ? Vec3(0, sum.z, -sum.y)
                      : size.y <= size.z                   ? Vec3(-sum.z, 0, sum.x)
                                                           : Vec3(sum.y, -sum.x, 0);
  int turns = 0;
  do {
    const int next = twin_[previous_half(half)];
    turns += glm::dot(end_of(half), across) <= 0 && glm::dot(end_of(next), across) > 0 ? 1 : 0;
    half = next;
  } while (half != out_[v]);
  return turns == 1;
}

}  // namespace riffler::mesh
