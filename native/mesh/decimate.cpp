#include "mesh/decimate.hpp"

#include <OpenMesh/Tools/Utils/HeapT.hh>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "geom/float32.hpp"
#include "mesh/collapse.hpp"
#include "mesh/half_edge.hpp"
#include "mesh/quadric.hpp"
#include "mesh/tolerance_check.hpp"

namespace riffler {

namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// The coordinates that a binary STL will hold, about the box's centre: what has area and does not fold here does not
/// in the file either, and quadrics keep their digits far from the origin.
Mesh rounded(const Mesh& mesh) {
  const Box3 box = bounds(mesh);
  const Vec3 centre = to_float32(0.5 * box.lower + 0.5 * box.upper);
  Mesh result = mesh;
  for (Vec3& v : result.vertices) v = to_float32(v) - centre;
  return result;
}

/// What each vertex would best collapse into, cheapest first.
class Queue {
 public:
  explicit Queue(HalfEdgeMesh& mesh) : mesh_(mesh), best_(mesh.n_vertices()), heap_(Interface{&best_}) {
    quadrics_.resize(mesh.n_vertices());
    for (const FaceHandle face : mesh.faces()) add_face(face);
    heap_.reserve(mesh.n_vertices());
    for (const VertexHandle v : mesh.vertices()) refresh(v);
  }

  bool empty() const { return heap_.empty(); }
  std::size_t size() const { return heap_.size(); }
  HalfedgeHandle front() const { return best_[heap_.front().idx()].target; }

  /// Takes the front's next best target instead.
  void reject() {
    const VertexHandle v = heap_.front();
    choose(v, best_[v.idx()].cost, best_[v.idx()].target.idx());
  }
  /// Starts again with all targets of v.
  void refresh(VertexHandle v) { choose(v, -1, -1); }
  void remove(VertexHandle v) {
    if (heap_.is_stored(v)) heap_.remove(v);
  }
  void merge(VertexHandle gone, VertexHandle into) { quadrics_[into.idx()] += quadrics_[gone.idx()]; }

 private:
  struct Best {
    double cost = 0;
    HalfedgeHandle target;
    int position = -1;
  };
  struct Interface {
    std::vector<Best>* best;
    bool less(VertexHandle a, VertexHandle b) const {
      const Best &x = (*best)[a.idx()], &y = (*best)[b.idx()];
      return x.cost != y.cost ? x.cost < y.cost : a.idx() < b.idx();
    }
    bool greater(VertexHandle a, VertexHandle b) const { return less(b, a); }
    int get_heap_position(VertexHandle v) const { return (*best)[v.idx()].position; }
    void set_heap_position(VertexHandle v, int position) { (*best)[v.idx()].position = position; }
  };

  void add_face(FaceHandle face) {
    HalfedgeHandle half = mesh_.halfedge_handle(face);
    Vec3 p[3];
    VertexHandle v[3];
    for (int k = 0; k < 3; ++k, half = mesh_.next_halfedge_handle(half))
      v[k] = mesh_.from_vertex_handle(half), p[k] = to_vec3(mesh_.point(v[k]));
    const Vec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(cross);
    if (!(length > 0)) return;
    const Quadric quadric(cross / length, p[0], length / 2);
    for (const VertexHandle corner : v) quadrics_[corner.idx()] += quadric;
    for (int k = 0; k < 3; ++k, half = mesh_.next_halfedge_handle(half)) {
      if (!mesh_.is_boundary(mesh_.opposite_halfedge_handle(half))) continue;
      // A wall through the border, square to the triangle, keeps the border in place.
      const Vec3 edge = p[(k + 1) % 3] - p[k];
      const double edge_length = glm::length(edge);
      if (!(edge_length > 0)) continue;
      const Quadric wall(glm::cross(edge, cross) / (edge_length * length), p[k], edge_length * edge_length);
      quadrics_[v[k].idx()] += wall, quadrics_[v[(k + 1) % 3].idx()] += wall;
    }
  }

  /// The cheapest target of v that comes after (cost, half-edge); v leaves the heap if there is none.
  void choose(VertexHandle v, double after_cost, int after) {
    Best& best = best_[v.idx()];
    best.cost = std::numeric_limits<double>::infinity();
    best.target = HalfedgeHandle();
    if (!mesh_.status(v).locked())
      for (const HalfedgeHandle half : mesh_.voh_range(v)) {
        const double cost = cost_of(half);
        if ((cost > after_cost || (cost == after_cost && half.idx() > after)) &&
            (cost < best.cost || (cost == best.cost && half.idx() < best.target.idx())))
          best.cost = cost, best.target = half;
      }
    if (!best.target.is_valid())
      remove(v);
    else if (heap_.is_stored(v))
      heap_.update(v);
    else
      heap_.insert(v);
  }

  /// Distance from the planes of both ends, squared, times area, and a little for length: among equals, as everywhere
  /// in a plane, short edges go first and the triangles stay well shaped.
  double cost_of(HalfedgeHandle half) const {
    const VertexHandle from = mesh_.from_vertex_handle(half), to = mesh_.to_vertex_handle(half);
    const Vec3 p = to_vec3(mesh_.point(to)), edge = p - to_vec3(mesh_.point(from));
    const double length2 = glm::dot(edge, edge);
    // Rounding may take the sum a little below 0.
    return std::max(0.0, quadrics_[from.idx()](p) + quadrics_[to.idx()](p)) + 1e-8 * length2 * length2;
  }

  HalfEdgeMesh& mesh_;
  std::vector<Quadric> quadrics_;
  std::vector<Best> best_;
  OpenMesh::Utils::HeapT<VertexHandle, Interface> heap_;
};

/// What is left of the tolerance for the rounded surface, so that the unrounded one keeps to it.
double left_after_rounding(double tolerance, const Mesh& mesh) {
  double largest = 0;
  for (const Vec3& v : mesh.vertices) largest = std::max(largest, glm::length(to_float32(v) - v));
  return std::max(0.0, tolerance - 2 * largest);
}

void check_limits(const DecimateLimits& limits) {
  if (!limits.triangles && !limits.tolerance) throw std::invalid_argument("decimate needs triangles or tolerance");
  if (limits.tolerance && !(*limits.tolerance >= 0 && std::isfinite(*limits.tolerance)))
    throw std::invalid_argument("tolerance must be finite and not negative, not " + std::to_string(*limits.tolerance));
}

}  // namespace

Mesh decimate(const Mesh& mesh, const DecimateLimits& limits, const Progress& progress) {
  check_limits(limits);
  validate(mesh);
  const std::size_t target = limits.triangles.value_or(0);
  if (mesh.triangles.size() <= target || mesh.empty()) return mesh;

  const Mesh local = rounded(mesh);
  HalfEdges half_edges(local);
  HalfEdgeMesh& half_mesh = half_edges.mesh;
  std::unique_ptr<ToleranceCheck> distance;
  if (limits.tolerance)
    distance = std::make_unique<ToleranceCheck>(half_edges, left_after_rounding(*limits.tolerance, mesh));
  report(progress, 0.1);
  Queue queue(half_mesh);
  report(progress, 0.2);

  const std::size_t start = half_mesh.n_faces(), goal = start > target ? start - target : 1;
  Collapse collapse(half_mesh);
  std::size_t left = start;
  for (std::size_t step = 0; left > target && !queue.empty(); ++step) {
    if (step % 256 == 0) report(progress, 0.2 + 0.8 * static_cast<double>(start - left) / static_cast<double>(goal));
    if (!collapse.prepare(queue.front()) || (distance && !distance->allow(collapse))) {
      queue.reject();
      continue;
    }
    queue.remove(collapse.from());
    queue.merge(collapse.from(), collapse.to());
    left -= collapse.faces_lost();
    collapse.commit();
    if (distance) distance->commit(collapse);
    queue.refresh(collapse.to());
    for (const VertexHandle v : half_mesh.vv_range(collapse.to())) queue.refresh(v);
  }
  return half_edges.to_mesh(mesh);
}

}  // namespace riffler
