#include "mesh/tolerance_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/closest.hpp"

namespace riffler {

namespace {

using OpenMesh::HalfedgeHandle;

/// The share of the tolerance that flat fans may use up by dropping vertices.
constexpr double kFlatShare = 0.1;

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = glm::dot(ab, ab), along = length2 > 0 ? glm::dot(p - a, ab) / length2 : 0;
  return glm::length(p - a - std::clamp(along, 0.0, 1.0) * ab);
}

}  // namespace

ToleranceCheck::ToleranceCheck(const HalfEdges& half_edges, double tolerance)
    : half_edges_(half_edges),
      mesh_(half_edges.mesh),
      tolerance_(tolerance),
      corner_of_(mesh_.n_vertices(), -1),
      next_(mesh_.n_vertices(), -1),
      in_face_(mesh_.n_faces(), -1),
      on_border_(mesh_.n_edges(), -1),
      error_(mesh_.n_faces(), 0.0) {
  for (std::size_t half = 0; half < half_edges.corner.size(); ++half)
    if (const int v = half_edges.corner[half]; v >= 0) corner_of_[v] = static_cast<int>(half);
}

bool ToleranceCheck::allow(const Collapse& c) {
  fan_error_ = 0;
  for (int i = 0; i < c.old_faces(); ++i) fan_error_ = std::max(fan_error_, error_[c.face(i).idx()]);
  // Once for what was dropped and its fan, once for that fan and the old surface under a trace.
  limit_ = tolerance_ - 2 * fan_error_;
  find_normal(c);
  if (c.on_border() ? !border_near(c) : !vertices_near(c)) return false;
  // Old and new fan fill the same part of a slab: no point of one is farther from the other than it is thick.
  flat_error_ = fan_error_ + std::max(largest_, thickness_);
  flat_ = flat_error_ <= kFlatShare * tolerance_ && !c.on_border();
  if (flat_) return true;
  for (int i = c.first() + 1; i <= c.last(); ++i)
    if (!trace_near(c, i)) return false;
  return true;
}

/// The direction along which the fans are seen best, and how thick a slab across it holds them; infinite where a face
/// turns away from it.
void ToleranceCheck::find_normal(const Collapse& c) {
  normal_ = Vec3(0);
  for (int i = 0; i < c.old_faces(); ++i) normal_ += c.old_cross(i) + c.new_cross(i);
  const double length = glm::length(normal_);
  if (length > 0) normal_ /= length;
  double low = glm::dot(normal_, c.old_point()), high = low;
  for (int i = 0; i < c.ring_size(); ++i) {
    const double height = glm::dot(normal_, c.ring(i));
    low = std::min(low, height), high = std::max(high, height);
  }
  thickness_ = high - low;
  for (int i = 0; i < c.old_faces(); ++i)
    if (glm::dot(c.old_cross(i), normal_) < 0 || glm::dot(c.new_cross(i), normal_) < 0)
      thickness_ = std::numeric_limits<double>::infinity();
}

/// The old vertices of the fan, `from` among them unless it is on a border.
bool ToleranceCheck::vertices_near(const Collapse& c) {
  moves_.clear();
  largest_ = 0;
  if (!c.on_border() && !near_new_face(c, c.from().idx())) return false;
  for (int i = 0; i < c.old_faces(); ++i)
    for (int v = in_face_[c.face(i).idx()]; v >= 0; v = next_[v])
      if (!near_new_face(c, v)) return false;
  return true;
}

bool ToleranceCheck::near_new_face(const Collapse& c, int vertex) {
  const Vec3 p = point(vertex), a = c.new_point();
  const auto distance_to = [&](int i) {
    return glm::length(p - closest_on_triangle(p, a, c.ring(i), c.ring(i + 1)).point);
  };
  const auto left_of = [&](const Vec3& from, const Vec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal_) >= 0;
  };
  // The region is told by the traces, and these by the sides of their planes. What is seen outside of the fan, because
  // the traces round it belong to other planes, goes to the nearest.
  int face = -1;
  double distance = std::numeric_limits<double>::infinity();
  for (int i = c.first(); i <= c.last() && face < 0; ++i)
    if (left_of(a, c.ring(i)) && left_of(c.ring(i), c.ring(i + 1)) && !left_of(a, c.ring(i + 1)))
      face = i, distance = distance_to(i);
  if (face < 0)
    for (int i = c.first(); i <= c.last(); ++i)
      if (const double d = distance_to(i); d < distance) face = i, distance = d;
  if (!(distance <= limit_)) return false;
  largest_ = std::max(largest_, distance);
  moves_.push_back({vertex, c.face(face).idx()});
  return true;
}

/// The border edge of `from` that is not collapsed.
HalfedgeHandle ToleranceCheck::other_border(const Collapse& c) {
  return c.spoke(c.target() == 0 ? c.ring_size() - 1 : 0);
}

bool ToleranceCheck::near_new_border(const Collapse& c, int vertex) const {
  const Vec3& end = c.ring(c.target() == 0 ? c.ring_size() - 1 : 0);
  return distance_to_segment(point(vertex), c.new_point(), end) <= limit_;
}

bool ToleranceCheck::border_near(const Collapse& c) {
  if (!near_new_border(c, c.from().idx())) return false;
  for (const HalfedgeHandle edge : {c.spoke(c.target()), other_border(c)})
    for (int v = on_border_[edge.idx() / 2]; v >= 0; v = next_[v])
      if (!near_new_border(c, v)) return false;
  return vertices_near(c);
}

/// The trace of the new edge from `to` to ring(i).
bool ToleranceCheck::trace_near(const Collapse& c, int i) const {
  const Vec3 &from = c.new_point(), &to = c.ring(i);
  const Vec3 side = glm::cross(normal_, to - from);
  const int target = c.ring_vertex(i).idx();
  // Of the old triangles at `to`, the one through which the plane leaves it forwards: its next vertex is to the right,
  // the one after to the left. A vertex in the plane counts as left, everywhere.
  const auto is_left = [&](int v) { return glm::dot(point(v) - from, side) >= 0; };
  const auto leaves_here = [&](int half) {
    const int p = half_edges_.corner[next_half(half)], q = half_edges_.corner[previous_half(half)];
    return !is_left(p) && is_left(q) && glm::dot(point(p) + point(q) - 2.0 * from, to - from) > 0;
  };
  const int start = corner_of_[c.to().idx()];
  int exits[4], count = 0;
  const auto visit = [&](int half) {
    const int p = half_edges_.corner[next_half(half)], q = half_edges_.corner[previous_half(half)];
    if (p == target || q == target) return true;  // an old edge
    if (leaves_here(half) && count < 4) exits[count++] = half;
    return false;
  };
  int half = start;
  do {
    if (visit(half)) return true;
    half = half_edges_.adjacency.twin(previous_half(half));
  } while (half >= 0 && half != start);
  if (half < 0)
    for (int twin = half_edges_.adjacency.twin(start); twin >= 0; twin = half_edges_.adjacency.twin(next_half(twin)))
      if (visit(next_half(twin))) return true;
  for (int k = 0; k < count; ++k)
    if (follow(next_half(exits[k]), target, from, to, side)) return true;
  return false;
}

/// Follows a trace out of a triangle over its half-edge `half`, whose start is right of the plane and whose end left.
bool ToleranceCheck::follow(int half, int target, const Vec3& from, const Vec3& to, const Vec3& side) const {
  Vec3 right = point(half_edges_.corner[half]), left = point(half_edges_.corner[next_half(half)]);
  double right_height = glm::dot(right - from, side), left_height = glm::dot(left - from, side);
  const int start = half;
  do {
    const Vec3 crossing = right + (right_height / (right_height - left_height)) * (left - right);
    if (!(distance_to_segment(crossing, from, to) <= limit_)) return false;
    const int twin = half_edges_.adjacency.twin(half);
    if (twin < 0) return false;
    const int tip = half_edges_.corner[previous_half(twin)];
    if (tip == target) return true;
    const Vec3 p = point(tip);
    // The twin runs from left to right; then comes right → tip, then tip → left.
    if (const double height = glm::dot(p - from, side); height >= 0)
      half = next_half(twin), left = p, left_height = height;
    else
      half = previous_half(twin), right = p, right_height = height;
  } while (half != start);
  return false;  // the plane cuts a closed loop out of the surface
}

void ToleranceCheck::commit(const Collapse& c) {
  for (int i = 0; i < c.old_faces(); ++i) {
    in_face_[c.face(i).idx()] = -1;
    error_[c.face(i).idx()] = flat_ ? flat_error_ : fan_error_;
  }
  if (c.on_border()) {
    // One list of both edges and the vertex between them.
    const int gone = c.spoke(c.target()).idx() / 2, kept = other_border(c).idx() / 2;
    int last = c.from().idx();
    next_[last] = on_border_[gone];
    while (next_[last] >= 0) last = next_[last];
    next_[last] = on_border_[kept];
    on_border_[kept] = c.from().idx();
  }
  if (flat_) return;
  for (const Move& move : moves_) {
    next_[move.vertex] = in_face_[move.face];
    in_face_[move.face] = move.vertex;
  }
}

}  // namespace riffler
