#include "mesh/decimate/surface_map.hpp"

#include <algorithm>
#include <limits>

#include "base/sort_unique.hpp"
#include "mesh/closest.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Maximum number of divisions of a triangle and its edges.
constexpr int kDepth = 24;
/// Maximum number of pieces: a triangle usually lies over a few faces; one that needs more is not mapped.
constexpr std::size_t kMaxImages = 256;
/// Faces and vertices that are placed between two reports of progress.
constexpr std::size_t kPlaced = 1 << 12;

Vec3 nearest_of_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = glm::dot(ab, ab);
  return length2 > 0 ? a + std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) * ab : a;
}

/// A nearest pair of points of the segments a b and c d.
std::pair<Vec3, Vec3> nearest_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), uw = glm::dot(u, w), vw = glm::dot(v, w);
  const double det = uu * vv - uv * uv;
  // Treat a b as a line, clamp on c d, then on a b, then project back: the last point is the nearest.
  const double s = det > 0 ? std::clamp((uv * vw - vv * uw) / det, 0.0, 1.0) : 0;
  const Vec3 q = nearest_of_segment(a + s * u, c, d), p = nearest_of_segment(q, a, b);
  return {p, q};
}

bool comes_before(const Vec3& a, const Vec3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

}  // namespace

SurfaceMap::SurfaceMap(const Traces& traces, double tolerance, const Progress& progress)
    : traces_(traces),
      half_edges_(traces.half_edges),
      mesh_(traces.half_edges.mesh),
      tolerance_(tolerance),
      corners_(mesh_.n_faces()),
      spot_(traces.old.size()) {
  take_corners();
  place_vertices(base::part(progress, 0.1, 0.5));
  place_dropped_vertices(base::part(progress, 0.5, 0.8));
  place_others(base::part(progress, 0.8, 1));
}

void SurfaceMap::take_corners() {
  base::parallel_for(corners_.size(), kPlaced, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const FaceHandle face(static_cast<int>(f));
      if (mesh_.status(face).deleted()) continue;
      HalfedgeHandle half = mesh_.halfedge_handle(face);
      for (int& corner : corners_[f]) {
        corner = mesh_.from_vertex_handle(half).idx();
        half = mesh_.next_halfedge_handle(half);
      }
    }
  });
}

/// Places the old vertices that still exist, and those that the checks of the collapses have recorded.
void SurfaceMap::place_vertices(const Progress& progress) {
  const auto face_beside = [&](HalfedgeHandle half) {
    return mesh_.face_handle(mesh_.is_boundary(half) ? mesh_.opposite_halfedge_handle(half) : half).idx();
  };
  const auto place_in_faces = [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (mesh_.status(FaceHandle(static_cast<int>(f))).deleted()) continue;
      const Corners c = points_of(static_cast<int>(f));
      for (int v = traces_.in_face[f]; v >= 0; v = traces_.old[v].next) {
        const Vec3& p = traces_.old[v].point;
        spot_[v] = {p, closest_on_triangle(p, c[0], c[1], c[2]).point, static_cast<int>(f)};
      }
    }
  };
  base::parallel_for(corners_.size(), kPlaced, place_in_faces, progress);
  for (const EdgeHandle edge : mesh_.all_edges()) {
    if (mesh_.status(edge).deleted()) continue;
    const HalfedgeHandle half = mesh_.halfedge_handle(edge, 0);
    for (int v = traces_.on_border[edge.idx()]; v >= 0; v = traces_.old[v].next) {
      const Vec3& p = traces_.old[v].point;
      const Vec3 to = nearest_of_segment(p, to_vec3(mesh_.point(mesh_.from_vertex_handle(half))),
                                         to_vec3(mesh_.point(mesh_.to_vertex_handle(half))));
      spot_[v] = {p, to, face_beside(half)};
    }
  }
  for (const VertexHandle v : mesh_.all_vertices()) {
    if (mesh_.status(v).deleted() || !traces_.anchor[v.idx()].vertex) continue;
    const int old = half_edges_.corner[traces_.anchor[v.idx()].half];
    spot_[old] = {traces_.old[old].point, to_vec3(mesh_.point(v)), face_beside(mesh_.halfedge_handle(v))};
  }
}

/// Places the others from neighbour to neighbour.
void SurfaceMap::place_dropped_vertices(const Progress& progress) {
  const int triangles = static_cast<int>(half_edges_.corner.size() / 3);
  const auto corner = [&](int t, int k) { return half_edges_.corner[3 * t + k]; };
  std::vector<int> open;
  const auto may_be_open = [&](int t) {
    int placed = 0;
    for (int k = 0; k < 3; ++k) placed += spot_[corner(t, k)].face >= 0 ? 1 : 0;
    if (placed > 0 && placed < 3) open.push_back(t);
  };
  for (int t = 0; t < triangles; ++t)
    if (corner(t, 0) >= 0) may_be_open(t);
  for (std::size_t next = 0; next < open.size(); ++next) {
    if (next % kPlaced == 0) base::report(progress, static_cast<double>(next) / static_cast<double>(open.size()) / 2);
    const int t = open[next];
    bool any = false;
    for (int k = 0; k < 3; ++k) {
      Spot& spot = spot_[corner(t, k)];
      for (int other = 0; other < 3 && spot.face < 0; ++other) {
        const Spot& known = spot_[corner(t, other)];
        if (known.face < 0) continue;
        if (const Spot found = nearest(traces_.old[corner(t, k)].point, known.face); is_near(found))
          spot = found, any = true;
      }
    }
    if (!any) continue;
    for (int k = 0; k < 3; ++k)
      if (const int twin = half_edges_.adjacency.twin(3 * t + k); twin >= 0) may_be_open(triangle_of(twin));
  }
}

/// Places the remaining ones at the nearest point of the whole surface.
void SurfaceMap::place_others(const Progress& progress) {
  std::vector<int> others;
  for (std::size_t half = 0; half < half_edges_.corner.size(); ++half)
    if (const int v = half_edges_.corner[half]; v >= 0 && spot_[v].face < 0) others.push_back(v);
  if (others.empty()) return;
  const Closest closest(new_surface());
  std::vector<int> face;  // of each triangle of the new surface
  for (const FaceHandle f : mesh_.all_faces())
    if (!mesh_.status(f).deleted()) face.push_back(f.idx());
  base::sort_unique(others);
  const auto place = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& p = traces_.old[others[i]].point;
      if (const Closest::Hit hit = closest(p, tolerance_); hit.triangle >= 0)
        spot_[others[i]] = {p, hit.point, face[hit.triangle]};
    }
  };
  base::parallel_for(others.size(), 256, place, progress);
}

/// The remaining faces, with all vertices.
Mesh SurfaceMap::new_surface() const {
  Mesh now;
  for (const VertexHandle v : mesh_.all_vertices()) now.vertices.push_back(to_vec3(mesh_.point(v)));
  for (const FaceHandle face : mesh_.all_faces())
    if (const std::array<int, 3>& c = corners_[face.idx()]; !mesh_.status(face).deleted())
      now.triangles.emplace_back(c[0], c[1], c[2]);
  return now;
}

Corners SurfaceMap::points_of(int face) const {
  const std::array<int, 3>& c = corners_[face];
  const auto point = [&](int k) { return to_vec3(mesh_.point(VertexHandle(c[k]))); };
  return {point(0), point(1), point(2)};
}

bool SurfaceMap::map_triangle(std::size_t t, std::vector<Image>& images) const {
  const auto spot = [&](std::size_t k) -> const Spot& { return spot_[half_edges_.corner[3 * t + k]]; };
  images.clear();
  return is_near(spot(0)) && is_near(spot(1)) && is_near(spot(2)) &&
         map_triangle(spot(0), spot(1), spot(2), kDepth, images);
}

void SurfaceMap::map_edge(int half, std::vector<Segment>& segments) const {
  segments.clear();
  map_edge(spot_[half_edges_.corner[half]], spot_[half_edges_.corner[next_half(half)]], kDepth, segments);
}

void SurfaceMap::map_edge(const Spot& a, const Spot& b, int depth, std::vector<Segment>& segments) const {
  if (a.face == b.face) return void(segments.push_back({a.face, a.to, b.to}));
  if (const std::optional<Pair> cut = join(a, b)) {
    segments.push_back({a.face, a.to, cut->second});
    segments.push_back({b.face, cut->second, b.to});
  } else if (depth > 0) {
    const Spot half = middle(a, b);
    map_edge(a, half, depth - 1, segments), map_edge(half, b, depth - 1, segments);
  }
}

bool SurfaceMap::is_near(const Spot& spot) const {
  return spot.face >= 0 && glm::length(spot.from - spot.to) <= tolerance_;
}

/// Walks over the new surface while the distance decreases.
SurfaceMap::Spot SurfaceMap::nearest(const Vec3& p, int face) const {
  Spot best{p, p, -1};
  double best2 = std::numeric_limits<double>::infinity();
  OnTriangle::Part part = OnTriangle::Face;
  const auto look_at = [&](int f) {
    const std::array<int, 3>& c = corners_[f];
    const auto point = [&](int k) { return to_vec3(mesh_.point(VertexHandle(c[k]))); };
    const OnTriangle on = closest_on_triangle(p, point(0), point(1), point(2));
    const double square = glm::dot(p - on.point, p - on.point);
    if (!(square < best2)) return;
    best2 = square, best.to = on.point, best.face = f, part = on.part;
  };
  const auto look_round = [&](VertexHandle corner) {
    const HalfedgeHandle start = mesh_.halfedge_handle(corner);
    HalfedgeHandle spoke = start;
    do {
      if (!mesh_.is_boundary(spoke)) look_at(mesh_.face_handle(spoke).idx());
      spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(spoke));
    } while (spoke != start);
  };
  look_at(face);
  // In a hollow, a foot inside a face may be far from the nearest point.
  if (!is_near(best))
    for (const int corner : corners_[face]) look_round(VertexHandle(corner));
  for (int last = -1; best.face != last && part != OnTriangle::Face;) {
    last = best.face;
    if (part >= OnTriangle::VertexA) {
      look_round(VertexHandle(corners_[last][part - OnTriangle::VertexA]));
    } else {
      HalfedgeHandle half = mesh_.halfedge_handle(FaceHandle(last));
      for (int k = part - OnTriangle::EdgeAB; k > 0; --k) half = mesh_.next_halfedge_handle(half);
      if (const HalfedgeHandle across = mesh_.opposite_halfedge_handle(half); !mesh_.is_boundary(across))
        look_at(mesh_.face_handle(across).idx());
    }
  }
  return best;
}

/// A point of the edge from a to b over the face between theirs, if there is exactly one; otherwise its midpoint.
/// Depends only on the edge, not on the triangle that it bounds.
SurfaceMap::Spot SurfaceMap::middle(const Spot& a, const Spot& b) const {
  if (comes_before(b.from, a.from)) return middle(b, a);
  HalfedgeHandle half = mesh_.halfedge_handle(FaceHandle(a.face));
  for (int k = 0; k < 3; ++k, half = mesh_.next_halfedge_handle(half)) {
    const HalfedgeHandle across = mesh_.opposite_halfedge_handle(half);
    if (mesh_.is_boundary(across)) continue;
    const int face = mesh_.face_handle(across).idx();
    if (common_vertices(face, b.face).count < 2) continue;
    const Spot spot = between(a, b, face);
    if (is_near(spot)) return spot;
  }
  const Vec3 p = 0.5 * (a.from + b.from);
  const Spot one = nearest(p, a.face);
  if (is_near(one)) return one;
  return nearest(p, b.face);
}

/// The midpoint of the part of the edge over `face`, if the edge crosses from a's face into `face` and from there into
/// b's.
SurfaceMap::Spot SurfaceMap::between(const Spot& a, const Spot& b, int face) const {
  Vec3 sum(0);
  for (const Spot* end : {&a, &b}) {
    const Shared shared = common_vertices(end->face, face);
    sum += nearest_of_segments(a.from, b.from, shared.point[0], shared.point[1]).first;
  }
  const std::array<int, 3>& c = corners_[face];
  const auto point = [&](int k) { return to_vec3(mesh_.point(VertexHandle(c[k]))); };
  const Vec3 p = 0.5 * sum;
  return {p, closest_on_triangle(p, point(0), point(1), point(2)).point, face};
}

SurfaceMap::Shared SurfaceMap::common_vertices(int f, int g) const {
  Shared shared;
  for (const int v : corners_[f])
    for (const int w : corners_[g])
      if (v == w) shared.point[shared.count++] = to_vec3(mesh_.point(VertexHandle(v)));
  return shared;
}

/// A point between a and b near the edge or vertex that their faces share; symmetric in a and b.
std::optional<SurfaceMap::Pair> SurfaceMap::join(const Spot& a, const Spot& b) const {
  if (a.face == b.face) return Pair{a.from, a.to};
  if (comes_before(b.from, a.from)) return join(b, a);
  const Shared shared = common_vertices(a.face, b.face);
  if (shared.count == 0) return {};
  const Pair pair = shared.count == 1 ? Pair{nearest_of_segment(shared.point[0], a.from, b.from), shared.point[0]}
                                      : nearest_of_segments(a.from, b.from, shared.point[0], shared.point[1]);
  if (!(glm::length(pair.first - pair.second) <= tolerance_)) return {};
  return pair;
}

std::optional<Vec3> SurfaceMap::common_vertex(int f, int g, int h) const {
  const auto has = [&](int face, int v) {
    return std::find(corners_[face].begin(), corners_[face].end(), v) != corners_[face].end();
  };
  for (const int v : corners_[f])
    if (has(g, v) && has(h, v)) return to_vec3(mesh_.point(VertexHandle(v)));
  return {};
}

bool SurfaceMap::map_triangle(const Spot& a, const Spot& b, const Spot& c, int depth,
                              std::vector<Image>& images) const {
  if (images.size() > kMaxImages) return false;
  if (a.face == b.face && b.face == c.face) {
    images.push_back({a.face, a.to, b.to, c.to});
    return true;
  }
  const std::array<Spot, 3> corner{a, b, c};
  std::array<Pair, 3> cut;  // of the edge from corner k to the next
  for (int k = 0; k < 3; ++k) {
    const Spot &from = corner[k], &to = corner[(k + 1) % 3], &tip = corner[(k + 2) % 3];
    const std::optional<Pair> found = join(from, to);
    if (!found) {
      if (depth == 0) return false;
      const Spot half = middle(from, to);
      return is_near(half) && map_triangle(from, half, tip, depth - 1, images) &&
             map_triangle(half, to, tip, depth - 1, images);
    }
    cut[k] = *found;
  }
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    if (corner[l].face != corner[m].face) continue;
    images.push_back({corner[k].face, corner[k].to, cut[k].second, cut[m].second});
    images.push_back({corner[l].face, cut[k].second, corner[l].to, corner[m].to});
    images.push_back({corner[l].face, cut[k].second, corner[m].to, cut[m].second});
    return true;
  }
  if (map_onto_three(corner, cut, images)) return true;
  if (depth == 0) return false;
  const Spot centre = nearest((a.from + b.from + c.from) / 3.0, a.face);
  return is_near(centre) && map_triangle(a, b, centre, depth - 1, images) &&
         map_triangle(b, c, centre, depth - 1, images) && map_triangle(c, a, centre, depth - 1, images);
}

bool SurfaceMap::map_onto_three(const std::array<Spot, 3>& corner, const std::array<Pair, 3>& cut,
                                std::vector<Image>& images) const {
  const std::optional<Vec3> centre = common_vertex(corner[0].face, corner[1].face, corner[2].face);
  if (!centre) return false;
  const Vec3 near = closest_on_triangle(*centre, corner[0].from, corner[1].from, corner[2].from).point;
  if (!(glm::length(near - *centre) <= tolerance_)) return false;
  for (int k = 0; k < 3; ++k) {
    images.push_back({corner[k].face, corner[k].to, cut[k].second, *centre});
    images.push_back({corner[k].face, corner[k].to, *centre, cut[(k + 2) % 3].second});
  }
  return true;
}

}  // namespace riffler::mesh
