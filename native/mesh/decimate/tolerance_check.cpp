#include "mesh/decimate/tolerance_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/closest.hpp"

namespace riffler::mesh {

namespace {

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Fraction of the tolerance that flat fans may use by dropping vertices.
constexpr double kFlatShare = 0.02;

/// Maximum distance per edge length and change of slope.
constexpr double kBend = 0.25;

struct EdgeSegment {
  Vec3 a, ab;
  double scale;
  EdgeSegment(const Vec3& from, const Vec3& to) : a(from), ab(to - from) {
    const double length2 = glm::dot(ab, ab);
    scale = length2 > 0 ? 1 / length2 : 0;
  }
  double square_to(const Vec3& p) const {
    const Vec3 d = p - a - std::clamp(glm::dot(p - a, ab) * scale, 0.0, 1.0) * ab;
    return glm::dot(d, d);
  }
};

}  // namespace

Traces::Traces(const HalfEdges& from, const Progress& progress)
    : half_edges(from),
      old(from.mesh.n_vertices()),
      anchor(from.mesh.n_vertices()),
      in_face(from.mesh.n_faces(), -1),
      on_border(from.mesh.n_edges(), -1),
      flat(from.mesh.n_faces()) {
  base::report(progress, 0.4);
  for (std::size_t v = 0; v < old.size(); ++v)
    old[v] = {to_vec3(from.mesh.point(VertexHandle(static_cast<int>(v)))), -1};
  for (std::size_t half = 0; half < from.corner.size(); ++half)
    if (const int v = from.corner[half]; v >= 0) anchor[v] = {old[v].point, static_cast<int>(half), true};
  base::report(progress, 0.7);
  std::size_t face = 0;  // faces are the triangles that were not left out
  for (std::size_t half = 0; half < from.corner.size(); half += 3) {
    if (from.corner[half] < 0) continue;
    const Vec3 &a = old[from.corner[half]].point, &b = old[from.corner[half + 1]].point,
               &c = old[from.corner[half + 2]].point;
    const Vec3 ab = b - a, bc = c - b, ca = a - c;
    flat[face++].edge = static_cast<float>(std::sqrt(std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)})));
  }
}

bool ToleranceCheck::allow(const Collapse& c) {
  fan_error_ = fan_edge_ = 0;
  for (int i = 0; i < c.old_faces(); ++i) {
    const Traces::Flat& flat = traces_.flat[c.face(i).idx()];
    fan_error_ = std::max<double>(fan_error_, flat.error), fan_edge_ = std::max<double>(fan_edge_, flat.edge);
  }
  // Once for the dropped vertices and their fan, once for that fan and the old surface under a trace.
  limit_ = tolerance_ - 2 * fan_error_;
  if (!(limit_ >= 0) || !(anchor_distance_ <= limit_)) return false;
  find_normal(c);
  find_planes(c);
  if (c.on_border() ? !border_near(c) : !vertices_near(c)) return false;
  // Old and new fan fill the same part of a slab, so no point of one is farther from the other than its thickness.
  flat_error_ = fan_error_ + std::max(largest_, thickness_);
  flat_ = flat_error_ <= kFlatShare * tolerance_ && !c.on_border();
  if (flat_ || crossings_at_most(c) <= limit_) return true;
  for (int i = c.between() ? 0 : c.first() + 1; i <= c.last(); ++i)
    if (!trace_near(c, i)) return false;
  return true;
}

/// An estimate of the largest distance from the new edges to the points where the traces cross old edges. An old edge
/// of length l whose ends are at distance d from two faces is at most d + l s / 4 away from where these meet with a
/// change of slope s.
double ToleranceCheck::crossings_at_most(const Collapse& c) const {
  double least = 1;  // cosine of the angle between neighbours
  const auto look_at = [&](int i, int j) {
    const Vec3 &a = c.new_cross(i), &b = c.new_cross(j);
    const double dot = glm::dot(a, b), square = glm::dot(a, a) * glm::dot(b, b);
    least = std::min(least, dot > 0 ? dot * dot / square : 0);
  };
  for (int i = c.first() + 1; i <= c.last(); ++i) look_at(i - 1, i);
  if (c.between()) look_at(c.last(), c.first());
  if (!(least > 0)) return std::numeric_limits<double>::infinity();
  return largest_ + kBend * fan_edge_ * std::sqrt(1 / least - 1);
}

/// Finds the direction that sees the fans best, and the thickness of a slab perpendicular to it that contains them;
/// infinite if a face turns away from it.
void ToleranceCheck::find_normal(const Collapse& c) {
  normal_ = Vec3(0);
  for (int i = 0; i < c.old_faces(); ++i) normal_ += c.old_cross(i) + c.new_cross(i);
  const double length = glm::length(normal_);
  if (length > 0) normal_ /= length;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto add = [&](const Vec3& p) {
    const double height = glm::dot(normal_, p);
    low = std::min(low, height), high = std::max(high, height);
  };
  add(c.from_point());
  if (c.between()) add(c.to_point()), add(c.new_point());
  for (int i = 0; i < c.ring_size(); ++i) add(c.ring(i));
  thickness_ = high - low;
  for (int i = 0; i < c.old_faces(); ++i)
    if (glm::dot(c.old_cross(i), normal_) < 0 || glm::dot(c.new_cross(i), normal_) < 0)
      thickness_ = std::numeric_limits<double>::infinity();
}

/// Walks over the old surface, from the nearer of the two anchors, while the distance to the new vertex decreases.
bool ToleranceCheck::find_anchor(const CollapseTarget& place) {
  if (!place.half.is_valid()) return false;
  anchor_ = traces_.anchor[half_edges_.mesh.to_vertex_handle(place.half).idx()], anchor_distance_ = 0;
  if (!place.between) return true;
  const Vec3& p = place.point;
  const Traces::Anchor& other = traces_.anchor[half_edges_.mesh.from_vertex_handle(place.half).idx()];
  const auto square_from = [&](const Vec3& q) { return glm::dot(p - q, p - q); };
  int face = -1;
  Vec3 foot(0);
  OnTriangle::Part part = OnTriangle::Face;
  double best = std::numeric_limits<double>::infinity();
  const auto look_at = [&](int t) {
    const Vec3 &a = old_point(3 * t), &b = old_point(3 * t + 1), &d = old_point(3 * t + 2);
    const OnTriangle on = closest_on_triangle(p, a, b, d);
    const double distance2 = square_from(on.point);
    if (!(distance2 < best)) return;
    best = distance2, face = t, part = on.part, foot = on.point;
  };
  look_at(triangle_of(square_from(other.point) < square_from(anchor_.point) ? other.half : anchor_.half));
  for (int last = -1; face != last && part != OnTriangle::Face;) {
    last = face;
    if (part < OnTriangle::VertexA) {
      if (const int twin = half_edges_.adjacency.twin(3 * last + (part - OnTriangle::EdgeAB)); twin >= 0)
        look_at(triangle_of(twin));
      continue;
    }
    const int start = 3 * last + (part - OnTriangle::VertexA);
    for (int half = half_edges_.adjacency.twin(previous_half(start)); half >= 0 && half != start;
         half = half_edges_.adjacency.twin(previous_half(half)))
      look_at(triangle_of(half));
  }
  // slightly inside the triangle, so that a plane through the anchor always leaves it through an edge
  const Vec3 centre = (old_point(3 * face) + old_point(3 * face + 1) + old_point(3 * face + 2)) / 3.0;
  anchor_ = {foot + 1e-3 * (centre - foot), 3 * face, false};
  anchor_distance_ = glm::length(p - anchor_.point);
  return anchor_distance_ <= tolerance_;
}

void ToleranceCheck::find_planes(const Collapse& c) {
  corners_.resize(static_cast<std::size_t>(c.ring_size()));
  for (int i = 0; i < c.ring_size(); ++i) {
    corners_[i].anchor = traces_.anchor[c.ring_vertex(i).idx()];
    corners_[i].side = glm::cross(normal_, corners_[i].anchor.point - anchor_.point);
  }
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Corner& next = corners_[i + 1 < corners_.size() ? i + 1 : 0];
    corners_[i].outer_side = glm::cross(normal_, next.anchor.point - corners_[i].anchor.point);
  }
}

/// Assigns the old vertices of the fan to new faces, including the collapsed ones unless they are on a border.
bool ToleranceCheck::vertices_near(const Collapse& c) {
  moves_.clear();
  largest_ = 0;
  const auto unlisted = [&](VertexHandle v) { return traces_.anchor[v.idx()].vertex; };
  if (!c.on_border() && unlisted(c.from()) && !near_new_face(c, c.from().idx())) return false;
  if (c.between() && unlisted(c.to()) && !near_new_face(c, c.to().idx())) return false;
  for (int i = 0; i < c.old_faces(); ++i)
    for (int v = traces_.in_face[c.face(i).idx()]; v >= 0; v = traces_.old[v].next)
      if (!near_new_face(c, v)) return false;
  return true;
}

bool ToleranceCheck::near_new_face(const Collapse& c, int vertex) {
  const Vec3& p = traces_.old[vertex].point;
  const auto distance_to = [&](int i) {
    return glm::length(p - closest_on_triangle(p, c.new_point(), c.ring(i), c.ring(i + 1)).point);
  };
  const auto left_of_spoke = [&](int i) { return glm::dot(p - anchor_.point, corners_[i].side) >= 0; };
  // Traces delimit the region, and the sides of their planes identify it. An old vertex that appears outside the fan,
  // because the traces around it belong to other planes, goes to the nearest face.
  int face = -1;
  double distance = std::numeric_limits<double>::infinity();
  bool left = left_of_spoke(c.first());
  for (int i = c.first(); i <= c.last() && face < 0; ++i) {
    const bool was_left = left;
    left = left_of_spoke(i + 1 < c.ring_size() ? i + 1 : 0);
    if (was_left && !left && glm::dot(p - corners_[i].anchor.point, corners_[i].outer_side) >= 0)
      face = i, distance = distance_to(i);
  }
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
  return EdgeSegment(c.new_point(), end).square_to(traces_.old[vertex].point) <= limit_ * limit_;
}

bool ToleranceCheck::border_near(const Collapse& c) {
  if (!near_new_border(c, c.from().idx())) return false;
  for (const HalfedgeHandle edge : {c.spoke(c.target()), other_border(c)})
    for (int v = traces_.on_border[edge.idx() / 2]; v >= 0; v = traces_.old[v].next)
      if (!near_new_border(c, v)) return false;
  return vertices_near(c);
}

bool ToleranceCheck::has_corner(int half, int vertex) const {
  const int first = 3 * triangle_of(half);
  for (int k = 0; k < 3; ++k)
    if (half_edges_.corner[first + k] == vertex) return true;
  return false;
}

/// Checks the trace of the new edge to ring(i).
bool ToleranceCheck::trace_near(const Collapse& c, int i) const {
  const Traces::Anchor& target = corners_[i].anchor;
  return anchor_.vertex ? leave_vertex(target, c.new_point(), c.ring(i), corners_[i].side)
                        : leave_face(target, c.new_point(), c.ring(i), corners_[i].side);
}

/// Checks a trace that starts at an old vertex.
bool ToleranceCheck::leave_vertex(const Traces::Anchor& target, const Vec3& from, const Vec3& to,
                                  const Vec3& side) const {
  const Vec3 &start = anchor_.point, way = target.point - start;
  const int target_vertex = target.vertex ? half_edges_.corner[target.half] : -1;
  // Finds the old triangle there through which the plane leaves the vertex forwards: its next vertex is on the right,
  // the one after it on the left. A vertex in the plane counts as left, everywhere.
  const auto is_left = [&](int half) { return glm::dot(old_point(half) - start, side) >= 0; };
  const auto leaves_here = [&](int half) {
    const int p = next_half(half), q = previous_half(half);
    return !is_left(p) && is_left(q) && glm::dot(old_point(p) + old_point(q) - 2.0 * start, way) > 0;
  };
  int exits[4], count = 0;
  const auto visit = [&](int half) {
    if (target.vertex ? half_edges_.corner[next_half(half)] == target_vertex ||
                            half_edges_.corner[previous_half(half)] == target_vertex
                      : triangle_of(half) == triangle_of(target.half))
      return true;  // within one old triangle
    if (leaves_here(half) && count < 4) exits[count++] = half;
    return false;
  };
  int half = anchor_.half;
  do {
    if (visit(half)) return true;
    half = half_edges_.adjacency.twin(previous_half(half));
  } while (half >= 0 && half != anchor_.half);
  if (half < 0)
    for (int twin = half_edges_.adjacency.twin(anchor_.half); twin >= 0;
         twin = half_edges_.adjacency.twin(next_half(twin)))
      if (visit(next_half(twin))) return true;
  for (int k = 0; k < count; ++k)
    if (follow(next_half(exits[k]), target, from, to, side)) return true;
  return false;
}

/// Checks a trace that starts inside an old triangle.
bool ToleranceCheck::leave_face(const Traces::Anchor& target, const Vec3& from, const Vec3& to,
                                const Vec3& side) const {
  const int first = 3 * triangle_of(anchor_.half);
  if (target.vertex ? has_corner(first, half_edges_.corner[target.half]) : triangle_of(target.half) * 3 == first)
    return true;
  const auto height = [&](int half) { return glm::dot(old_point(half) - anchor_.point, side); };
  for (int half = first; half < first + 3; ++half)
    if (height(half) < 0 && height(next_half(half)) >= 0) return follow(half, target, from, to, side);
  return false;
}

/// Follows a trace out of a triangle over its half-edge `half`, whose start is right of the plane and whose end is
/// left.
bool ToleranceCheck::follow(int half, const Traces::Anchor& target, const Vec3& from, const Vec3& to,
                            const Vec3& side) const {
  const int target_vertex = target.vertex ? half_edges_.corner[target.half] : -1;
  const int target_face = target.vertex ? -1 : triangle_of(target.half);
  Vec3 right = old_point(half), left = old_point(next_half(half));
  double right_height = glm::dot(right - anchor_.point, side), left_height = glm::dot(left - anchor_.point, side);
  const EdgeSegment edge(from, to);
  const int start = half;
  do {
    const Vec3 crossing = right + (right_height / (right_height - left_height)) * (left - right);
    if (!(edge.square_to(crossing) <= limit_ * limit_)) return false;
    const int twin = half_edges_.adjacency.twin(half);
    if (twin < 0) return false;
    const int tip = half_edges_.corner[previous_half(twin)];
    if (tip == target_vertex || triangle_of(twin) == target_face) return true;
    const Vec3& p = traces_.old[tip].point;
    // The twin runs from left to right; the next half-edges are right → tip and tip → left.
    if (const double height = glm::dot(p - anchor_.point, side); height >= 0)
      half = next_half(twin), left = p, left_height = height;
    else
      half = previous_half(twin), right = p, right_height = height;
  } while (half != start);
  return false;  // the plane cuts a closed loop out of the surface
}

void ToleranceCheck::commit(const Collapse& c) {
  for (int i = 0; i < c.old_faces(); ++i) {
    traces_.in_face[c.face(i).idx()] = -1;
    traces_.flat[c.face(i).idx()] = {static_cast<float>(flat_ ? flat_error_ : fan_error_),
                                     static_cast<float>(fan_edge_)};
  }
  traces_.anchor[c.to().idx()] = anchor_;
  if (c.on_border()) {
    // Merges the lists of both edges, with the vertex between them.
    const int gone = c.spoke(c.target()).idx() / 2, kept = other_border(c).idx() / 2;
    int last = c.from().idx();
    traces_.old[last].next = traces_.on_border[gone];
    while (traces_.old[last].next >= 0) last = traces_.old[last].next;
    traces_.old[last].next = traces_.on_border[kept];
    traces_.on_border[kept] = c.from().idx();
  }
  if (flat_) return;
  for (const Move& move : moves_) {
    traces_.old[move.vertex].next = traces_.in_face[move.face];
    traces_.in_face[move.face] = move.vertex;
  }
}

}  // namespace riffler::mesh
