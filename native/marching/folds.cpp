#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geom/parallel.hpp"
#include "marching/surface.hpp"

namespace riffler::marching {

namespace {

constexpr double kFolded = -0.999985;  // cosine between the normals of two triangles at an edge; 0.3° off a fold
constexpr int kRounds = 16;            // the pull reaches the anchors after six

Vec3 normal(const Mesh& mesh, const Vec3i& t) {
  const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
  return glm::cross(b - a, c - a);
}

bool folded(const Mesh& mesh, std::size_t s, std::size_t t) {
  const Vec3 a = normal(mesh, mesh.triangles[s]), b = normal(mesh, mesh.triangles[t]);
  return glm::dot(a, b) < kFolded * std::sqrt(glm::dot(a, a) * glm::dot(b, b));
}

CellVertex corner(const Surface& surface, const QuadRef& ref, int n) {
  return {surface.corners(ref.quad)[n], corner_cell(ref.edge, n)};
}

/// Which side of a quad runs from one vertex to the other, either way; −1 if none does.
int side_between(const std::array<std::int32_t, 4>& c, std::int32_t a, std::int32_t b) {
  for (int s = 0; s < 4; ++s)
    if ((c[s] == a && c[(s + 1) & 3] == b) || (c[s] == b && c[(s + 1) & 3] == a)) return s;
  return -1;
}

/// The triangle beyond the side from corner s to the next: its quad stands for another edge of the face that the two
/// corners' cells share.
std::uint32_t across(const Surface& surface, const QuadRef& ref, int s) {
  const CellVertex a = corner(surface, ref, s), b = corner(surface, ref, (s + 1) & 3);
  const Vec3i origin = glm::max(a.cell, b.cell);
  const int along = a.cell.x != b.cell.x ? 0 : a.cell.y != b.cell.y ? 1 : 2;
  for (int d = 1; d <= 2; ++d)
    for (int side = 0; side < 2; ++side) {
      const int axis = (along + d) % 3;
      Vec3i from = origin;
      from[(along + 3 - d) % 3] += side;
      Vec3i to = from;
      ++to[axis];
      const bool inside = surface.bricks.at(from.x, from.y, from.z);
      if (inside == surface.bricks.at(to.x, to.y, to.z)) continue;
      const std::uint32_t quad = surface.bricks.quad_of({axis, from.x, from.y, from.z, !inside});
      if (quad == ref.quad) continue;
      const int there = side_between(surface.corners(quad), a.vertex, b.vertex);
      if (there >= 0) return surface.triangle_at(quad, there);
    }
  throw std::logic_error("a quad of the mesh without a neighbour");
}

/// Ends of the edges at which a triangle of these quads folds onto its neighbour; ascending.
std::vector<CellVertex> folded_vertices(const Surface& surface, const std::vector<QuadRef>& quads) {
  constexpr std::size_t chunk = 1024;
  std::vector<std::vector<CellVertex>> parts((quads.size() + chunk - 1) / chunk);
  parallel_for(quads.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<CellVertex>& ends = parts[begin / chunk];
    for (std::size_t q = begin; q < end; ++q) {
      const QuadRef& ref = quads[q];
      if (folded(surface.mesh, 2 * std::size_t{ref.quad}, 2 * std::size_t{ref.quad} + 1))
        for (int n = 0; n < 4; ++n) ends.push_back(corner(surface, ref, n));
      for (int s = 0; s < 4; ++s)
        if (folded(surface.mesh, surface.triangle_at(ref.quad, s), across(surface, ref, s)))
          ends.push_back(corner(surface, ref, s)), ends.push_back(corner(surface, ref, (s + 1) & 3));
    }
  });
  std::vector<CellVertex> ends;
  for (const auto& part : parts) ends.insert(ends.end(), part.begin(), part.end());
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

/// Siblings have neighbouring numbers, and only siblings can coincide.
bool coincides(const Mesh& mesh, std::int32_t vertex, const Vec3& place) {
  const auto last = std::min<std::int32_t>(vertex + 3, static_cast<std::int32_t>(mesh.vertices.size()) - 1);
  for (std::int32_t v = std::max(0, vertex - 3); v <= last; ++v)
    if (v != vertex && mesh.vertices[v] == place) return true;
  return false;
}

/// Moves a vertex a share of the way to its anchor; one that stands at its candidate goes to its safe place first.
void pull(Surface& surface, const CellVertex& v, double share) {
  Vec3& place = surface.mesh.vertices[v.vertex];
  const FloatGrid& grid = surface.grid;
  Special* const special = surface.marks[v.vertex] & kSpecial ? &surface.special(v) : nullptr;
  if (special && place != special->other) {
    place = special->other;
    return;
  }
  const Vec3 anchor = special ? special->anchor : Vec3(0.5);
  const Vec3 from = glm::clamp(grid.to_cell(v.cell, place), 0.0, 1.0);
  const Vec3 to = grid.free_place(v.cell, grid.inside(v.cell, from + share * (anchor - from)),
                                  [&](const Vec3& p) { return coincides(surface.mesh, v.vertex, p); });
  place = to;
  if (special) special->other = place;
}

/// Splits the quads round moved vertices anew. Where a neighbour's candidate no longer leaves a diagonal, it goes back
/// to its safe place too, and joins the moved ones; with safe places alone there always is a diagonal.
void split_again(Surface& surface, std::vector<CellVertex>& moved, std::vector<Vec3i>& cells) {
  for (std::size_t done = 0; done < moved.size();) {
    for (; done < moved.size(); ++done) {
      surface.marks[moved[done].vertex] |= kMoved;
      cells.push_back(moved[done].cell);
    }
    for (const QuadRef& ref : quads_near(surface, cells, kMoved)) {
      if (surface.split(ref, surface.hits)) continue;
      for (int n = 0; n < 4; ++n) {
        const CellVertex v = corner(surface, ref, n);
        if (!(surface.marks[v.vertex] & kSpecial)) continue;
        const Vec3& safe = surface.special(v).other;
        if (surface.mesh.vertices[v.vertex] == safe) continue;
        surface.mesh.vertices[v.vertex] = safe;
        moved.push_back(v);
      }
    }
  }
}

}  // namespace

void unfold(Surface& surface, const Progress& progress) {
  std::vector<QuadRef> suspects = surface.moved;
  for (std::size_t n = 0; n < surface.bricks.size(); ++n)
    if (const ActiveBrick* const brick = surface.bricks.active(n))
      suspects.insert(suspects.end(), brick->suspects.begin(), brick->suspects.end());
  std::vector<CellVertex> moved = folded_vertices(surface, suspects);
  double share = 0.04;
  for (int round = 0; round < kRounds && !moved.empty(); ++round, share = std::min(1.0, 2 * share)) {
    report(progress, static_cast<double>(round) / kRounds);
    for (const CellVertex& v : moved) pull(surface, v, share);
    std::vector<Vec3i> cells;
    split_again(surface, moved, cells);
    std::vector<CellVertex> next = folded_vertices(surface, quads_near(surface, cells, kMoved));
    for (const CellVertex& v : moved) surface.marks[v.vertex] &= static_cast<std::uint8_t>(~kMoved);
    moved = std::move(next);
  }
}

}  // namespace riffler::marching
