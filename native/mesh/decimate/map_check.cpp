#include "mesh/decimate/map_check.hpp"

#include <algorithm>
#include <limits>

#include "base/sort_unique.hpp"
#include "mesh/decimate/near_surface.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using Image = SurfaceMap::Image;
using Segment = SurfaceMap::Segment;

/// Maximum number of halvings of a face along the rims in it.
constexpr int kRimDepth = 24;

/// Maximum number of its pieces, because a depth of 24 does not limit the work; a triangle that needs more counts as
/// far.
constexpr int kMaxPieces = 1 << 12;

/// Maximum number of pieces of all faces in memory at a time.
constexpr std::size_t kMaxHeld = 1 << 22;

/// Initial size of pieces along a rim, in tolerances.
constexpr double kCoarse = 32;

/// Contribution of the edge from (ax, ay) to (bx, by) to the winding number about the origin. Contributions of an edge
/// in both directions cancel.
int winding(double ax, double ay, double bx, double by) {
  if (ay <= 0 && 0 < by) return ax * by - bx * ay > 0 ? 1 : 0;
  if (by <= 0 && 0 < ay) return bx * ay - ax * by > 0 ? -1 : 0;
  return 0;
}

/// An interior point of a triangle, unlikely to be on a line of a regular mesh.
Vec3 probe_of(const std::array<Vec3, 3>& p) {
  return p[0] + 0.3304 * (p[1] - p[0]) + 0.3125 * (p[2] - p[0]);
}

/// A face seen along the axis closest to its normal, relative to its probe point.
class View {
 public:
  explicit View(const std::array<Vec3, 3>& p) : probe_(probe_of(p)) {
    const Vec3 size = glm::abs(glm::cross(p[1] - p[0], p[2] - p[0]));
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    x_ = (axis + 1) % 3, y_ = (axis + 2) % 3;
  }
  /// How often a piece of the map's image lies over the probe point, signed by its orientation.
  int sheets_over(const SurfaceMap::Image& image) const {
    const Vec3 a = image.a - probe_, b = image.b - probe_, c = image.c - probe_;
    return winding(a[x_], a[y_], b[x_], b[y_]) + winding(b[x_], b[y_], c[x_], c[y_]) +
           winding(c[x_], c[y_], a[x_], a[y_]);
  }
  /// Contribution of this line to the difference of the winding number about q minus that about the probe point.
  int winding_beyond(const SurfaceMap::Segment& line, const Vec3& q) const {
    const Vec3 way = q - probe_, a = line.a - probe_, b = line.b - probe_;
    const bool a_left = cross(way, a) > 0, b_left = cross(way, b) > 0;
    if (a_left == b_left) return 0;
    const bool from_left = cross(b - a, -a) > 0, to_left = cross(b - a, way - a) > 0;
    return from_left == to_left ? 0 : to_left ? 1 : -1;
  }

 private:
  double cross(const Vec3& u, const Vec3& v) const { return u[x_] * v[y_] - u[y_] * v[x_]; }

  Vec3 probe_;
  int x_, y_;
};

/// Whether a line may touch a box; `slack` covers rounding.
bool touches(const Segment& s, const Vec3& lower, const Vec3& upper, double slack) {
  return glm::all(glm::lessThanEqual(glm::min(s.a, s.b) - slack, upper)) &&
         glm::all(glm::greaterThanEqual(glm::max(s.a, s.b) + slack, lower));
}

/// Grows from `seeds` to neighbours, and continues from those within `reach` of `place`. Returns the seeds and these,
/// in order. for_each_neighbour(t, visit) calls visit(neighbour).
template <class Points, class Neighbours>
std::vector<int> grown(std::vector<int> seeds, std::size_t n, const std::vector<Corners>& place, double reach,
                       const Points& points, const Neighbours& for_each_neighbour) {
  base::sort_unique(seeds);
  std::vector<char> seen(n, 0);
  for (const int t : seeds) seen[t] = 1;
  const Closest closest(mesh_of(place));
  for (std::size_t next = 0; next < seeds.size(); ++next)
    for_each_neighbour(seeds[next], [&](int t) {
      if (seen[t]) return;
      seen[t] = 1;
      const Corners p = points(t);
      const Vec3 centre = (p[0] + p[1] + p[2]) / 3.0;
      const double radius =
          std::max({glm::length(p[0] - centre), glm::length(p[1] - centre), glm::length(p[2] - centre)});
      if (closest.within(centre, radius + reach)) seeds.push_back(t);
    });
  std::sort(seeds.begin(), seeds.end());
  return seeds;
}

}  // namespace

MapCheck::MapCheck(const Traces& traces, double tolerance, const Progress& progress)
    : traces_(traces),
      half_edges_(traces.half_edges),
      mesh_(traces.half_edges.mesh),
      tolerance_(tolerance),
      map_(traces, tolerance, progress),
      hole_(traces.half_edges.corner.size() / 3, 0),
      sheets_(mesh_.n_faces()) {}

std::vector<int> MapCheck::far_vertices(const Progress& progress) {
  map_all(base::part(progress, 0, 0.8));
  std::vector<int> result;
  check_holes(result, base::part(progress, 0.8, 0.9));
  check_faces(result, base::part(progress, 0.9, 1));
  base::sort_unique(result);
  return result;
}

Corners MapCheck::old_points(int t) const {
  const auto point = [&](int k) { return traces_.old[half_edges_.corner[3 * t + k]].point; };
  return {point(0), point(1), point(2)};
}

void MapCheck::map_all(const Progress& progress) {
  const auto map_part = [&](std::size_t begin, std::size_t end) {
    std::vector<Image> images;
    int face = -1;  // face that `view` belongs to
    View view({});
    for (std::size_t t = begin; t < end; ++t) {
      if (!exists(t)) continue;
      hole_[t] = !map_.map_triangle(t, images);
      if (hole_[t]) continue;
      for (const Image& image : images) {
        if (image.face != face) face = image.face, view = View(map_.points_of(face));
        if (const int sheets = view.sheets_over(image); sheets != 0)
          sheets_[face].fetch_add(sheets, std::memory_order_relaxed);
      }
    }
  };
  base::parallel_for(hole_.size(), 1 << 12, map_part, progress);
  for (std::size_t t = 0; t < hole_.size(); ++t)
    if (hole_[t]) holes_.push_back(static_cast<int>(t));
}

/// New faces that the map may not cover completely: those crossed by the rims of its holes, because the number of
/// sheets changes inside them, and those without a sheet.
std::vector<MapCheck::Doubt> MapCheck::doubts() const {
  std::vector<int> place(sheets_.size(), -1);
  std::vector<Doubt> result;
  const auto add = [&](int face) -> Doubt& {
    if (place[face] < 0) place[face] = static_cast<int>(result.size()), result.push_back({face, {}, true});
    return result[place[face]];
  };
  std::vector<Segment> segments;
  for (const int t : holes_)
    for (int half = 3 * t; half < 3 * t + 3; ++half) {
      const int twin = half_edges_.adjacency.twin(half);
      if (twin < 0 || hole_[triangle_of(twin)]) continue;
      map_.map_edge(half, segments);
      for (const Segment& segment : segments) add(segment.face).rim.push_back(segment);
    }
  for (const FaceHandle face : mesh_.all_faces())
    if (!mesh_.status(face).deleted() && sheets_[face.idx()] == 0) add(face.idx());
  for (Doubt& doubt : result) {
    const Corners p = map_.points_of(doubt.face);
    const Vec3 probe = probe_of(p);
    const double slack = 1e-9 * (glm::length(p[1] - p[0]) + glm::length(p[2] - p[0]));
    for (const Segment& segment : doubt.rim) doubt.known = doubt.known && !touches(segment, probe, probe, slack);
  }
  return result;
}

/// Faces of the new surface around `place`, found from `seeds`.
std::vector<int> MapCheck::new_faces_near(const std::vector<Corners>& place, std::vector<int> seeds) const {
  return grown(
      std::move(seeds), mesh_.n_faces(), place, tolerance_, [&](int face) { return map_.points_of(face); },
      [&](int face, const auto& visit) {
        HalfedgeHandle half = mesh_.halfedge_handle(FaceHandle(face));
        for (int k = 0; k < 3; ++k, half = mesh_.next_halfedge_handle(half))
          if (const HalfedgeHandle across = mesh_.opposite_halfedge_handle(half); !mesh_.is_boundary(across))
            visit(mesh_.face_handle(across).idx());
      });
}

/// Triangles of the old surface around `place`, found from `seeds`.
std::vector<int> MapCheck::old_triangles_near(const std::vector<Corners>& place, std::vector<int> seeds) const {
  return grown(
      std::move(seeds), hole_.size(), place, tolerance_, [&](int t) { return old_points(t); },
      [&](int t, const auto& visit) {
        for (int half = 3 * t; half < 3 * t + 3; ++half)
          if (const int twin = half_edges_.adjacency.twin(half); twin >= 0) visit(triangle_of(twin));
      });
}

/// For each triangle, whether it is near a surface.
std::vector<char> MapCheck::near(const std::vector<Corners>& place, const std::vector<Corners>& surface,
                                 const Progress& progress) const {
  std::vector<char> result(place.size(), 0);
  if (surface.empty()) return result;
  const NearSurface other(surface, tolerance_);
  const auto look = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      result[i] = other.holds(place[i], kMaxPieces);
      base::still_wanted();
    }
  };
  base::parallel_for(place.size(), 64, look, progress);
  return result;
}

/// Compares the holes of the map with the new surface around them.
void MapCheck::check_holes(std::vector<int>& far, const Progress& progress) const {
  if (holes_.empty()) return;
  std::vector<Corners> place, surface;
  std::vector<int> seeds;
  for (const int t : holes_) {
    place.push_back(old_points(t));
    for (int k = 0; k < 3; ++k)
      if (const int face = map_.face_of(half_edges_.corner[3 * t + k]); face >= 0) seeds.push_back(face);
  }
  for (const int face : new_faces_near(place, std::move(seeds))) surface.push_back(map_.points_of(face));
  const std::vector<char> is_near = near(place, surface, progress);
  for (std::size_t i = 0; i < holes_.size(); ++i)
    for (int k = 0; !is_near[i] && k < 3; ++k) far.push_back(half_edges_.corner[3 * holes_[i] + k]);
}

/// Compares faces that may not be covered with the old surface around them. For a face that is too far, adds the old
/// vertices near its corners, and those that map to it.
void MapCheck::check_faces(std::vector<int>& far, const Progress& progress) const {
  base::report(progress, 0);
  std::vector<Doubt> doubt = doubts();
  // Large pieces along the rims first: hardly any of them is too far, which would require separating the covered part.
  // Then whole faces: thin ones need many pieces along a rim, but few where the old triangles are large.
  double begin = 0.2;
  for (const double smallest : {kCoarse * tolerance_, std::numeric_limits<double>::infinity(), tolerance_}) {
    const std::vector<char> is_near = faces_near(doubt, smallest, base::part(progress, begin, begin + 0.25));
    begin += 0.25;
    std::size_t left = 0;
    for (std::size_t i = 0; i < doubt.size(); ++i)
      if (!is_near[i]) std::swap(doubt[left++], doubt[i]);
    doubt.resize(left);
    if (doubt.empty()) return;
  }
  std::vector<char> is_far(sheets_.size(), 0);
  for (const Doubt& d : doubt) {
    is_far[d.face] = 1;
    for (const int v : map_.corners(d.face))
      for (int half = 3 * triangle_of(traces_.anchor[v].half), k = 0; k < 3; ++k)
        far.push_back(half_edges_.corner[half + k]);
  }
  for (int v = 0; v < static_cast<int>(traces_.old.size()); ++v)
    if (map_.face_of(v) >= 0 && is_far[map_.face_of(v)]) far.push_back(v);
}

/// Whether the uncovered part of each face is near the old surface around it. Pieces along the rims may be as large as
/// `smallest`.
std::vector<char> MapCheck::faces_near(const std::vector<Doubt>& doubt, double smallest,
                                       const Progress& progress) const {
  std::vector<char> result(doubt.size(), 1);
  std::vector<std::vector<Corners>> pieces(doubt.size());
  const int most =
      static_cast<int>(std::clamp<std::size_t>(kMaxHeld / std::max<std::size_t>(1, doubt.size()), 64, kMaxPieces));
  const auto divide = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      int left = most;
      const Corners whole = map_.points_of(doubt[i].face);
      if (!add_uncovered(doubt[i], doubt[i].rim, whole, smallest, kRimDepth, left, pieces[i]))
        pieces[i].clear(), result[i] = 0;
      base::still_wanted();
    }
  };
  base::parallel_for(doubt.size(), 16, divide, base::part(progress, 0, 0.5));
  std::vector<Corners> place, surface;
  std::vector<std::size_t> whose;
  std::vector<int> seeds = holes_;
  for (std::size_t i = 0; i < doubt.size(); ++i) {
    if (pieces[i].empty()) continue;
    place.insert(place.end(), pieces[i].begin(), pieces[i].end());
    whose.resize(place.size(), i);
    for (const int v : map_.corners(doubt[i].face)) seeds.push_back(triangle_of(traces_.anchor[v].half));
  }
  if (place.empty()) return result;
  for (const int t : old_triangles_near(place, std::move(seeds))) surface.push_back(old_points(t));
  const std::vector<char> is_near = near(place, surface, base::part(progress, 0.5, 1));
  for (std::size_t i = 0; i < place.size(); ++i)
    if (!is_near[i]) result[whose[i]] = 0;
  return result;
}

/// Adds the uncovered parts of a piece of a face to `pieces`. A piece that no rim crosses is covered if there is a
/// sheet, and otherwise added whole; any other piece is halved. Returns false if that takes more than `left` pieces.
bool MapCheck::add_uncovered(const Doubt& doubt, const std::vector<Segment>& rim, const Corners& p, double smallest,
                             int depth, int& left, std::vector<Corners>& pieces) const {
  if (left-- <= 0) return false;
  const Vec3 lower = glm::min(p[0], glm::min(p[1], p[2])), upper = glm::max(p[0], glm::max(p[1], p[2]));
  const double slack = 1e-9 * glm::length(upper - lower);  // segments lie in the face up to rounding
  std::vector<Segment> crossing;
  for (const Segment& s : rim)
    if (touches(s, lower, upper, slack)) crossing.push_back(s);
  if (crossing.empty() && doubt.known) {
    const View view(map_.points_of(doubt.face));
    const Vec3 q = probe_of(p);
    int sheets = sheets_[doubt.face];
    // Half-edges of holes: those of the adjacent mapped triangles run in the opposite direction.
    for (const Segment& s : doubt.rim) sheets -= view.winding_beyond(s, q);
    if (sheets != 0) return true;
  }
  const double side[3] = {glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])};
  const int longest = side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2;
  if (crossing.empty() || depth == 0 || side[longest] < smallest) {
    pieces.push_back(p);
    return true;
  }
  const Vec3 &a = p[longest], &b = p[(longest + 1) % 3], &tip = p[(longest + 2) % 3], half = 0.5 * (a + b);
  return add_uncovered(doubt, crossing, {a, half, tip}, smallest, depth - 1, left, pieces) &&
         add_uncovered(doubt, crossing, {half, b, tip}, smallest, depth - 1, left, pieces);
}

}  // namespace riffler::mesh
