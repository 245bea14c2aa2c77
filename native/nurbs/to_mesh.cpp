// Surface::to_mesh: spans are divided in parallel, then edges collect the vertices of both their sides, then cells are
// triangulated in parallel.
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "mesh/near_points.hpp"
#include "nurbs/cell_polygon.hpp"
#include "nurbs/exact_triangles.hpp"
#include "nurbs/mesh_plan.hpp"
#include "nurbs/shared_edges.hpp"
#include "nurbs/surface_core.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/nurbs/surface.hpp"

namespace riffler::nurbs {

namespace {

constexpr std::size_t kMaxTriangles = 50'000'000;
constexpr double kWeld = 1e-12;  // of the largest coordinate

/// The vertices on one line of a span: their places along it, ascending, and their numbers.
using Line = std::vector<std::pair<std::int64_t, int>>;

struct PlaceHash {
  std::size_t operator()(std::int64_t x) const {
    return static_cast<std::size_t>((static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL) >> 7);
  }
};

/// The vertices of a span, by the lines of its cells.
struct SpanVertices {
  std::vector<Place> inner;
  std::unordered_map<std::int64_t, Line, PlaceHash> at_u, at_v;  // lines of constant u and v

  explicit SpanVertices(const std::vector<MeshCell>& cells) {
    for (const MeshCell& c : cells)
      for (const Place& p : {c.lower, Place(c.upper.x, c.lower.y), Place(c.lower.x, c.upper.y), c.upper})
        if (p.x > 0 && p.x < kGrid && p.y > 0 && p.y < kGrid) inner.push_back(p);
    const auto before = [](const Place& a, const Place& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
    std::sort(inner.begin(), inner.end(), before);
    inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
  }

  void add(const Place& p, int vertex) {
    at_u[p.x].emplace_back(p.y, vertex);
    at_v[p.y].emplace_back(p.x, vertex);
  }

  void sort() {
    for (auto* lines : {&at_u, &at_v})
      for (auto& [place, line] : *lines) std::sort(line.begin(), line.end());
  }
};

/// The place at `along` on a side of a span.
Place on_side(int side, std::int64_t along) {
  switch (side) {
    case 0:
      return {along, 0};
    case 1:
      return {kGrid, along};
    case 2:
      return {along, kGrid};
    default:
      return {0, along};
  }
}

class Tessellation {
 public:
  Tessellation(const SurfaceCore& core, double tolerance)
      : core_(core), tolerance_(tolerance), edges_(core.spans, kWeld * core.scale), cells_(core.spans.size()) {}

  Mesh run(const Progress& progress) {
    plan(base::part(progress, 0, 0.4));
    count_vertices();
    std::vector<std::vector<Vec3i>> triangles(core_.spans.size());
    base::parallel_for(
        core_.spans.size(), 1, [&](std::size_t s, std::size_t) { fill_span(s, triangles[s]); },
        base::part(progress, 0.4, 0.95));
    for (const auto& some : triangles) {
      if (mesh_.triangles.size() + some.size() > kMaxTriangles) too_many();
      mesh_.triangles.insert(mesh_.triangles.end(), some.begin(), some.end());
    }
    base::report(progress, 1);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] static void too_many() {
    throw std::invalid_argument("tolerance: the mesh would have more than 50 million triangles; give a larger one");
  }

  /// Divides spans into cells. A closed ring needs at least three, a span between two poles two.
  void plan(const Progress& progress) {
    base::parallel_for(
        core_.spans.size(), 1,
        [&](std::size_t s, std::size_t) {
          const auto& use = edges_.of_span[s];
          const std::size_t patch = core_.spans[s].patch;
          const auto ring = [](std::size_t spans) { return spans == 1 ? 3 : spans == 2 ? 2 : 1; };
          const bool pole_u = edge(use[1]).collapsed && edge(use[3]).collapsed;
          const bool pole_v = edge(use[0]).collapsed && edge(use[2]).collapsed;
          const int least_u = std::max(ring(core_.breaks_u[patch].size()), pole_u ? 2 : 1);
          const int least_v = std::max(ring(core_.breaks_v[patch].size()), pole_v ? 2 : 1);
          const bool closed_u = is_closed(patch, true), closed_v = is_closed(patch, false);
          cells_[s] = plan_cells(core_.spans[s], tolerance_, closed_u || pole_u ? least_u : 1,
                                 closed_v || pole_v ? least_v : 1, kMaxTriangles / 2);
        },
        progress);
    std::size_t cells = 0;
    for (const auto& some : cells_) cells += some.size();
    if (cells > kMaxTriangles / 2) too_many();
  }

  const SharedEdge& edge(const EdgeUse& use) const { return edges_.edges[static_cast<std::size_t>(use.edge)]; }

  /// Whether the two ends of a patch are one edge, in the first row of its spans.
  bool is_closed(std::size_t patch, bool along_u) const {
    const std::size_t nu = core_.breaks_u[patch].size(), nv = core_.breaks_v[patch].size();
    const std::size_t first = core_.first_span[patch], last = along_u ? first + (nu - 1) * nv : first + nv - 1;
    const auto &a = edges_.of_span[first], &b = edges_.of_span[last];
    return along_u ? a[3].edge == b[1].edge : a[0].edge == b[2].edge;
  }

  /// Edges collect the places of both sides; corners come first, then edges, then the inner vertices of each span.
  void count_vertices() {
    for (std::size_t s = 0; s < cells_.size(); ++s)
      for (const MeshCell& c : cells_[s]) {
        const Place corners[2] = {c.lower, c.upper};
        for (const Place& p : corners) {
          if (c.lower.y == 0) add_place(s, 0, p.x);
          if (c.upper.y == kGrid) add_place(s, 2, p.x);
          if (c.upper.x == kGrid) add_place(s, 1, p.y);
          if (c.lower.x == 0) add_place(s, 3, p.y);
        }
      }
    mesh_.vertices.assign(edges_.corners.begin(), edges_.corners.end());
    for (SharedEdge& e : edges_.edges) {
      std::sort(e.places.begin(), e.places.end());
      e.places.erase(std::unique(e.places.begin(), e.places.end()), e.places.end());
      first_of_edge_.push_back(mesh_.vertices.size());
      const int count = static_cast<int>(e.points.size());
      for (const std::int64_t at : e.places)
        mesh_.vertices.push_back(
            affine(curve_point(e.points.data(), count, static_cast<double>(at) / static_cast<double>(kGrid))));
    }
    for (const auto& cells : cells_) {
      spans_.emplace_back(cells);
      first_of_span_.push_back(mesh_.vertices.size());
      mesh_.vertices.resize(mesh_.vertices.size() + spans_.back().inner.size());
    }
    if (mesh_.vertices.size() > kMaxTriangles) too_many();
    for (std::size_t v = 0; v < first_of_span_.front(); ++v) mesh_.vertices[v] += core_.origin;
  }

  void add_place(std::size_t span, int side, std::int64_t at) {
    const EdgeUse use = edges_.of_span[span][static_cast<std::size_t>(side)];
    SharedEdge& e = edges_.edges[static_cast<std::size_t>(use.edge)];
    if (at > 0 && at < kGrid && !e.collapsed) e.places.push_back(use.place(at));
  }

  void fill_span(std::size_t s, std::vector<Vec3i>& triangles) {
    const BezierSpan& span = core_.spans[s];
    SpanVertices& lines = spans_[s];
    for (std::size_t k = 0; k < lines.inner.size(); ++k) {
      const std::size_t v = first_of_span_[s] + k;
      mesh_.vertices[v] =
          core_.origin + affine(point_of(span.net.data(), span.degrees, to_unit_square(lines.inner[k])));
      lines.add(lines.inner[k], static_cast<int>(v));
    }
    for (int side = 0; side < 4; ++side) add_side(s, side);
    lines.sort();
    // Reads vertices of this span and its edges only, because other threads are writing those of other spans.
    std::vector<CornerOfCell> polygon;
    for (const MeshCell& cell : cells_[s]) {
      border(lines, cell, polygon);
      append_triangles(polygon, mesh_.vertices, triangles);
    }
    lines = SpanVertices(std::vector<MeshCell>());
  }

  /// Adds the vertices of a side; all places on a pole are one vertex.
  void add_side(std::size_t s, int side) {
    const EdgeUse use = edges_.of_span[s][static_cast<std::size_t>(side)];
    const SharedEdge& e = edge(use);
    SpanVertices& lines = spans_[s];
    for (std::size_t k = 0; k < e.places.size(); ++k)
      lines.add(on_side(side, use.place(e.places[k])),
                static_cast<int>(first_of_edge_[static_cast<std::size_t>(use.edge)] + k));
    if (e.collapsed)
      for (const MeshCell& c : cells_[s]) {
        if (side % 2 == 0 ? (side == 0 ? c.lower.y != 0 : c.upper.y != kGrid)
                          : (side == 3 ? c.lower.x != 0 : c.upper.x != kGrid))
          continue;
        for (const Place& p : {c.lower, c.upper}) lines.add(on_side(side, side % 2 == 0 ? p.x : p.y), e.begin);
      }
    lines.add(on_side(side, 0), use.reversed ? e.end : e.begin);
    lines.add(on_side(side, kGrid), use.reversed ? e.begin : e.end);
  }

  static void border(const SpanVertices& lines, const MeshCell& cell, std::vector<CornerOfCell>& polygon) {
    polygon.clear();
    const auto walk = [&](const Line& line, std::int64_t from, std::int64_t to, unsigned side, bool back) {
      const std::size_t begin = polygon.size();
      const auto first = std::lower_bound(line.begin(), line.end(), std::pair<std::int64_t, int>(from, -1));
      for (auto i = first; i != line.end() && i->first <= to; ++i) polygon.push_back({i->second, 1U << side});
      if (back) std::reverse(polygon.begin() + static_cast<std::ptrdiff_t>(begin), polygon.end());
    };
    walk(lines.at_v.at(cell.lower.y), cell.lower.x, cell.upper.x, 0, false);
    walk(lines.at_u.at(cell.upper.x), cell.lower.y, cell.upper.y, 1, false);
    walk(lines.at_v.at(cell.upper.y), cell.lower.x, cell.upper.x, 2, true);
    walk(lines.at_u.at(cell.lower.x), cell.lower.y, cell.upper.y, 3, true);
  }

  const SurfaceCore& core_;
  double tolerance_;
  SharedEdges edges_;
  std::vector<std::vector<MeshCell>> cells_;  // of each span
  std::vector<SpanVertices> spans_;
  std::vector<std::size_t> first_of_edge_, first_of_span_;
  Mesh mesh_;
};

/// Triangles of the parameters inside of the borders. Equal corners are one vertex.
Mesh trimmed_mesh(const SurfaceCore& core, double tolerance, const Progress& progress) {
  const ExactTriangles all =
      exact_triangles(core, {tolerance, std::numeric_limits<double>::infinity(), 1, kMaxTriangles}, progress);
  Mesh mesh;
  mesh.vertices.reserve(3 * all.triangles.size());
  for (const ExactTriangle& t : all.triangles) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vec2& uv : t.uv) mesh.vertices.push_back(all.point(t.cell, uv));
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  mesh = mesh::welded(mesh);
  std::erase_if(mesh.triangles, [](const Vec3i& t) { return t.x == t.y || t.y == t.z || t.z == t.x; });  // at poles
  return mesh;
}

}  // namespace

Mesh Surface::to_mesh(double tolerance, const Progress& progress) const {
  base::require_tolerance(tolerance);
  if (!(tolerance >= base::kMinToleranceOfSize * core_->scale))
    throw std::invalid_argument("tolerance must be at least 1e-10 of the largest coordinate, " +
                                base::in_figures(base::kMinToleranceOfSize * core_->scale) + " mm, not " +
                                base::in_figures(tolerance) +
                                "; move the surface nearer to the origin, or give a larger tolerance");
  if (std::any_of(core_->patches.begin(), core_->patches.end(), [](const Patch& p) { return !p.trims.empty(); }))
    return trimmed_mesh(*core_, tolerance - 4 * kWeld * core_->scale, progress);
  // Rounding, and edges that are joined within kWeld, use up a twentieth of the tolerance at most.
  return Tessellation(*core_, tolerance - 4 * kWeld * core_->scale).run(progress);
}

}  // namespace riffler::nurbs
