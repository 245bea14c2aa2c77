#include "mesh/collapse.hpp"

#include <algorithm>

namespace riffler {

namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;

// A new triangle's normal may differ from that of the one it takes the place of by 78°.
constexpr double kTurn = 0.2;
// Neighbours may not come nearer to lying on each other than 154°; -0.99999 counts as a fold.
constexpr double kFold = -0.9;
// Twice the area over the square of the longest edge.
constexpr double kThin = 1e-4;

double shape(const Vec3& cross, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
  return longest > 0 ? glm::length(cross) / longest : 0;
}

bool opposed(const Vec3& a, const Vec3& b) {
  return glm::dot(a, b) < kFold * glm::length(a) * glm::length(b);
}

}  // namespace

bool Collapse::prepare(HalfedgeHandle half) {
  half_ = half;
  from_ = mesh_.from_vertex_handle(half), to_ = mesh_.to_vertex_handle(half);
  if (mesh_.status(from_).locked() || !keeps_borders()) return false;
  gather();
  return keeps_shape() && keeps_manifold();
}

/// A border vertex stays on its border, two borders do not meet, and no triangle hangs by one vertex.
bool Collapse::keeps_borders() const {
  const HalfedgeHandle back = mesh_.opposite_halfedge_handle(half_);
  const bool along = mesh_.is_boundary(half_) || mesh_.is_boundary(back);
  if (mesh_.is_boundary(from_) && !along) return false;
  for (const HalfedgeHandle side : {half_, back}) {
    if (mesh_.is_boundary(side)) continue;
    const HalfedgeHandle next = mesh_.next_halfedge_handle(side), last = mesh_.next_halfedge_handle(next);
    if (mesh_.is_boundary(mesh_.opposite_halfedge_handle(next)) &&
        mesh_.is_boundary(mesh_.opposite_halfedge_handle(last)))
      return false;
  }
  return true;
}

/// The link condition (Dey, Edelsbrunner, Guha & Nekhayev, Publ. Inst. Math. 66 (1999) 23): the two ends have no common
/// neighbours but the tips of the edge's triangles. The tetrahedron meets it and would become two triangles back to
/// back, but these are a fold. (OpenMesh's is_collapse_ok asks the same, but allocates memory on each call.)
bool Collapse::keeps_manifold() {
  ++stamp_;
  for (const HalfedgeHandle spoke : ring_) stamps_[mesh_.to_vertex_handle(spoke).idx()] = stamp_;
  int common = 0;
  for (const OpenMesh::VertexHandle v : mesh_.vv_range(to_)) common += stamps_[v.idx()] == stamp_ ? 1 : 0;
  return common == lost_;
}

void Collapse::gather() {
  old_ = to_vec3(mesh_.point(from_)), new_ = to_vec3(mesh_.point(to_));
  border_ = mesh_.is_boundary(from_);
  ring_.clear(), faces_.clear(), points_.clear();
  // OpenMesh keeps the outgoing border half-edge at a border vertex; counter-clockwise it is the last.
  HalfedgeHandle spoke = half_;
  if (border_) spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(mesh_.halfedge_handle(from_)));
  const HalfedgeHandle start = spoke;
  do {
    ring_.push_back(spoke);
    points_.push_back(to_vec3(mesh_.point(mesh_.to_vertex_handle(spoke))));
    if (mesh_.is_boundary(spoke)) break;
    faces_.push_back(mesh_.face_handle(spoke));
    spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(spoke));
  } while (spoke != start);
  target_ = ring_.front() == half_ ? 0 : ring_size() - 1;
  first_ = target_ == 0 ? 1 : 0;
  last_ = old_faces() - (border_ && target_ == 0 ? 1 : 2);
  lost_ = border_ ? 1 : 2;
}

bool Collapse::keeps_shape() {
  if (first_ > last_) return false;  // a border triangle of its own would just go
  const int n = old_faces();
  old_cross_.resize(n), new_cross_.resize(n);
  double worst = 1;
  for (int i = 0; i < n; ++i) {
    old_cross_[i] = glm::cross(ring(i) - old_, ring(i + 1) - old_);
    new_cross_[i] = Vec3(0);
    worst = std::min(worst, shape(old_cross_[i], old_, ring(i), ring(i + 1)));
  }
  for (int i = first_; i <= last_; ++i) {
    const Vec3& was = old_cross_[i];
    const Vec3& is = new_cross_[i] = glm::cross(ring(i) - new_, ring(i + 1) - new_);
    const double thin = shape(is, new_, ring(i), ring(i + 1));
    // A mesh with slivers may keep them, but not get worse ones.
    if (!(thin > kThin || (thin > 0 && thin > worst))) return false;
    if (was != Vec3(0) && glm::dot(was, is) < kTurn * glm::length(was) * glm::length(is)) return false;
  }
  for (int i = first_; i <= last_; ++i) {
    if (folds(i, mesh_.next_halfedge_handle(ring_[i]))) return false;
    if (i > first_ && opposed(new_cross_[i - 1], new_cross_[i])) return false;
  }
  // Across the edges that vanishing triangles had in common with what lies beyond them.
  if (first_ > 0 && folds(first_, mesh_.next_halfedge_handle(ring_[0]))) return false;
  return last_ + 1 >= n || !folds(last_, mesh_.next_halfedge_handle(ring_[last_ + 1]));
}

/// Whether new face i would lie on the face beyond the half-edge `across` of the old fan.
bool Collapse::folds(int i, HalfedgeHandle across) const {
  const HalfedgeHandle twin = mesh_.opposite_halfedge_handle(across);
  if (mesh_.is_boundary(twin)) return false;
  const Vec3 a = to_vec3(mesh_.point(mesh_.from_vertex_handle(twin)));
  const Vec3 b = to_vec3(mesh_.point(mesh_.to_vertex_handle(twin)));
  const Vec3 c = to_vec3(mesh_.point(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(twin))));
  return opposed(new_cross_[i], glm::cross(b - a, c - a));
}

}  // namespace riffler
