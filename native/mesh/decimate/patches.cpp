#include "mesh/decimate/patches.hpp"

#include <algorithm>
#include <array>

#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Three perpendicular directions, different for each of five frames.
std::array<Vec3, 3> axes_of(int frame) {
  constexpr double kParts[5][3] = {{0, 0, 1}, {1, 2, 2}, {-2, 1, 3}, {3, -1, 1}, {1, 3, -2}};
  const auto& part = kParts[frame % 5];
  const Vec3 z = glm::normalize(Vec3(part[0], part[1], part[2]));
  const Vec3 x = glm::normalize(glm::cross(Vec3(0, 1, 0), z));
  return {x, glm::cross(z, x), z};
}

struct Place {
  std::array<float, 3> at;
  int vertex;
};

}  // namespace

Patches::Patches(const HalfEdgeMesh& mesh, int frame, std::size_t vertices_of_one, const Progress& progress)
    : patch_(mesh.n_vertices(), -1), inner_(mesh.n_vertices(), 0) {
  for (const VertexHandle v : mesh.all_vertices())
    if (!mesh.status(v).deleted() && mesh.halfedge_handle(v).is_valid()) order_.push_back(v.idx());
  int levels = 0;
  while ((order_.size() >> levels) > vertices_of_one) ++levels;
  split(mesh, frame, levels, base::part(progress, 0, 0.8));
  base::report(progress, 0.8);
  base::parallel_for(size(), 1, [&](std::size_t patch, std::size_t) {
    for_each_vertex(patch, [&](VertexHandle v) { patch_[v.idx()] = static_cast<int>(patch); });
  });
  base::parallel_for(size(), 1, [&](std::size_t patch, std::size_t) {
    for_each_vertex(patch, [&](VertexHandle v) {
      const HalfedgeHandle start = mesh.halfedge_handle(v);
      HalfedgeHandle spoke = start;
      bool alone = true;
      do {
        alone &= patch_[mesh.to_vertex_handle(spoke).idx()] == static_cast<int>(patch);
        spoke = mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(spoke));
      } while (spoke != start);
      inner_[v.idx()] = alone;
    });
  });
}

/// Splits level by level at the median along the longest side. The index breaks ties.
void Patches::split(const HalfEdgeMesh& mesh, int frame, int levels, const Progress& progress) {
  const std::array<Vec3, 3> axes = axes_of(frame);
  std::vector<Place> places(order_.size());
  base::parallel_for(places.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 p = to_vec3(mesh.point(VertexHandle(order_[i])));
      for (int k = 0; k < 3; ++k) places[i].at[k] = static_cast<float>(glm::dot(p, axes[k]));
      places[i].vertex = order_[i];
    }
  });
  const auto first = [&](std::size_t place, int level) { return (place * places.size()) >> level; };
  for (int level = 0; level < levels; ++level) {
    base::report(progress, static_cast<double>(level) / levels);
    base::parallel_for(std::size_t{1} << level, 1, [&](std::size_t place, std::size_t) {
      const auto begin = places.begin() + static_cast<std::ptrdiff_t>(first(place, level));
      const auto middle = places.begin() + static_cast<std::ptrdiff_t>(first(2 * place + 1, level + 1));
      const auto end = places.begin() + static_cast<std::ptrdiff_t>(first(place + 1, level));
      std::array<float, 3> low = begin->at, high = low;
      for (auto i = begin; i != end; ++i)
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], i->at[k]), high[k] = std::max(high[k], i->at[k]);
      int axis = 0;
      for (int k = 1; k < 3; ++k)
        if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
      std::nth_element(begin, middle, end, [&](const Place& a, const Place& b) {
        return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.vertex < b.vertex;
      });
    });
  }
  begin_.clear();
  for (std::size_t place = 0; place <= std::size_t{1} << levels; ++place) begin_.push_back(first(place, levels));
  base::parallel_for(size(), 1, [&](std::size_t patch, std::size_t) {
    const auto begin = places.begin() + static_cast<std::ptrdiff_t>(begin_[patch]);
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(begin_[patch + 1]);
    // nth_element leaves the order within a patch undefined.
    std::sort(begin, end, [](const Place& a, const Place& b) { return a.vertex < b.vertex; });
    for (auto i = begin; i != end; ++i) order_[static_cast<std::size_t>(i - places.begin())] = i->vertex;
  });
}

}  // namespace riffler::mesh
