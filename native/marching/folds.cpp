#include <algorithm>
#include <cmath>

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

/// One side of a quad: its ends in order and the triangle that has it.
struct Side {
  std::int32_t low, high;
  std::uint32_t triangle;
  bool operator<(const Side& o) const {
    if (low != o.low) return low < o.low;
    if (high != o.high) return high < o.high;
    return triangle < o.triangle;
  }
};

/// The sides of quad n: c0–c1 and c1–c2 belong to its first triangle, c2–c3 and c3–c0 to its second.
Side side_of(const std::array<std::int32_t, 4>& c, std::uint32_t n, int s) {
  const std::int32_t a = c[s], b = c[(s + 1) & 3];
  return {std::min(a, b), std::max(a, b), 2 * n + (s >= 2)};
}

/// Ends of the edges at which two triangles fold, among the edges of quads with a marked corner; ascending. `cells` are
/// the cells of all marked vertices.
std::vector<std::int32_t> folded_vertices(Surface& surface, const std::vector<Vec3i>& cells, std::uint8_t mark) {
  std::vector<std::int32_t> ends;
  const std::vector<std::uint32_t> quads = quads_marked(surface, columns_near(surface, cells, 0), mark);
  for (const std::uint32_t n : quads) {
    const auto c = surface.corners(n);
    for (const std::int32_t v : c) surface.marks[v] |= kNear;
    if (folded(surface.mesh, 2 * n, 2 * n + 1)) ends.insert(ends.end(), c.begin(), c.end());
  }
  // Quads on the other side of such an edge have both its ends near.
  std::vector<Side> sides;
  for (const std::uint32_t n : quads_marked(surface, columns_near(surface, cells, 1), kNear)) {
    const auto c = surface.corners(n);
    for (int s = 0; s < 4; ++s)
      if (surface.marks[c[s]] & surface.marks[c[(s + 1) & 3]] & kNear) sides.push_back(side_of(c, n, s));
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t n = 1; n < sides.size(); ++n) {
    const Side &a = sides[n - 1], &b = sides[n];
    if (a.low == b.low && a.high == b.high && folded(surface.mesh, a.triangle, b.triangle))
      ends.push_back(a.low), ends.push_back(a.high);
  }
  for (const std::uint32_t n : quads)
    for (const std::int32_t v : surface.corners(n)) surface.marks[v] &= static_cast<std::uint8_t>(~kNear);
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

Vec3i cell_of(Surface& surface, std::int32_t vertex) {
  if (surface.marks[vertex] & kSpecial) return surface.special(vertex).cell;
  return surface.grid.cell_of(surface.mesh.vertices[vertex]);
}

/// Moves a vertex a share of the way to its anchor; one that stands at its candidate goes to its safe place first.
void pull(Surface& surface, std::int32_t vertex, double share) {
  Vec3& place = surface.mesh.vertices[vertex];
  const FloatGrid& grid = surface.grid;
  Special* const special = surface.marks[vertex] & kSpecial ? &surface.special(vertex) : nullptr;
  if (special && place != special->other) {
    place = special->other;
    return;
  }
  const Vec3i cell = cell_of(surface, vertex);
  const Vec3 anchor = special ? special->anchor : Vec3(0.5);
  const Vec3 from = glm::clamp(grid.to_cell(cell, place), 0.0, 1.0);
  const Vec3 to = grid.free_place(cell, grid.inside(cell, from + share * (anchor - from)),
                                  [&](const Vec3& p) { return coincides(surface.mesh, vertex, p); });
  place = to;
  if (special) special->other = place;
}

/// Splits the quads round moved vertices anew. Where a neighbour's candidate no longer leaves a diagonal, it goes back
/// to its safe place too, and joins the moved ones; with safe places alone there always is a diagonal.
void split_again(Surface& surface, std::vector<std::int32_t>& moved, std::vector<Vec3i>& cells) {
  for (std::size_t done = 0; done < moved.size();) {
    for (; done < moved.size(); ++done) {
      surface.marks[moved[done]] |= kMoved;
      cells.push_back(cell_of(surface, moved[done]));
    }
    for (const std::uint32_t n : quads_marked(surface, columns_near(surface, cells, 0), kMoved)) {
      if (surface.split(n, surface.counts.locate(surface.signs, n))) continue;
      for (const std::int32_t v : surface.corners(n)) {
        if (!(surface.marks[v] & kSpecial)) continue;
        const Vec3& safe = surface.special(v).other;
        if (surface.mesh.vertices[v] == safe) continue;
        surface.mesh.vertices[v] = safe;
        moved.push_back(v);
      }
    }
  }
}

}  // namespace

void unfold(Surface& surface) {
  std::vector<Vec3i> cells = surface.sharp;
  for (const Special& s : surface.specials) cells.push_back(s.cell);
  std::vector<std::int32_t> moved = folded_vertices(surface, cells, kSharp | kSpecial);
  double share = 0.04;
  for (int round = 0; round < kRounds && !moved.empty(); ++round, share = std::min(1.0, 2 * share)) {
    for (const std::int32_t v : moved) pull(surface, v, share);
    cells.clear();
    split_again(surface, moved, cells);
    std::vector<std::int32_t> next = folded_vertices(surface, cells, kMoved);
    for (const std::int32_t v : moved) surface.marks[v] &= static_cast<std::uint8_t>(~kMoved);
    moved = std::move(next);
  }
}

}  // namespace riffler::marching
