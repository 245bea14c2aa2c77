#include "marching/adaptive.hpp"

#include <algorithm>

#include "marching/neighbourhood.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

namespace {

/// Share of the tolerance that a group may use. What an edge or a face of a brick uses is missing inside the bricks
/// around it, whose triangles start with that error.
double share_of(int group) {
  return group == 0 ? 1 : (group & (group - 1)) == 0 ? 0.5 : 0.25;
}

/// The groups of the vertices and the triangles around them, as in the full mesh.
class VertexGroups {
 public:
  VertexGroups(const Surface& surface, const std::vector<std::size_t>& all, const base::BulkVector<std::uint8_t>& fixed,
               const Progress& progress)
      : surface_(surface),
        group_(surface.mesh.vertices.size()),
        border_(surface.bricks.size()),
        around_(7 * all.size()) {
    const auto each = [&](double from, double to, const auto& body) {
      base::parallel_for(
          all.size(), 8,
          [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) body(n);
          },
          base::part(progress, from, to));
    };
    each(0, 0.3, [&](std::size_t n) {
      const ActiveBrick& brick = *surface_.bricks.active(all[n]);
      sort_vertices(brick);
      for (std::size_t v = brick.first_vertex; v < brick.first_vertex + brick.vertices(); ++v)
        if (fixed[v]) group_[v] = kNoGroup;
    });
    each(0.3, 0.7, [&](std::size_t n) { list_border(all[n]); });
    each(0.7, 1, [&](std::size_t n) {
      for (const std::uint8_t group : kTurns)
        if (group > 0) list_around(*surface_.bricks.active(all[n]), group, around_[7 * n + group]);
    });
  }

  /// Merges vertices of a group of brick `all[n]`.
  void run(StarCollapser& collapser, std::size_t n, const ActiveBrick& brick, int group) const {
    const std::vector<std::uint32_t>& around = around_[7 * n + group];
    if (group > 0 && around.empty()) return;
    collapser.begin(static_cast<std::int32_t>(brick.first_vertex), brick.vertices(), share_of(group),
                    [&](std::int32_t v) { return group_[v] == group; });
    const auto add = [&](std::size_t t) {
      if (surface_.mesh.triangles[t].x >= 0) collapser.add(static_cast<std::uint32_t>(t));
    };
    if (group == 0)
      for (std::size_t t = 2 * brick.first_edge; t < 2 * (brick.first_edge + brick.edges()); ++t) add(t);
    else
      for (const std::uint32_t t : around) add(t);
    collapser.run();
  }

 private:
  static constexpr std::uint8_t kNoGroup = 7;

  bool has(const ActiveBrick& brick, std::int32_t v, int group) const {
    return static_cast<std::size_t>(v) - brick.first_vertex < brick.vertices() && group_[v] == group;
  }

  void sort_vertices(const ActiveBrick& brick) {
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

  /// The triangles of a brick with a vertex outside its group 0.
  void list_border(std::size_t n) {
    const ActiveBrick& brick = *surface_.bricks.active(n);
    for (std::size_t t = 2 * brick.first_edge; t < 2 * (brick.first_edge + brick.edges()); ++t) {
      const Vec3i& v = surface_.mesh.triangles[t];
      if (!has(brick, v.x, 0) || !has(brick, v.y, 0) || !has(brick, v.z, 0))
        border_[n].push_back(static_cast<std::uint32_t>(t));
    }
  }

  void list_around(const ActiveBrick& brick, int group, std::vector<std::uint32_t>& out) const {
    for (int side = 0; side < 8; ++side) {
      const Vec3i at = brick.at + Vec3i(side & 1, side >> 1 & 1, side >> 2);
      if ((side & ~group) != 0 || !surface_.bricks.has(at.x, at.y, at.z)) continue;
      for (const std::uint32_t t : border_[surface_.bricks.index(at.x, at.y, at.z)]) {
        const Vec3i& v = surface_.mesh.triangles[t];
        if (has(brick, v.x, group) || has(brick, v.y, group) || has(brick, v.z, group)) out.push_back(t);
      }
    }
  }

  const Surface& surface_;
  base::BulkVector<std::uint8_t> group_;            // by vertex
  std::vector<std::vector<std::uint32_t>> border_;  // by brick
  std::vector<std::vector<std::uint32_t>> around_;  // by brick in the list and group
};

}  // namespace

void simplify(Surface& surface, const std::vector<std::size_t>& all, double tolerance,
              const base::BulkVector<std::uint8_t>& fixed, const Progress& progress) {
  const VertexGroups groups(surface, all, fixed, base::part(progress, 0, 0.1));
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
            groups.run(collapser, n, *surface.bricks.active(all[n]), kTurns[turn]);
        },
        share);
  }
}

bool fix_folds(const Surface& surface, const std::vector<std::size_t>& all, base::BulkVector<std::uint8_t>& fixed) {
  constexpr double kLyingOn = -0.9999;
  struct Link {
    std::int32_t upper, next;
    std::uint32_t triangle;
  };
  const mesh::Vertices& p = surface.mesh.vertices;
  const auto normal = [&](const Vec3i& v) { return glm::normalize(glm::cross(p[v.y] - p[v.x], p[v.z] - p[v.x])); };
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
      if (glm::dot(normal(one), normal(other)) < kLyingOn) fix(one), fix(other);
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
