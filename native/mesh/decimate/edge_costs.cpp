#include "mesh/decimate/edge_costs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/float32.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

constexpr float kNever = std::numeric_limits<float>::infinity();

// Among edges of equal cost, as in a plane, short ones go first, which keeps triangles well shaped.
constexpr double kLength = 1e-8;
// Strength of the pull towards the edge's middle where the planes do not constrain the vertex, relative to their
// weight.
constexpr double kHold = 1e-5;

/// Scale from a quadric to a cost. Quadrics grow with the area they were summed over, so unscaled costs would spare
/// large triangles and collapse small features first. Measured: dividing by the square root of the area gives the
/// smallest maximum distance, better than dividing by the area (the mean squared distance) or not at all.
double scale_of(double weight) {
  return weight > 0 ? 1 / static_cast<double>(std::sqrt(static_cast<float>(weight))) : 1;
}

}  // namespace

EdgeCosts::EdgeCosts(const HalfEdges& half_edges, const Vec3& centre, double grain, const Progress& progress)
    : mesh_(half_edges.mesh),
      centre_(centre),
      noise_(grain * grain),
      kind_(mesh_.n_vertices(), Free),
      quadric_(mesh_.n_vertices()),
      cost_(mesh_.n_edges()) {
  base::parallel_for(
      mesh_.n_vertices(), 1 << 13,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const VertexHandle v(static_cast<int>(i));
          if (mesh_.is_boundary(v)) kind_[i] = Border;
          if (mesh_.status(v).locked()) kind_[i] = Fixed;
          add_faces_of(v);
        }
      },
      base::part(progress, 0, 0.5));
  base::parallel_for(
      mesh_.n_edges(), 1 << 14,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) refresh(EdgeHandle(static_cast<int>(i)));
      },
      base::part(progress, 0.5, 1));
}

void EdgeCosts::add_faces_of(VertexHandle v) {
  Quadric& sum = quadric_[v.idx()];
  const Vec3 p = to_vec3(mesh_.point(v));
  const HalfedgeHandle start = mesh_.halfedge_handle(v);
  HalfedgeHandle spoke = start;
  if (!start.is_valid()) return;
  const auto wall = [&](HalfedgeHandle border) {
    // A wall through the border, perpendicular to the triangle, keeps the border in place.
    const HalfedgeHandle inner = mesh_.opposite_halfedge_handle(border);
    const Vec3 a = to_vec3(mesh_.point(mesh_.from_vertex_handle(inner)));
    const Vec3 b = to_vec3(mesh_.point(mesh_.to_vertex_handle(inner)));
    const Vec3 c = to_vec3(mesh_.point(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(inner))));
    const Vec3 normal = glm::cross(b - a, glm::cross(b - a, c - a));
    const double length = glm::length(normal);
    if (length > 0) sum += Quadric(normal / length, a, glm::dot(b - a, b - a));
  };
  do {
    const HalfedgeHandle before = mesh_.prev_halfedge_handle(spoke);
    if (mesh_.is_boundary(spoke)) {
      wall(spoke), wall(before);
    } else {
      const Vec3 q = to_vec3(mesh_.point(mesh_.to_vertex_handle(spoke)));
      const Vec3 r = to_vec3(mesh_.point(mesh_.from_vertex_handle(before)));
      const Vec3 cross = glm::cross(q - p, r - p);
      const double length = glm::length(cross);
      if (length > 0) sum += Quadric(cross / length, p, length / 2);
    }
    spoke = mesh_.opposite_halfedge_handle(before);
  } while (spoke != start);
}

void EdgeCosts::refresh(EdgeHandle edge) {
  const CollapseTarget placement = place(edge, false);
  cost_[edge.idx()] = placement.half.is_valid() ? static_cast<float>(placement.cost) : kNever;
}

void EdgeCosts::put_off(EdgeHandle edge) {
  cost_[edge.idx()] = kNever;
}

/// A border vertex can only merge into a vertex of its border; a fixed vertex does not move.
CollapseTarget EdgeCosts::place(EdgeHandle edge, bool rounded) const {
  HalfedgeHandle half = mesh_.halfedge_handle(edge, 0);
  const VertexHandle a = mesh_.from_vertex_handle(half), b = mesh_.to_vertex_handle(half);
  Kind from = kind_[a.idx()], to = kind_[b.idx()];
  if (from == Free && to == Free) return free_place(half, rounded);
  bool from_may_go = from == Free, to_may_go = to == Free;
  if (from == Border || to == Border) {
    const bool along = mesh_.is_boundary(edge);
    from_may_go |= from == Border && along;
    to_may_go |= to == Border && along;
  }
  const Vec3 p = to_vec3(mesh_.point(a)), q = to_vec3(mesh_.point(b));
  const Quadric &qa = quadric_[a.idx()], &qb = quadric_[b.idx()];
  const double scale = scale_of(qa.weight() + qb.weight());
  const auto cost = [&](const Vec3& at) { return scale * std::max(0.0, qa(at) + qb(at)); };
  const double length2 = glm::dot(q - p, q - p), extra = kLength * length2 * length2;
  CollapseTarget best;
  if (from_may_go) best = {half, q, false, cost(q) + extra};
  if (to_may_go)
    if (const double other = cost(p) + extra; !from_may_go || other < best.cost)
      best = {mesh_.opposite_halfedge_handle(half), p, false, other};
  return best;
}

CollapseTarget EdgeCosts::free_place(HalfedgeHandle half, bool rounded) const {
  const VertexHandle a = mesh_.from_vertex_handle(half), b = mesh_.to_vertex_handle(half);
  const Vec3 p = to_vec3(mesh_.point(a)), q = to_vec3(mesh_.point(b)), middle = 0.5 * (p + q), arm = 0.5 * (q - p);
  Quadric sum = quadric_[a.idx()];
  sum += quadric_[b.idx()];
  const double weight = sum.weight(), scale = scale_of(weight), square = glm::dot(arm, arm);
  const double extra = 16 * kLength * square * square;
  // Relative to the middle of the edge: E(middle + d) = E(middle) + 2 g d + d A d.
  const Vec3 g = sum.times(middle) + sum.b;
  const double at_middle = glm::dot(middle, g + sum.b) + sum.c;
  const double slope = 2 * glm::dot(g, arm), at_end = at_middle + glm::dot(arm, sum.times(arm)) - std::abs(slope);
  const bool to_b = slope <= 0;
  // Rounding may make a sum slightly negative.
  CollapseTarget best{to_b ? half : mesh_.opposite_halfedge_handle(half), to_b ? q : p, false,
                      scale * std::max(0.0, at_end) + extra};
  if (!(weight > 0)) return best;
  const double hold = kHold * weight;
  const Vec3 d = sum.solved(-g, hold);
  const double square_d = glm::dot(d, d), at_lowest = at_middle + glm::dot(g, d) - hold * square_d;
  // If float32 cannot distinguish the place from an end, use the end: planes, and their edges, keep their vertices
  // bit-identical.
  if (!(at_end - std::max(0.0, at_lowest) > noise_ * weight) || !(square_d <= 4 * square)) return best;
  best.point = middle + d;
  if (rounded) best.point = geom::to_float32(best.point + centre_) - centre_;
  best.between = true, best.cost = scale * std::max(0.0, at_lowest) + extra;
  return best;
}

}  // namespace riffler::mesh
