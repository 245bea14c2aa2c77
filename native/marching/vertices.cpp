#include "marching/vertices.hpp"

#include <algorithm>
#include <cmath>

#include "marching/surface.hpp"

namespace riffler::marching {

namespace {

constexpr double kBroken = 0.05;      // residual, cells, above which hits contradict each other: stay in the cell
constexpr double kExact = 0.005;      // residual, cells, up to which vertices may go as far as the grid allows
constexpr double kBent = 0.49;        // cells, how far they may leave their cell if the residual is larger
constexpr double kOnWall = 1e-6;      // cells; less than this outside is on the wall
constexpr double kClearlyOut = 1e-3;  // cells; a bound violated by more than this …
constexpr double kInset = 0.02;       // … is moved inwards by this, which keeps quads from folding at the wall

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

/// The best place in a box for a fit x that may lie outside it; clearly violated bounds are moved in by `inset`.
Vec3 fit_in(const Qef& qef, const Vec3& x, Box3 box, double inset) {
  const Vec3 clamped = glm::clamp(x, box.lower, box.upper), excess = glm::abs(x - clamped);
  if (std::max({excess.x, excess.y, excess.z}) <= kOnWall) return clamped;
  for (int a = 0; a < 3; ++a) {
    if (x[a] > box.upper[a] + kClearlyOut) box.upper[a] -= inset;
    if (x[a] < box.lower[a] - kClearlyOut) box.lower[a] += inset;
  }
  return qef.solve_in(box);
}

/// A cell's place for `p`: inside, or outside where `opened` allows it. Inside it is safe for any choice of the
/// neighbours.
Vec3 place(const FloatGrid& grid, const Vec3i& cell, const Vec3& p, int opened) {
  const Vec3 in_box = grid.in_box(cell, p);
  return FloatGrid::in_cell(in_box) ? grid.inside(cell, in_box) : grid.outside(cell, in_box, opened);
}

/// Mean of the edges' midpoints. It depends on signs only, and siblings have different ones.
Vec3 anchor_of(const Cycle& cycle) {
  Vec3 sum{0, 0, 0};
  const CellCase& entry = cycle.entry;
  const int begin = entry.begin[cycle.number], end = entry.begin[cycle.number + 1];
  for (int n = begin; n < end; ++n) {
    const CellEdge& edge = kEdges[entry.edge[n]];
    sum += Vec3(edge.from[0], edge.from[1], edge.from[2]);
    sum[edge.axis] += 0.5;
  }
  return sum / static_cast<double>(end - begin);
}

Tangents gather(const Cycle& cycle, bool& weak) {
  Tangents hits;
  const int begin = cycle.entry.begin[cycle.number], end = cycle.entry.begin[cycle.number + 1];
  for (int e = begin; e < end; ++e) {
    const CellEdge& edge = kEdges[cycle.entry.edge[e]];
    const Hit& hit = *cycle.hits[e - begin];
    Vec3 p{edge.from[0], edge.from[1], edge.from[2]};
    p[edge.axis] += hit.t();
    hits.point[hits.count] = p;
    hits.normal[hits.count++] = {hit.normal[0], hit.normal[1], hit.normal[2]};
    weak |= hit.weak();
  }
  return hits;
}

/// Keeps vertices of one cell (all inside it) from coinciding: the later one is moved.
Vec3 apart_from_siblings(const FloatGrid& grid, const Vec3i& cell, const Vec3& v, const std::vector<Vec3>& siblings) {
  return grid.free_place(
      cell, v, [&](const Vec3& place) { return std::find(siblings.begin(), siblings.end(), place) != siblings.end(); });
}

}  // namespace

Placed place_vertex(const FloatGrid& grid, const Cycle& cycle, const Siblings& siblings) {
  bool weak = false;
  const Tangents hits = gather(cycle, weak);
  const Qef qef(hits);
  const Vec3 x = qef.solve();
  const bool alone = cycle.entry.cycles == 1;
  if (alone && !weak && FloatGrid::in_cell(x))
    return {grid.inside(cycle.cell, x), static_cast<std::uint8_t>(qef.bend() == Bend::Smooth ? 0 : kSharp), {}, {}};
  const double residual = qef.residual(x);
  const bool stay = siblings.left || weak || residual > kBroken;
  const double opening = stay ? 0 : residual > kExact ? std::min(kBent, grid.opening()) : grid.opening();
  // Beyond a face without edges of the cycle, the vertex still keeps to its quadrant around every edge.
  const int opened = opening > 0 && alone ? ~cycle.entry.faces[cycle.number] & 63 : 0;
  Placed out;
  out.place = place(grid, cycle.cell, fit_in(qef, x, opened_box(opening, opened), kInset), opened);
  out.marks = kSpecial;
  if (!alone) out.place = apart_from_siblings(grid, cycle.cell, out.place, siblings.places);
  out.anchor = anchor_of(cycle);
  out.other = out.place;
  if (opening > 0 && !contains(opened_box(opening, opened), x)) {
    const Vec3 fit = fit_in(qef, x, opened_box(opening, 63), 0);
    if (alone || !FloatGrid::in_cell(fit)) out.other = place(grid, cycle.cell, fit, 63);
    if (out.other != out.place) out.marks = kSpecial | kCandidate;
  }
  return out;
}

}  // namespace riffler::marching
