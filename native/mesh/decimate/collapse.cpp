#include "mesh/decimate/collapse.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/fold.hpp"

namespace riffler::mesh {

namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

// Limit of the change of a triangle's normal: cosine of 78°.
constexpr double kTurn = 0.2;
// Minimum of twice the area over the square of the longest edge.
constexpr double kThin = 1e-4;
// Maximum number of half-edges at a vertex. A collapse visits all of them, so a mesh that is one large fan would take
// quadratic time; the edges around such a fan collapse first.
constexpr int kMaxSpokes = 512;

bool turned(const Vec3& was, const Vec3& is) {
  const double dot = glm::dot(was, is);
  return was != Vec3(0) &&
         (dot < 0 || dot * dot < kTurn * kTurn * geom::squared_length(was) * geom::squared_length(is));
}

}  // namespace

bool Collapse::prepare(const CollapseTarget& placement) {
  half_ = placement.half;
  from_ = mesh_.from_vertex_handle(half_), to_ = mesh_.to_vertex_handle(half_);
  from_point_ = to_vec3(mesh_.point(from_)), to_point_ = to_vec3(mesh_.point(to_));
  new_ = placement.point, between_ = placement.between;
  border_ = mesh_.is_boundary(from_), to_border_ = mesh_.is_boundary(to_);
  lost_ = border_ ? 1 : 2;
  if (!has_few_spokes(from_) || !has_few_spokes(to_)) return false;
  if (border_ && !keeps_borders()) return false;
  ring_.clear(), faces_.clear();
  if (between_)
    gather_both_fans();
  else
    gather_fan();
  return first_ <= last_ && keeps_manifold() && keeps_shape() && keeps_angles();
}

bool Collapse::has_few_spokes(VertexHandle v) const {
  const HalfedgeHandle start = mesh_.halfedge_handle(v);
  HalfedgeHandle spoke = start;
  for (int n = 0; n < kMaxSpokes; ++n) {
    spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(spoke));
    if (spoke == start) return true;
  }
  return false;
}

/// A border vertex stays on its border, two borders do not meet, and no triangle is left hanging by one vertex.
bool Collapse::keeps_borders() const {
  const HalfedgeHandle back = mesh_.opposite_halfedge_handle(half_);
  const bool along = mesh_.is_boundary(half_) || mesh_.is_boundary(back);
  if (border_ && !along) return false;
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
/// neighbours but the tips of the edge's triangles. A tetrahedron satisfies it and would become two triangles back to
/// back, but the fold test rejects that. (OpenMesh's is_collapse_ok tests the same, but allocates memory on each call.)
bool Collapse::keeps_manifold() {
  if (between_) return ring_is_simple();
  marked_.clear();
  for (const Place& place : ring_) marked_.push_back(place.vertex.idx());
  std::sort(marked_.begin(), marked_.end());
  int common = 0;
  for_each_spoke(to_, [&](HalfedgeHandle spoke) {
    common += std::binary_search(marked_.begin(), marked_.end(), mesh_.to_vertex_handle(spoke).idx()) ? 1 : 0;
  });
  return common == lost_;
}

/// Whether all vertices of the ring are different: the link condition if the ring surrounds both ends.
bool Collapse::ring_is_simple() {
  if (ring_.size() <= 24) {
    for (std::size_t i = 1; i < ring_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (ring_[i].vertex == ring_[j].vertex) return false;
    return true;
  }
  marked_.clear();
  for (const Place& place : ring_) marked_.push_back(place.vertex.idx());
  std::sort(marked_.begin(), marked_.end());
  return std::adjacent_find(marked_.begin(), marked_.end()) == marked_.end();
}

void Collapse::add_spoke(HalfedgeHandle spoke) {
  const VertexHandle v = mesh_.to_vertex_handle(spoke);
  ring_.push_back({spoke, v, to_vec3(mesh_.point(v))});
}

/// Adds the face to the left of `spoke`, which is (apex, a, b).
void Collapse::add_face(HalfedgeHandle spoke, const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 cross = glm::cross(a - apex, b - apex);
  const double longest =
      std::max({geom::squared_length(a - apex), geom::squared_length(b - a), geom::squared_length(apex - b)});
  faces_.push_back({mesh_.face_handle(spoke), mesh_.next_halfedge_handle(spoke), cross, Vec3(0), longest});
}

void Collapse::gather_fan() {
  // OpenMesh stores the outgoing border half-edge at a border vertex, which is the last one counter-clockwise.
  HalfedgeHandle spoke = half_;
  if (border_) spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(mesh_.halfedge_handle(from_)));
  const HalfedgeHandle start = spoke;
  do {
    add_spoke(spoke);
    if (mesh_.is_boundary(spoke)) break;
    spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(spoke));
  } while (spoke != start);
  const int n = ring_size() - (border_ ? 1 : 0);
  for (int i = 0; i < n; ++i) add_face(ring_[i].spoke, from_point_, ring(i), ring(i + 1));
  target_ = ring_.front().spoke == half_ ? 0 : ring_size() - 1;
  first_ = target_ == 0 ? 1 : 0;
  last_ = n - (border_ && target_ == 0 ? 1 : 2);
}

void Collapse::gather_both_fans() {
  const HalfedgeHandle back = mesh_.opposite_halfedge_handle(half_);
  const auto walk = [&](HalfedgeHandle start) {
    HalfedgeHandle spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(start));
    for (;;) {
      const HalfedgeHandle next = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(spoke));
      if (next == start) return;  // the face of the last spoke vanishes
      add_spoke(spoke);
      spoke = next;
    }
  };
  walk(half_);
  const int turn = ring_size();
  walk(back);
  for (int i = 0; i < ring_size(); ++i)
    add_face(ring_[i].spoke, i < turn ? from_point_ : to_point_, ring(i), ring(i + 1));
  first_ = 0, last_ = ring_size() - 1, target_ = -1;
  if (ring_size() < 3) return void(last_ = -1);
  add_face(half_, from_point_, to_point_, ring(0));
  add_face(back, to_point_, from_point_, ring(turn));
}

/// Whether every new face has area and keeps its side up.
bool Collapse::keeps_shape() {
  for (int i = first_; i <= last_; ++i) {
    Face& face = faces_[i];
    const Vec3 a = ring(i) - new_, b = ring(i + 1) - new_;
    face.new_cross = glm::cross(a, b);
    if (turned(face.old_cross, face.new_cross)) return false;
    const double longest = std::max({geom::squared_length(a), geom::squared_length(b), geom::squared_length(b - a)}),
                 area = geom::squared_length(face.new_cross);
    if (area > kThin * kThin * longest * longest) continue;
    // A mesh with slivers may keep them, but must not get worse ones.
    double worst = 1;
    for (const Face& old : faces_)
      worst = std::min(worst, old.longest > 0 ? glm::length(old.old_cross) / old.longest : 0);
    if (!(area > 0 && std::sqrt(area) / longest > worst)) return false;
  }
  return true;
}

/// Whether no two neighbours fold onto each other.
bool Collapse::keeps_angles() const {
  for (int i = first_; i <= last_; ++i) {
    if (folds(i, i)) return false;
    if (i > first_ && opposed(faces_[i - 1].new_cross, faces_[i].new_cross)) return false;
  }
  if (between_) return !opposed(faces_[last_].new_cross, faces_[first_].new_cross);
  // Across the edges that vanishing triangles shared with their neighbours.
  if (first_ > 0 && folds(first_, 0)) return false;
  return last_ + 1 >= old_faces() || !folds(last_, last_ + 1);
}

/// Whether new face i would fold onto the face beyond the edge from ring(j) to ring(j + 1).
bool Collapse::folds(int i, int j) const {
  const HalfedgeHandle twin = mesh_.opposite_halfedge_handle(faces_[j].outer);
  if (mesh_.is_boundary(twin)) return false;
  const Vec3 tip = to_vec3(mesh_.point(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(twin))));
  return opposed(faces_[i].new_cross, glm::cross(ring(j) - ring(j + 1), tip - ring(j + 1)));
}

/// Does the same as OpenMesh's collapse, without its search for border half-edges at every vertex (quadratic in the
/// size of a fan) and without its checked access. Together they took longer than the rest of a collapse.
void Collapse::commit() {
  mesh_.set_point(to_, to_openmesh(new_));
  const HalfedgeHandle back = mesh_.opposite_halfedge_handle(half_);
  HalfedgeHandle spoke = half_;
  do {
    const HalfedgeHandle in = mesh_.opposite_halfedge_handle(spoke);
    mesh_.set_vertex_handle(in, to_);
    spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(spoke));
  } while (spoke != half_);
  const bool left_open = mesh_.is_boundary(half_), right_open = mesh_.is_boundary(back);
  const HalfedgeHandle left = mesh_.next_halfedge_handle(half_), left_gone = mesh_.prev_halfedge_handle(half_);
  const HalfedgeHandle right_gone = mesh_.next_halfedge_handle(back), right = mesh_.prev_halfedge_handle(back);
  // OpenMesh stores at a border vertex the border half-edge that starts there. If `to` is on the border it keeps its
  // own half-edge, unless that edge vanishes; then the next one along the border replaces it.
  if (right_open || !to_border_) mesh_.set_halfedge_handle(to_, right_open ? right_gone : left);
  if (left_open) mesh_.set_next_halfedge_handle(left_gone, left);
  if (right_open) mesh_.set_next_halfedge_handle(right, right_gone);
  if (!left_open) close_side(left, left_gone);
  if (!right_open) close_side(right, right_gone);
  mesh_.status(mesh_.edge_handle(half_)).set_deleted(true);
  mesh_.status(from_).set_deleted(true);
}

/// The face with the half-edges `kept` and `gone` vanishes: `kept` replaces the half-edge across `gone`, in its face or
/// its border.
void Collapse::close_side(HalfedgeHandle kept, HalfedgeHandle gone) {
  const HalfedgeHandle across = mesh_.opposite_halfedge_handle(gone);
  const HalfedgeHandle next = mesh_.next_halfedge_handle(across), before = mesh_.prev_halfedge_handle(across);
  const FaceHandle face = mesh_.face_handle(across), vanishing = mesh_.face_handle(kept);
  mesh_.set_next_halfedge_handle(kept, next), mesh_.set_next_halfedge_handle(before, kept);
  mesh_.set_face_handle(kept, face);
  if (face.is_valid() && mesh_.halfedge_handle(face) == across) mesh_.set_halfedge_handle(face, kept);
  const bool towards = mesh_.to_vertex_handle(kept) == to_;
  const VertexHandle tip = towards ? mesh_.from_vertex_handle(kept) : mesh_.to_vertex_handle(kept);
  if (mesh_.edge_handle(mesh_.halfedge_handle(tip)) == mesh_.edge_handle(gone))
    mesh_.set_halfedge_handle(tip, towards ? kept : mesh_.opposite_halfedge_handle(kept));
  if (mesh_.halfedge_handle(to_) == across) mesh_.set_halfedge_handle(to_, kept);
  mesh_.status(vanishing).set_deleted(true);
  mesh_.status(mesh_.edge_handle(gone)).set_deleted(true);
}

}  // namespace riffler::mesh
