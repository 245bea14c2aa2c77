#include "riffler/tool/hull.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace riffler::tool {

namespace {

/// Relative to the size.
constexpr double kCoplanar = 1e-10;

void check_points(std::span<const Vec3> points, const std::string& name) {
  if (points.size() < 4)
    throw std::invalid_argument(name + ": a body needs four points or more, not " + std::to_string(points.size()));
  if (points.size() > Hull::kMostPoints)
    throw std::invalid_argument(name + ": at most " + std::to_string(Hull::kMostPoints) + " points, not " +
                                std::to_string(points.size()) + "; leave out those that are no corners");
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::string where = name + ", point " + std::to_string(k) + ": ";
    if (!geom::finite(points[k])) throw std::invalid_argument(where + "not finite");
    for (int i = 0; i < 3; ++i)
      if (std::abs(points[k][i]) > Hull::kLargest) throw std::invalid_argument(where + "beyond 1e6 mm");
  }
}

double largest_distance(std::span<const Vec3> points) {
  double square = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) square = std::max(square, geom::squared_length(points[i] - points[k]));
  return std::sqrt(square);
}

/// The plane through three points, out of the body, with the area of their parallelogram; area 0 if other points lie
/// on both sides of it.
struct Candidate {
  HalfSpace face;
  double area = 0;
};
Candidate face_through(std::span<const Vec3> points, std::size_t a, std::size_t b, std::size_t c, double slack) {
  const Vec3 cross = glm::cross(points[b] - points[a], points[c] - points[a]);
  const double area = glm::length(cross);
  if (!(area > slack * slack)) return {};
  Vec3 n = cross / area;
  double above = 0, below = 0;
  for (const Vec3& p : points) {
    const double d = glm::dot(n, p - points[a]);
    above = std::max(above, d), below = std::min(below, d);
    if (above > slack && below < -slack) return {};
  }
  if (above > slack) n = -n, above = -below;
  return {{n, glm::dot(n, points[a]) + std::max(above, 0.0)}, area};
}

/// Whether all points that one face holds lie on the other face too, or the reverse.
bool same_face(const HalfSpace& f, const HalfSpace& g) {
  return glm::dot(f.normal, g.normal) > 0 && glm::length(glm::cross(f.normal, g.normal)) < 1e-8;
}

/// Each face once, by the widest three points that span it: rounding then changes its plane least.
std::vector<HalfSpace> faces_of(std::span<const Vec3> points, double size) {
  std::vector<Candidate> found;
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = a + 1; b < points.size(); ++b)
      for (std::size_t c = b + 1; c < points.size(); ++c) {
        const Candidate next = face_through(points, a, b, c, kCoplanar * size);
        if (next.area == 0) continue;
        const auto same =
            std::find_if(found.begin(), found.end(), [&](const Candidate& f) { return same_face(f.face, next.face); });
        if (same == found.end())
          found.push_back(next);
        else if (next.area > same->area)
          *same = next;
      }
  std::vector<HalfSpace> out;
  for (const Candidate& f : found) out.push_back(f.face);
  return out;
}

/// The least extent of the points across a face: they are hardly thinner in any other direction.
double thickness(std::span<const Vec3> points, const std::vector<HalfSpace>& faces, double size) {
  double least = size;
  for (const HalfSpace& f : faces) {
    double extent = 0;
    for (const Vec3& p : points) extent = std::max(extent, f.offset - glm::dot(f.normal, p));
    least = std::min(least, extent);
  }
  return faces.size() < 4 ? 0 : least;
}

}  // namespace

Hull make_hull(std::span<const Vec3> points, const std::string& name) {
  check_points(points, name);
  Hull out;
  out.size = largest_distance(points);
  out.faces = faces_of(points, out.size);
  if (!(thickness(points, out.faces, out.size) > Hull::kFlattest * out.size))
    throw std::invalid_argument(name + ": the body is flat; give it points that do not lie in one plane");
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::size_t on = 0;
    for (const HalfSpace& f : out.faces) on += f.offset - glm::dot(f.normal, points[k]) <= 4 * kCoplanar * out.size;
    if (on < 3 || std::find(points.begin(), points.begin() + k, points[k]) != points.begin() + k) continue;
    out.vertices.push_back(points[k]);
    out.reach = std::max(out.reach, glm::length(points[k]));
  }
  return out;
}

}  // namespace riffler::tool
