#include "marching/adaptive.hpp"

#include <algorithm>

#include "riffler/base/parallel.hpp"

namespace riffler::marching {

namespace {

/// Merges vertices of a group of a brick.
void run(StarCollapser& collapser, const Surface& surface, const VertexGroups& groups, const ActiveBrick& brick,
         int group, const base::BulkVector<std::uint8_t>& fixed) {
  bool begun = false;
  const auto add = [&](std::size_t t) {
    if (surface.mesh.triangles[t].x < 0) return;
    if (!begun)
      collapser.begin(static_cast<std::int32_t>(brick.first_vertex), brick.vertices(), share_of(group),
                      [&](std::int32_t v) { return groups.of(v) == group && !fixed[v]; });
    begun = true;
    collapser.add(static_cast<std::uint32_t>(t));
  };
  if (group == 0)
    for (std::size_t t = 2 * brick.first_edge; t < 2 * (brick.first_edge + brick.edges()); ++t) add(t);
  else
    for (int side = 0; side < 8; ++side) {
      const Vec3i at = brick.at + offset_of(side);
      const ActiveBrick* const other = reaches(group, side) ? surface.bricks.active(at.x, at.y, at.z) : nullptr;
      if (!other) continue;
      const BorderTriangles& border = groups.border(surface.bricks.index(at.x, at.y, at.z));
      for (const std::uint32_t place : border.around(side, group)) add(2 * other->first_edge + border.triangles[place]);
    }
  if (begun) collapser.run();
}

}  // namespace

void simplify(Surface& surface, const std::vector<std::size_t>& all, double tolerance,
              const base::BulkVector<std::uint8_t>& fixed, const Progress& progress) {
  VertexGroups groups(surface);
  groups.sort(all, base::part(progress, 0, 0.1));
  base::BulkVector<float> errors(surface.mesh.triangles.size());
  base::parallel_for(errors.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
    std::fill_n(errors.data() + begin, end - begin, 0.0F);
  });
  const AdaptiveMesh mesh{surface.mesh.vertices, surface.mesh.triangles, errors};
  for (std::size_t turn = 0; turn < kTurns.size(); ++turn) {
    const double from = turn == 0 ? 0.1 : 0.1 + 0.05 * static_cast<double>(turn);
    const Progress share = base::part(progress, from, turn + 1 == kTurns.size() ? 1 : from + 0.05);
    base::parallel_for(
        all.size(), 8,
        [&](std::size_t begin, std::size_t end) {
          StarCollapser collapser(mesh, tolerance);
          for (std::size_t n = begin; n < end; ++n)
            run(collapser, surface, groups, *surface.bricks.active(all[n]), kTurns[turn], fixed);
        },
        share);
  }
}

bool lie_on(const mesh::Vertices& p, const Vec3i& one, const Vec3i& other) {
  constexpr double kLyingOn = -0.9999;
  const auto normal = [&](const Vec3i& v) { return glm::normalize(glm::cross(p[v.y] - p[v.x], p[v.z] - p[v.x])); };
  return glm::dot(normal(one), normal(other)) < kLyingOn;
}

bool fix_folds(const Surface& surface, const std::vector<std::size_t>& all, base::BulkVector<std::uint8_t>& fixed) {
  struct Link {
    std::int32_t upper, next;
    std::uint32_t triangle;
  };
  // For each vertex, a list of the edges to higher vertices that one triangle has so far.
  std::vector<std::int32_t> first(fixed.size(), -1);
  std::vector<Link> links;
  bool found = false;
  const auto fix = [&](const Vec3i& t) {
    for (const std::int32_t v : {t.x, t.y, t.z}) found |= !fixed[v], fixed[v] = 1;
  };
  const auto add = [&](std::int32_t a, std::int32_t b, std::uint32_t t) {
    const auto [lower, upper] = std::minmax(a, b);
    for (std::int32_t e = first[lower]; e >= 0; e = links[e].next) {
      if (links[e].upper != upper) continue;
      const Vec3i &one = surface.mesh.triangles[links[e].triangle], &other = surface.mesh.triangles[t];
      if (lie_on(surface.mesh.vertices, one, other)) fix(one), fix(other);
      return;
    }
    links.push_back({upper, first[lower], t});
    first[lower] = static_cast<std::int32_t>(links.size()) - 1;
  };
  for (const std::size_t n : all) {
    const ActiveBrick& brick = *surface.bricks.active(n);
    for (std::size_t t = 2 * brick.first_edge; t < 2 * (brick.first_edge + brick.edges()); ++t) {
      const Vec3i& v = surface.mesh.triangles[t];
      if (v.x < 0) continue;
      const auto at = static_cast<std::uint32_t>(t);
      add(v.x, v.y, at), add(v.y, v.z, at), add(v.z, v.x, at);
    }
  }
  return found;
}

}  // namespace riffler::marching
