#include "mesh/map_check.hpp"

#include <algorithm>

#include "geom/parallel.hpp"

namespace riffler {

namespace {

using OpenMesh::FaceHandle;
using Image = SurfaceMap::Image;
using Segment = SurfaceMap::Segment;

/// How often a triangle may be halved where it is looked at piece by piece.
constexpr int kNearDepth = 24;

/// What the edge from (ax, ay) to (bx, by) adds to the winding number about the origin; nothing is left of an edge that
/// is run both ways.
int winding(double ax, double ay, double bx, double by) {
  if (ay <= 0 && 0 < by) return ax * by - bx * ay > 0 ? 1 : 0;
  if (by <= 0 && 0 < ay) return bx * ay - ax * by > 0 ? -1 : 0;
  return 0;
}

/// A face seen along the axis that it is most square to, with a point in its midst, on no line that a regular mesh is
/// likely to have.
class View {
 public:
  explicit View(const std::array<Vec3, 3>& p) : probe_(p[0] + 0.3304 * (p[1] - p[0]) + 0.3125 * (p[2] - p[0])) {
    const Vec3 size = glm::abs(glm::cross(p[1] - p[0], p[2] - p[0]));
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    x_ = (axis + 1) % 3, y_ = (axis + 2) % 3;
  }
  /// How often a piece of the map's image lies over that point, with a sign for its orientation.
  int sheets_over(const SurfaceMap::Image& image) const {
    const Vec3 a = image.a - probe_, b = image.b - probe_, c = image.c - probe_;
    return winding(a[x_], a[y_], b[x_], b[y_]) + winding(b[x_], b[y_], c[x_], c[y_]) +
           winding(c[x_], c[y_], a[x_], a[y_]);
  }

 private:
  Vec3 probe_;
  int x_, y_;
};

}  // namespace

MapCheck::MapCheck(const Traces& traces, double tolerance)
    : traces_(traces),
      half_edges_(traces.half_edges),
      mesh_(traces.half_edges.mesh),
      tolerance_(tolerance),
      map_(traces, tolerance),
      state_(traces.half_edges.corner.size() / 3, Mapped),
      sheets_(mesh_.n_faces()) {}

std::vector<int> MapCheck::far_vertices() {
  map_all();
  std::vector<int> result;
  check_holes(result);
  check_faces(result);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

void MapCheck::map_all() {
  parallel_for(state_.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
    std::vector<Image> images;
    for (std::size_t t = begin; t < end; ++t) {
      if (!exists(t)) continue;
      const auto face = [&](std::size_t k) { return map_.face_of(half_edges_.corner[3 * t + k]); };
      state_[t] = map_.map_triangle(t, images) ? Mapped : Hole;
      if (state_[t] == Hole) continue;
      for (const Image& image : images) {
        if (image.face != face(0) && image.face != face(1) && image.face != face(2)) state_[t] = Wide;
        if (const int sheets = View(map_.points_of(image.face)).sheets_over(image); sheets != 0)
          sheets_[image.face].fetch_add(sheets, std::memory_order_relaxed);
      }
    }
  });
}

/// New faces that the map may not cover whole: those that the rims of its holes cross, for there the number of sheets
/// changes within a face, and those that no sheet covers.
std::vector<MapCheck::Doubt> MapCheck::doubts() const {
  std::vector<int> place(sheets_.size(), -1);
  std::vector<Doubt> result;
  const auto add = [&](int face) -> Doubt& {
    if (place[face] < 0) place[face] = static_cast<int>(result.size()), result.push_back({face, {}, {}});
    return result[place[face]];
  };
  std::vector<Segment> segments;
  for (int half = 0; half < static_cast<int>(3 * state_.size()); ++half) {
    const int twin = state_[triangle_of(half)] == Hole ? half_edges_.adjacency.twin(half) : -1;
    if (twin < 0 || state_[triangle_of(twin)] == Hole) continue;
    map_.map_edge(half, segments);
    for (const Segment& segment : segments) add(segment.face).rim.push_back(segment);
  }
  for (const FaceHandle face : mesh_.all_faces())
    if (!mesh_.status(face).deleted() && sheets_[face.idx()] == 0) add(face.idx());
  if (result.empty()) return result;
  std::vector<Image> images;
  for (std::size_t t = 0; t < state_.size(); ++t) {
    if (!exists(t) || state_[t] == Hole) continue;
    const auto in_doubt = [&](std::size_t k) { return place[map_.face_of(half_edges_.corner[3 * t + k])] >= 0; };
    if (state_[t] != Wide && !in_doubt(0) && !in_doubt(1) && !in_doubt(2)) continue;
    map_.map_triangle(t, images);
    for (const Image& image : images)
      if (place[image.face] >= 0) result[place[image.face]].images.push_back(image);
  }
  return result;
}

/// Holes of the map, against the new surface.
void MapCheck::check_holes(std::vector<int>& far) const {
  std::vector<int> holes;
  for (std::size_t t = 0; t < state_.size(); ++t)
    if (state_[t] == Hole) holes.push_back(static_cast<int>(t));
  if (holes.empty()) return;
  const Closest closest(map_.new_surface());
  std::vector<char> near(holes.size(), 0);
  parallel_for(holes.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto point = [&](int k) { return traces_.old[half_edges_.corner[3 * holes[i] + k]].point; };
      near[i] = triangle_near(closest, point(0), point(1), point(2), -1, kNearDepth);
    }
  });
  for (std::size_t i = 0; i < holes.size(); ++i)
    for (int k = 0; !near[i] && k < 3; ++k) far.push_back(half_edges_.corner[3 * holes[i] + k]);
}

/// What goes to faces in doubt or round them: no point is nearer to this part of the old surface than to the whole.
Mesh MapCheck::old_surface_round(const std::vector<Doubt>& doubt) const {
  std::vector<char> marked(mesh_.n_vertices(), 0);
  for (const Doubt& d : doubt)
    for (const int v : map_.corners(d.face)) marked[v] = 1;
  const auto is_round = [&](int v) {
    const int face = map_.face_of(v);
    return face < 0 || std::ranges::any_of(map_.corners(face), [&](int c) { return marked[c] != 0; });
  };
  Mesh old;
  for (const Traces::OldVertex& v : traces_.old) old.vertices.push_back(v.point);
  for (std::size_t t = 0; t < state_.size(); ++t)
    if (const int* c = &half_edges_.corner[3 * t]; exists(t) && (is_round(c[0]) || is_round(c[1]) || is_round(c[2])))
      old.triangles.emplace_back(c[0], c[1], c[2]);
  return old;
}

/// Faces that may not be covered, against the old surface. Where one is far off, what was near its corners stays, and
/// what went to it.
void MapCheck::check_faces(std::vector<int>& far) const {
  const std::vector<Doubt> doubt = doubts();
  if (doubt.empty()) return;
  const Mesh old = old_surface_round(doubt);
  if (old.empty()) {
    for (const Doubt& d : doubt) far.push_back(half_edges_.corner[traces_.anchor[map_.corners(d.face)[0]].half]);
    return;
  }
  const Closest closest(old);
  std::vector<char> near(doubt.size(), 0);
  parallel_for(doubt.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      near[i] = covered_or_near(closest, doubt[i], doubt[i].rim, map_.points_of(doubt[i].face), kNearDepth);
    }
  });
  std::vector<char> is_far(sheets_.size(), 0);
  for (std::size_t i = 0; i < doubt.size(); ++i) {
    if (near[i]) continue;
    is_far[doubt[i].face] = 1;
    for (const int v : map_.corners(doubt[i].face))
      for (int half = 3 * triangle_of(traces_.anchor[v].half), k = 0; k < 3; ++k)
        far.push_back(half_edges_.corner[half + k]);
  }
  for (int v = 0; v < static_cast<int>(traces_.old.size()); ++v)
    if (map_.face_of(v) >= 0 && is_far[map_.face_of(v)]) far.push_back(v);
}

/// Of a part of a face: no rim crosses it and there is a sheet, or it is near; or this is so for its halves.
bool MapCheck::covered_or_near(const Closest& closest, const Doubt& doubt, const std::vector<Segment>& rim,
                               const std::array<Vec3, 3>& p, int depth) const {
  const Vec3 lower = glm::min(p[0], glm::min(p[1], p[2])), upper = glm::max(p[0], glm::max(p[1], p[2]));
  const double slack = 1e-9 * glm::length(upper - lower);  // segments are in the face but for rounding
  std::vector<Segment> crossing;
  for (const Segment& s : rim) {
    const Vec3 low = glm::min(s.a, s.b) - slack, high = glm::max(s.a, s.b) + slack;
    if (glm::all(glm::lessThanEqual(low, upper)) && glm::all(glm::greaterThanEqual(high, lower))) crossing.push_back(s);
  }
  if (crossing.empty()) {
    const View view(p);
    int sheets = 0;
    for (const Image& image : doubt.images) sheets += view.sheets_over(image);
    return sheets != 0 || triangle_near(closest, p[0], p[1], p[2], -1, depth);
  }
  const double side[3] = {glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])};
  const int longest = side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2;
  if (depth == 0 || side[longest] < tolerance_) return triangle_near(closest, p[0], p[1], p[2], -1, depth);
  const Vec3 &a = p[longest], &b = p[(longest + 1) % 3], &tip = p[(longest + 2) % 3], half = 0.5 * (a + b);
  return covered_or_near(closest, doubt, crossing, {a, half, tip}, depth - 1) &&
         covered_or_near(closest, doubt, crossing, {half, b, tip}, depth - 1);
}

/// Points near one triangle are a convex set; what is not near any one as a whole is halved. `hint` is a triangle
/// nearby, or -1.
bool MapCheck::triangle_near(const Closest& closest, const Vec3& a, const Vec3& b, const Vec3& c, int hint,
                             int depth) const {
  const Vec3 centre = (a + b + c) / 3.0;
  double limit = tolerance_;
  if (hint >= 0) limit = std::min(limit, closest.distance_to(hint, centre));
  // A little more, so that the hint itself is found again.
  const Closest::Hit hit = closest(centre, limit * (1 + 1e-12));
  if (!(hit.distance <= tolerance_)) return false;
  if (closest.distance_to(hit.triangle, a) <= tolerance_ && closest.distance_to(hit.triangle, b) <= tolerance_ &&
      closest.distance_to(hit.triangle, c) <= tolerance_)
    return true;
  if (depth == 0) return false;
  const auto halves = [&](const Vec3& p, const Vec3& q, const Vec3& tip) {
    const Vec3 half = 0.5 * (p + q);
    return triangle_near(closest, p, half, tip, hit.triangle, depth - 1) &&
           triangle_near(closest, half, q, tip, hit.triangle, depth - 1);
  };
  const double ab = glm::length(b - a), bc = glm::length(c - b), ca = glm::length(a - c);
  return ab >= bc && ab >= ca ? halves(a, b, c) : bc >= ca ? halves(b, c, a) : halves(c, a, b);
}

}  // namespace riffler
