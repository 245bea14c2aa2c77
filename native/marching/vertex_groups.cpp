#include "marching/vertex_groups.hpp"

#include <algorithm>

#include "marching/neighbourhood.hpp"
#include "marching/plain_brick.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

VertexOwners::VertexOwners(const Bricks& bricks, const Vec3i& at) {
  for (int side = 0; side < 8; ++side) {
    const Vec3i below = at - offset_of(side);
    if (const ActiveBrick* const brick = bricks.active(below.x, below.y, below.z))
      first_[side] = brick->first_vertex, count_[side] = brick->vertices();
  }
}

void VertexGroups::sort(const std::vector<std::size_t>& bricks, const Progress& progress) {
  if (const std::size_t size = surface_.mesh.vertices.size(); size > group_.size()) {
    if (size > group_.capacity()) group_.reserve(surface_.mesh.vertices.capacity());
    group_.resize(size);
  }
  const auto each = [&](double from, double to, const auto& body) {
    base::parallel_for(
        bricks.size(), 8,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t n = begin; n < end; ++n) body(bricks[n], *surface_.bricks.active(bricks[n]));
        },
        base::part(progress, from, to));
  };
  each(0, 0.3, [&](std::size_t, const ActiveBrick& brick) { sort_vertices(brick); });
  each(0.3, 1, [&](std::size_t n, const ActiveBrick& brick) {
    borders_[n] = std::make_unique<const BorderTriangles>(list_border(brick));
  });
}

void VertexGroups::sort_vertices(const ActiveBrick& brick) {
  const CaseTable& table = case_table();
  const Neighbourhood signs(surface_.bricks, brick.at);
  constexpr int last = kBrickSide - 1;
  for (int i = 0; i < kBrickSide; ++i)
    for (int j = 0; j < kBrickSide; ++j) {
      const std::size_t begin = brick.vertex(i, j), end = brick.vertex_after(i, j);
      if (begin == end) continue;
      const auto column = static_cast<std::uint8_t>((i == last ? 1 : 0) | (j == last ? 2 : 0));
      std::fill_n(group_.data() + begin, end - begin, column);
      if (!(signs.mixed(i, j) >> (last + Neighbourhood::kLayers) & 1)) continue;
      const int cycles = signs.entry(table, i, j, last).cycles;
      std::fill_n(group_.data() + end - cycles, cycles, static_cast<std::uint8_t>(column | 4));
    }
}

BorderTriangles VertexGroups::list_border(const ActiveBrick& brick) const {
  constexpr int kCorner = 7;
  BorderTriangles out;
  const VertexOwners owners(surface_.bricks, brick.at);
  const auto first_vertex = static_cast<std::int64_t>(brick.first_vertex);
  const auto inner = [&](std::int32_t v) {
    return static_cast<std::size_t>(v - first_vertex) < brick.vertices() && group_[static_cast<std::size_t>(v)] == 0;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;  // list, place
  const Vec3i* const triangles = surface_.mesh.triangles.data() + 2 * brick.first_edge;
  for (std::size_t t = 0; t < 2 * brick.edges(); ++t) {
    if (brick.plain) {
      // Only the outermost quads of a plain brick have border triangles.
      const std::size_t u = t / (2 * kBrickSide), v = t / 2 % kBrickSide;
      if (u > 0 && u < kPlainLast && v == 1) t += 2 * (kPlainLast - 1);
    }
    const Vec3i& v = triangles[t];
    if (inner(v.x) && inner(v.y) && inner(v.z)) continue;
    const auto place = static_cast<std::uint32_t>(out.triangles.size());
    out.triangles.push_back(static_cast<std::uint32_t>(t));
    const std::size_t before = found.size();
    for (const std::int32_t c : {v.x, v.y, v.z}) {
      const int group = of(static_cast<std::size_t>(c));
      if (group == 0 || group == kCorner) continue;
      const std::pair entry{static_cast<std::uint32_t>(7 * owners.of(c).side + group), place};
      if (std::find(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(), entry) == found.end())
        found.push_back(entry);
    }
  }
  for (const auto& [list, place] : found) ++out.begin[list + 1];
  for (std::size_t n = 1; n < out.begin.size(); ++n) out.begin[n] += out.begin[n - 1];
  out.places.resize(found.size());
  std::array<std::uint32_t, 57> next = out.begin;
  for (const auto& [list, place] : found) out.places[next[list]++] = place;
  return out;
}

}  // namespace riffler::marching
