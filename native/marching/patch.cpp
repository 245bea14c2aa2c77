#include "riffler/marching/patch.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/sort_unique.hpp"
#include "marching/mesh_state.hpp"

namespace riffler::marching {

namespace {

/// Vertices of one brick, and the offset from their numbers in the mesh to those in the patch.
struct Own {
  std::int32_t first, end, less;
  bool has(std::int32_t v) const { return v >= first && v < end; }
  bool operator<(const Own& o) const { return first < o.first; }
};

std::vector<const ActiveBrick*> active_of(const MeshState& state, std::span<const std::size_t> bricks,
                                          std::vector<std::size_t>& found) {
  std::vector<std::size_t> sorted(bricks.begin(), bricks.end());
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
    throw std::invalid_argument("bricks: " + std::to_string(*twice) + " is listed twice");
  if (!sorted.empty() && sorted.back() >= state.bricks.size())
    throw std::out_of_range("there is no brick " + std::to_string(sorted.back()) + ", only " +
                            std::to_string(state.bricks.size()));
  std::vector<const ActiveBrick*> out;
  for (const std::size_t n : bricks)
    if (state.triangles(n) > 0) out.push_back(state.bricks.active(n)), found.push_back(n);
  return out;
}

/// A patch with all triangles.
MeshPatch full_patch(const MeshState& state, std::span<const std::size_t> bricks) {
  MeshPatch out;
  const std::vector<const ActiveBrick*> active = active_of(state, bricks, out.bricks);
  std::vector<Own> own;
  std::size_t triangles = 0;
  for (const ActiveBrick* const brick : active) {
    const auto first = static_cast<std::int32_t>(brick->first_vertex);
    own.push_back(
        {first, first + static_cast<std::int32_t>(brick->vertices()), first - static_cast<std::int32_t>(out.own)});
    out.own += brick->vertices(), triangles += 2 * brick->edges();
  }
  std::vector<Own> sorted = own;
  std::sort(sorted.begin(), sorted.end());
  const Mesh& mesh = state.surface.mesh;
  out.triangles.resize(triangles);
  // Corners at vertices of other bricks: their numbers in the patch are known only when all have been seen.
  std::vector<std::int32_t*> open;
  std::vector<std::int32_t>& foreign = out.foreign;
  Vec3i* next = out.triangles.data();
  for (std::size_t b = 0; b < active.size(); ++b) {
    const Own here = own[b];
    const auto number = [&](std::int32_t v, std::int32_t& to) {
      if (here.has(v)) [[likely]] {
        to = v - here.less;
        return;
      }
      const auto after = std::upper_bound(sorted.begin(), sorted.end(), Own{v, 0, 0});
      if (after != sorted.begin() && (after - 1)->has(v)) {
        to = v - (after - 1)->less;
      } else {
        to = v;
        open.push_back(&to), foreign.push_back(v);
      }
    };
    const Vec3i* const from = mesh.triangles.data() + 2 * active[b]->first_edge;
    for (std::size_t t = 0; t < 2 * active[b]->edges(); ++t, ++next)
      number(from[t].x, next->x), number(from[t].y, next->y), number(from[t].z, next->z);
  }
  base::sort_unique(foreign);
  for (std::int32_t* const corner : open)
    *corner = static_cast<std::int32_t>(out.own) +
              static_cast<std::int32_t>(std::lower_bound(foreign.begin(), foreign.end(), *corner) - foreign.begin());

  out.vertices.resize(out.own + foreign.size());
  Vec3f* vertex = out.vertices.data();
  const auto place = [&](std::int32_t v) { *vertex++ = Vec3f(to_world(state.lattice.axis(), mesh.vertices[v])); };
  for (const Own& o : own)
    for (std::int32_t v = o.first; v < o.end; ++v) place(v);
  for (const std::int32_t v : foreign) place(v);
  return out;
}

/// A patch with the triangles that a tolerance leaves, and only the vertices that they use.
MeshPatch adaptive_patch(const MeshState& state, std::span<const std::size_t> bricks) {
  MeshPatch out;
  const std::vector<const ActiveBrick*> active = active_of(state, bricks, out.bricks);
  std::vector<std::int32_t> used;
  for (const std::size_t n : out.bricks)
    state.adaptive->for_triangles(n, [&](const Vec3i& t) {
      out.triangles.push_back(t);
      used.insert(used.end(), {t.x, t.y, t.z});
    });
  base::sort_unique(used);
  std::vector<std::int32_t> number(used.size(), -1);
  const auto place = [&](std::int32_t v) {
    out.vertices.emplace_back(to_world(state.lattice.axis(), state.surface.mesh.vertices[v]));
  };
  for (const ActiveBrick* const brick : active) {
    const auto begin = std::lower_bound(used.begin(), used.end(), static_cast<std::int32_t>(brick->first_vertex));
    const auto end =
        std::lower_bound(begin, used.end(), static_cast<std::int32_t>(brick->first_vertex + brick->vertices()));
    for (auto v = begin; v != end; ++v) {
      number[static_cast<std::size_t>(v - used.begin())] = static_cast<std::int32_t>(out.vertices.size());
      out.numbers.push_back(*v), place(*v);
    }
  }
  out.own = out.vertices.size();
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (number[n] >= 0) continue;
    number[n] = static_cast<std::int32_t>(out.vertices.size());
    out.foreign.push_back(used[n]), out.numbers.push_back(used[n]), place(used[n]);
  }
  for (Vec3i& t : out.triangles)
    for (int c = 0; c < 3; ++c)
      t[c] = number[static_cast<std::size_t>(std::lower_bound(used.begin(), used.end(), t[c]) - used.begin())];
  return out;
}

}  // namespace

MeshPatch patch_of(const MeshState& state, std::span<const std::size_t> bricks) {
  return state.adaptive ? adaptive_patch(state, bricks) : full_patch(state, bricks);
}

}  // namespace riffler::marching
