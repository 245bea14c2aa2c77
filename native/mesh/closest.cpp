#include "mesh/closest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "geom/median_tree.hpp"
#include "mesh/adjacency.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/mesh/orient.hpp"

namespace riffler::mesh {

namespace {

constexpr std::size_t kLeaf = 4;

double square_to_box(const Vec3& p, const Box3& box) {
  return geom::squared_length(glm::max(Vec3(0), glm::max(box.lower - p, p - box.upper)));
}

/// Nearest point of a segment, and its position: 0 inside, 1 at a, 2 at b.
std::pair<Vec3, int> closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double along = glm::dot(p - a, ab), length2 = geom::squared_length(ab);
  if (!(along > 0)) return {a, 1};
  if (along >= length2) return {b, 2};
  return {a + (along / length2) * ab, 0};
}

}  // namespace

OnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = glm::cross(b - a, c - a);
  const double length2 = geom::squared_length(normal);
  const std::array<Vec3, 4> corner{a, b, c, a};
  bool within[3], all = length2 > 0;
  for (int k = 0; k < 3; ++k) {
    within[k] = length2 > 0 && glm::dot(glm::cross(corner[k + 1] - corner[k], p - corner[k]), normal) > 0;
    all = all && within[k];
  }
  if (all) return {p - (glm::dot(p - a, normal) / length2) * normal, OnTriangle::Face};
  using Part = OnTriangle::Part;
  constexpr Part kParts[3][3] = {{Part::EdgeAB, Part::VertexA, Part::VertexB},
                                 {Part::EdgeBC, Part::VertexB, Part::VertexC},
                                 {Part::EdgeCA, Part::VertexC, Part::VertexA}};
  // The nearest point lies on an edge that separates p from the triangle.
  OnTriangle best{a, Part::VertexA};
  double best2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (within[k]) continue;
    const auto [q, where] = closest_on_segment(p, corner[k], corner[k + 1]);
    if (const double d2 = geom::squared_length(p - q); d2 < best2) best2 = d2, best = {q, kParts[k][where]};
  }
  return best;
}

Closest::Closest(const Mesh& mesh, bool with_sides) {
  validate(mesh);
  if (mesh.empty()) throw std::invalid_argument("a mesh without triangles has no nearest point");
  std::vector<Corners> corners(mesh.triangles.size());
  base::parallel_for(corners.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3i& v = mesh.triangles[t];
      corners[t] = {mesh.vertices[v.x], mesh.vertices[v.y], mesh.vertices[v.z]};
    }
  });
  build(corners);
  if (with_sides) prepare_sides(mesh);
}

void Closest::build(const std::vector<Corners>& corners) {
  const std::size_t n = corners.size();
  id_.resize(n);
  std::iota(id_.begin(), id_.end(), 0);
  while ((n >> levels_) > kLeaf) ++levels_;
  std::vector<Vec3> centres(n);
  base::parallel_for(n, 1 << 15, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) centres[t] = (corners[t].a + corners[t].b + corners[t].c) / 3.0;
  });
  geom::sort_by_medians(id_, levels_, centres);
  corners_.resize(n), slot_.resize(n);
  boxes_ = geom::boxes_of_tree(levels_, [&](std::size_t leaf) {
    // The order within a leaf decides between equally near triangles, and nth_element does not define it.
    std::sort(id_.begin() + static_cast<std::ptrdiff_t>(first(levels_, leaf)),
              id_.begin() + static_cast<std::ptrdiff_t>(first(levels_, leaf + 1)));
    Box3 box;
    for (std::size_t i = first(levels_, leaf); i < first(levels_, leaf + 1); ++i) {
      const Corners& c = corners_[i] = corners[id_[i]];
      slot_[id_[i]] = static_cast<int>(i);
      box.add(c.a), box.add(c.b), box.add(c.c);
    }
    return box;
  });
}

/// Calls visit(slot) for triangles whose box is nearer than the square root of `bound`, near boxes first, until visit
/// returns true. visit may lower `bound`.
template <class Visit>
void Closest::descend(const Vec3& p, double& bound, const Visit& visit) const {
  struct Entry {
    std::size_t node;
    double square;
  };
  std::array<Entry, 64> stack;
  std::size_t depth = 0;
  const std::size_t leaves = (std::size_t{1} << levels_) - 1;
  stack[depth++] = {0, square_to_box(p, boxes_[0])};
  while (depth > 0) {
    Entry entry = stack[--depth];
    if (!(entry.square <= bound)) continue;
    while (entry.node < leaves) {
      Entry near{2 * entry.node + 1, square_to_box(p, boxes_[2 * entry.node + 1])};
      Entry far{2 * entry.node + 2, square_to_box(p, boxes_[2 * entry.node + 2])};
      if (far.square < near.square) std::swap(near, far);
      if (far.square <= bound) stack[depth++] = far;
      entry = near;
      if (!(entry.square <= bound)) break;
    }
    if (entry.node < leaves) continue;
    const std::size_t place = entry.node - leaves;
    for (std::size_t i = first(levels_, place); i < first(levels_, place + 1); ++i)
      if (visit(i)) return;
  }
}

template <class Keep>
Closest::Hit Closest::nearest(const Vec3& p, double limit, const Keep& keep) const {
  Hit hit;
  double bound = limit * limit;
  descend(p, bound, [&](std::size_t i) {
    if (!keep(corners_[i])) return false;
    const OnTriangle on = closest_on_triangle(p, corners_[i].a, corners_[i].b, corners_[i].c);
    const double d2 = geom::squared_length(p - on.point);
    if (d2 < bound || (d2 == bound && (hit.triangle < 0 || id_[i] < hit.triangle))) {
      bound = d2;
      hit = {on.point, 0, id_[i], on.part};
    }
    return false;
  });
  if (hit.triangle >= 0) hit.distance = std::sqrt(bound);
  return hit;
}

Closest::Hit Closest::operator()(const Vec3& p, double limit) const {
  return nearest(p, limit, [](const Corners&) { return true; });
}

bool Closest::Above::holds(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const auto rises = [&](const Vec3& corner) { return glm::dot(corner - origin, up) > height; };
  if (!rises(a) && !rises(b) && !rises(c)) return false;
  const Vec3 normal = glm::cross(b - a, c - a);
  return glm::dot(normal, up) <= cosine * glm::length(normal);
}

Closest::Hit Closest::above(const Vec3& p, double limit, const Above& plane) const {
  return nearest(p, limit, [&](const Corners& c) { return plane.holds(c.a, c.b, c.c); });
}

bool Closest::may_meet(const Vec3& p, double limit, std::span<const Vec3> ways, const Above& plane) const {
  double longest = 0;
  for (const Vec3& way : ways) longest = std::max(longest, glm::length(way));
  double bound = (limit + longest) * (limit + longest);
  bool found = false;
  descend(p, bound, [&](std::size_t i) {
    const auto& [a, b, c] = corners_[i];
    if (!plane.holds(a, b, c)) return false;
    const Vec3 from = p - closest_on_triangle(p, a, b, c).point;
    const double distance = glm::length(from);
    double least = 0;
    for (const Vec3& way : ways) least = std::min(least, glm::dot(from, way));
    return found = distance == 0 || distance + least / distance < limit;
  });
  return found;
}

void Closest::gather(const Vec3& p, double limit, std::vector<Hit>& hits) const {
  double bound = limit * limit;
  descend(p, bound, [&](std::size_t i) {
    const auto& [a, b, c] = corners_[i];
    // The box test costs a tenth of the nearest point, and rejects most triangles of a leaf at the rim.
    if (square_to_box(p, {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))}) > bound) return false;
    const OnTriangle on = closest_on_triangle(p, a, b, c);
    if (const double d2 = geom::squared_length(p - on.point); d2 <= bound)
      hits.push_back({on.point, std::sqrt(d2), id_[i], on.part});
    return false;
  });
}

bool Closest::within(const Vec3& p, double limit) const {
  double bound = limit * limit;
  bool found = false;
  descend(p, bound, [&](std::size_t i) {
    const OnTriangle on = closest_on_triangle(p, corners_[i].a, corners_[i].b, corners_[i].c);
    return found = geom::squared_length(p - on.point) <= bound;
  });
  return found;
}

Closest::Hit Closest::on(int t, const Vec3& p) const {
  const Corners& c = corners_[slot_[t]];
  const OnTriangle on = closest_on_triangle(p, c.a, c.b, c.c);
  return {on.point, glm::length(p - on.point), t, on.part};
}

double Closest::distance_to(int t, const Vec3& p) const {
  return on(t, p).distance;
}

void Closest::prepare_sides(const Mesh& mesh) {
  triangles_ = mesh.triangles;
  face_normals_.resize(triangles_.size());
  edge_normals_.resize(3 * triangles_.size());
  vertex_normals_.assign(mesh.vertices.size(), Vec3(0));
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Corners& c = corners_[slot_[t]];
    const std::array<Vec3, 3> p{c.a, c.b, c.c};
    face_normals_[t] = geom::unit_or_zero(glm::cross(c.b - c.a, c.c - c.a));
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = p[(k + 1) % 3] - p[k], f = p[(k + 2) % 3] - p[k];
      const double angle = base::atan2(glm::length(glm::cross(e, f)), glm::dot(e, f));
      vertex_normals_[triangles_[t][k]] += angle * face_normals_[t];
    }
  }
  EdgeTable(mesh).for_each_edge([&](int, std::span<const EdgeTable::Use> uses) {
    Vec3 sum(0);
    for (const EdgeTable::Use& use : uses) sum += face_normals_[triangle_of(use.half())];
    for (const EdgeTable::Use& use : uses) edge_normals_[use.half()] = sum;
  });
}

double Closest::signed_distance(const Vec3& p, const Hit& hit) const {
  Vec3 normal;
  if (hit.part == OnTriangle::Face)
    normal = face_normals_[hit.triangle];
  else if (hit.part <= OnTriangle::EdgeCA)
    normal = edge_normals_[3 * static_cast<std::size_t>(hit.triangle) + (hit.part - OnTriangle::EdgeAB)];
  else
    normal = vertex_normals_[triangles_[hit.triangle][hit.part - OnTriangle::VertexA]];
  return glm::dot(p - hit.point, normal) < 0 ? -hit.distance : hit.distance;
}

std::vector<double> deviation(const Mesh& mesh, const Mesh& other, bool with_sign, const Progress& progress) {
  validate(mesh);
  if (other.empty()) throw std::invalid_argument("other: a mesh without triangles has no nearest point");
  std::optional<Mesh> storage;
  const Closest closest(with_sign ? as_solid(other, storage) : other, with_sign);
  base::report(progress, 0);
  std::vector<double> result(mesh.vertices.size());
  base::parallel_for(
      result.size(), 512,
      [&](std::size_t begin, std::size_t end) {
        int last = -1;
        for (std::size_t i = begin; i < end; ++i) {
          // The distance to the previous vertex's triangle is an upper bound, so most of the tree is skipped. The bound
          // is slightly enlarged, so that the search finds this triangle again.
          const Vec3& p = mesh.vertices[i];
          const double bound = last < 0 ? std::numeric_limits<double>::infinity() : closest.distance_to(last, p);
          const Closest::Hit hit = closest(p, bound * (1 + 1e-12));
          last = hit.triangle;
          result[i] = with_sign ? closest.signed_distance(p, hit) : hit.distance;
        }
      },
      progress);
  return result;
}

}  // namespace riffler::mesh
