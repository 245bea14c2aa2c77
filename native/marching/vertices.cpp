#include <algorithm>
#include <cmath>

#include "geom/parallel.hpp"
#include "marching/qef.hpp"
#include "marching/surface.hpp"

namespace riffler::marching {

namespace {

constexpr double kFlat = 0.9999;      // |mean normal|² above which the mean of the hits is the vertex
constexpr double kBroken = 0.05;      // residual, cells, above which hits contradict each other: stay in the cell
constexpr double kOnWall = 1e-6;      // cells; less than this outside is on the wall
constexpr double kClearlyOut = 1e-3;  // cells; a bound violated by more …
constexpr double kInset = 0.02;       // … is moved inwards by this, which keeps quads from folding at the wall

/// A cycle of a cell with its hits.
struct Cycle {
  Vec3i cell;
  Tangents hits;
  int faces = 0;      // bits of the cell's faces that its edges lie on
  bool alone = true;  // the cell has no other
  bool weak = false;  // one of its hits is
};

Box3 opened_box(double opening, int opened) {
  Box3 box{Vec3(0.0), Vec3(1.0)};
  for (int a = 0; a < 3; ++a) {
    if (opened >> (2 * a) & 1) box.lower[a] -= opening;
    if (opened >> (2 * a + 1) & 1) box.upper[a] += opening;
  }
  return box;
}

bool contains(const Box3& box, const Vec3& p) {
  return glm::all(glm::greaterThanEqual(p, box.lower)) && glm::all(glm::lessThanEqual(p, box.upper));
}

/// The best place in a box for a fit x that may lie outside it; off the bounds it clearly violates by `inset`.
Vec3 fit_in(const Qef& qef, const Vec3& x, Box3 box, double inset) {
  const Vec3 clamped = glm::clamp(x, box.lower, box.upper), excess = glm::abs(x - clamped);
  if (std::max({excess.x, excess.y, excess.z}) <= kOnWall) return clamped;
  for (int a = 0; a < 3; ++a) {
    if (x[a] > box.upper[a] + kClearlyOut) box.upper[a] -= inset;
    if (x[a] < box.lower[a] - kClearlyOut) box.lower[a] += inset;
  }
  return qef.solve_in(box);
}

/// A cell's place for `p`: inside, or outside where `opened` lets it. Inside it is safe whatever the neighbours do.
Vec3 place(const FloatGrid& grid, const Vec3i& cell, const Vec3& p, int opened) {
  return contains({Vec3(0.0), Vec3(1.0)}, p) ? grid.inside(cell, p) : grid.outside(cell, p, opened);
}

/// Mean of the edges' middles: it depends on signs only, and siblings' differ.
Vec3 anchor_of(const CellCase& entry, int cycle) {
  Vec3 sum{0, 0, 0};
  const int begin = entry.begin[cycle], end = entry.begin[cycle + 1];
  for (int n = begin; n < end; ++n) {
    const CellEdge& edge = kEdges[entry.edge[n]];
    sum += Vec3(edge.from[0], edge.from[1], edge.from[2]);
    sum[edge.axis] += 0.5;
  }
  return sum / static_cast<double>(end - begin);
}

/// Vertices of the cells of one plane.
class Plane {
 public:
  Plane(Surface& surface, int i)
      : surface_(surface),
        grid_(surface.grid),
        table_(case_table()),
        i_(i),
        vertex_(static_cast<std::int32_t>(surface.counts.vertex(i))) {}

  void run() {
    for (int j = 0; j < surface_.lattice.cells(1); ++j) {
      start_column(j);
      visit_cells(surface_.signs, i_, j, [&](int k, int code) {
        const CellCase& entry = entry_of(table_, surface_.signs, i_, j, k, code);
        find_edges(entry.crossed);
        const Vec3i cell{i_, j, k};
        for (int c = 0; c < entry.cycles; ++c) add_cycle(cell, entry, c);
        // The next cell up starts where this one's upper edges are.
        for (int n = 0; n < 8; ++n) cursor_[n] += entry.crossed >> kLower[n] & 1;
      });
    }
  }

  std::vector<Special> specials;
  std::vector<Vec3i> sharp;

 private:
  /// Edges of a cell that start in its lower layer of lattice points: one cursor each; and those of the upper layer,
  /// which come next in the same column.
  static constexpr int kLower[8] = {0, 1, 4, 6, 8, 9, 10, 11};

  void start_column(int j) {
    const Counts& counts = surface_.counts;
    const bool last = j + 1 == surface_.lattice.cells(1), end = i_ + 1 == surface_.lattice.cells(0);
    cursor_[0] = counts.edge(i_, j, 0);
    cursor_[1] = last ? 0 : counts.edge(i_, j + 1, 0);
    cursor_[2] = counts.edge(i_, j, 1);
    cursor_[3] = end ? 0 : counts.edge(i_ + 1, j, 1);
    cursor_[4] = counts.edge(i_, j, 2);
    cursor_[5] = end ? 0 : counts.edge(i_ + 1, j, 2);
    cursor_[6] = last ? 0 : counts.edge(i_, j + 1, 2);
    cursor_[7] = last || end ? 0 : counts.edge(i_ + 1, j + 1, 2);
  }

  void find_edges(int crossed) {
    edge_[0] = cursor_[0], edge_[1] = cursor_[1], edge_[4] = cursor_[2], edge_[6] = cursor_[3];
    edge_[2] = cursor_[0] + (crossed & 1), edge_[3] = cursor_[1] + (crossed >> 1 & 1);
    edge_[5] = cursor_[2] + (crossed >> 4 & 1), edge_[7] = cursor_[3] + (crossed >> 6 & 1);
    for (int n = 0; n < 4; ++n) edge_[8 + n] = cursor_[4 + n];
  }

  void add_cycle(const Vec3i& cell, const CellCase& entry, int c) {
    const int begin = entry.begin[c], end = entry.begin[c + 1];
    // One sum an axis, of places and normals side by side (floats do: what matters here is a mean of a few).
    float sum[3][4] = {};
    for (int n = begin; n < end; ++n) {
      const CellEdge& edge = kEdges[entry.edge[n]];
      const std::size_t quad = edge_[entry.edge[n]];
      const bool rising = !(entry.code >> edge.low & 1);
      surface_.set_corner(quad, rising ? (4 - edge.slot) & 3 : edge.slot, vertex_);
      const Hit& hit = surface_.hits[quad];
      float* const s = sum[edge.axis];
      s[0] += hit.place, s[1] += hit.normal[0], s[2] += hit.normal[1], s[3] += hit.normal[2];
    }
    const double count = end - begin;
    const double along[3] = {sum[0][0], sum[1][0], sum[2][0]};
    double normal[3];
    for (int a = 0; a < 3; ++a) normal[a] = static_cast<double>(sum[0][a + 1]) + sum[1][a + 1] + sum[2][a + 1];
    // At most four edges an axis, places from −½ to 1½: only a weak one makes a sum so small.
    const bool weak = std::min({along[0], along[1], along[2]}) < -Hit::kWeak / 2;
    const double agreement = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
    const auto& from = entry.from[c];
    const Vec3 mean = Vec3(from[0] + along[0], from[1] + along[1], from[2] + along[2]) / count;
    if (!weak && entry.cycles == 1 && agreement > kFlat * count * count && contains({Vec3(0.0), Vec3(1.0)}, mean))
        [[likely]]
      surface_.mesh.vertices[vertex_] = grid_.inside(cell, mean);
    else
      fit(gather(cell, entry, c), anchor_of(entry, c));
    ++vertex_;
  }

  Cycle gather(const Vec3i& cell, const CellCase& entry, int c) const {
    Cycle cycle;
    cycle.cell = cell, cycle.alone = entry.cycles == 1, cycle.faces = entry.faces[c];
    for (int n = entry.begin[c]; n < entry.begin[c + 1]; ++n) {
      const CellEdge& edge = kEdges[entry.edge[n]];
      const Hit& hit = surface_.hits[edge_[entry.edge[n]]];
      Vec3 p{edge.from[0], edge.from[1], edge.from[2]};
      p[edge.axis] += hit.t();
      cycle.hits.point[cycle.hits.count] = p;
      cycle.hits.normal[cycle.hits.count++] = {hit.normal[0], hit.normal[1], hit.normal[2]};
      cycle.weak |= hit.weak();
    }
    return cycle;
  }

  void fit(const Cycle& cycle, const Vec3& anchor) {
    const Qef qef(cycle.hits);
    const Vec3 x = qef.solve();
    const bool in_cell = contains({Vec3(0.0), Vec3(1.0)}, x);
    if (in_cell && cycle.alone && !cycle.weak) {
      surface_.mesh.vertices[vertex_] = grid_.inside(cycle.cell, x);
      if (!qef.sharp()) return;
      surface_.marks[vertex_] = kSharp;
      sharp.push_back(cycle.cell);
      return;
    }
    const bool stay = !cycle.alone || cycle.weak || qef.residual(x) > kBroken;
    const double opening = stay ? 0 : grid_.opening();
    // Beyond a face that no edge of the cycle lies on, the vertex still keeps to its quadrant round every edge.
    const int opened = opening > 0 ? ~cycle.faces & 63 : 0;
    const Vec3 safe = place(grid_, cycle.cell, fit_in(qef, x, opened_box(opening, opened), kInset), opened);
    Vec3& vertex = surface_.mesh.vertices[vertex_] = safe;
    Vec3 candidate = safe;
    if (opening > 0 && !contains(opened_box(opening, opened), x))
      candidate = place(grid_, cycle.cell, fit_in(qef, x, opened_box(opening, 63), 0), 63);
    if (!cycle.alone) candidate = vertex = apart_from_siblings(cycle.cell, vertex);
    surface_.marks[vertex_] =
        static_cast<std::uint8_t>(candidate == safe || !cycle.alone ? kSpecial : kSpecial | kCandidate);
    specials.push_back({vertex_, cycle.cell, anchor, candidate});
  }

  /// Vertices of one cell (all inside it) that would coincide: the later one gives way.
  Vec3 apart_from_siblings(const Vec3i& cell, const Vec3& v) const {
    return grid_.free_place(cell, v, [&](const Vec3& place) {
      for (auto s = specials.rbegin(); s != specials.rend() && s->cell == cell; ++s)
        if (surface_.mesh.vertices[s->vertex] == place) return true;
      return false;
    });
  }

  Surface& surface_;
  const FloatGrid& grid_;
  const CaseTable& table_;
  int i_;
  std::int32_t vertex_;
  std::size_t cursor_[8], edge_[12];
};

template <class T>
std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  std::vector<T> all;
  all.reserve(count);
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

Special& Surface::special(std::int32_t vertex) {
  return *std::lower_bound(specials.begin(), specials.end(), vertex,
                           [](const Special& s, std::int32_t v) { return s.vertex < v; });
}

void place_vertices(Surface& surface, const Progress& progress) {
  surface.mesh.vertices.resize(surface.counts.vertices());
  surface.mesh.triangles.resize(2 * surface.counts.edges());
  surface.marks.assign(surface.counts.vertices(), 0);
  std::vector<std::vector<Special>> specials(surface.lattice.cells(0));
  std::vector<std::vector<Vec3i>> sharp(specials.size());
  parallel_for(
      specials.size(), 4,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          Plane plane(surface, static_cast<int>(i));
          plane.run();
          specials[i] = std::move(plane.specials), sharp[i] = std::move(plane.sharp);
        }
      },
      progress);
  surface.specials = joined(specials), surface.sharp = joined(sharp);
}

}  // namespace riffler::marching
