#include "riffler/plan/cc_frame.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/hypot.hpp"

namespace riffler::plan {

namespace {

/// The component of `v` orthogonal to the unit vector `n`, normalised; zero if it is only rounding noise.
Vec3 square_part(const Vec3& v, const Vec3& n) {
  const double scale = glm::length(v);
  if (!(scale > 0)) return Vec3(0);
  // Orthogonalise twice, so that the result is orthogonal to `n` up to rounding however short it is ("twice is enough",
  // Parlett, The Symmetric Eigenvalue Problem, 6.9).
  Vec3 rest = v / scale;
  const double before = glm::length(rest -= glm::dot(rest, n) * n);
  if (before < 1e-12) return Vec3(0);
  rest -= glm::dot(rest, n) * n;
  return glm::normalize(rest);
}

Vec3 coordinate_axis_far_from(const Vec3& n) {
  const Vec3 size = glm::abs(n);
  Vec3 out(0);
  out[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1;
  return out;
}

/// Direction from the contact to the ball's centre; the part's normal if the two coincide.
Vec3 direction(const PencilPath& path, std::size_t k, int side) {
  const Vec3 way = path.centres[k] - path.contacts[k][side];
  const double length = glm::length(way);
  return length > 1e-9 * path.radius && length > 0 ? way / length : path.normals[k][side];
}

}  // namespace

CcFrame cc_frame(const Vec3& feed, const Vec3& normal) {
  Vec3 x = square_part(feed, normal);
  if (x == Vec3(0)) x = square_part(coordinate_axis_far_from(normal), normal);
  return {x, glm::cross(normal, x), normal};
}

Vec3 axis_of(const CcFrame& frame, const Lean& lean) {
  const double flat = base::cos(lean.tilt);
  return glm::normalize(flat * base::sin(lean.inclination) * frame.x + base::sin(lean.tilt) * frame.y +
                        flat * base::cos(lean.inclination) * frame.z);
}

Lean lean_of(const CcFrame& frame, const Vec3& axis) {
  const double x = glm::dot(axis, frame.x), y = glm::dot(axis, frame.y), z = glm::dot(axis, frame.z);
  const double flat = geom::hypot(x, z);
  return {flat > 1e-15 ? base::atan2(x, z) : 0.0, base::atan2(y, flat)};
}

Vec3 feed_at(const PencilPath& path, std::size_t k) {
  const std::size_t n = path.size();
  if (n < 2) return Vec3(0);
  const std::size_t before = k > 0 ? k - 1 : path.closed ? n - 1 : 0;
  const std::size_t after = k + 1 < n ? k + 1 : path.closed ? 0 : n - 1;
  const Vec3 way = path.centres[after] - path.centres[before];
  const double length = glm::length(way);
  return length > 0 ? way / length : Vec3(0);
}

Vec3 bisector_at(const PencilPath& path, std::size_t k) {
  const Vec3 a = direction(path, k, 0), b = direction(path, k, 1), sum = a + b;
  const double length = glm::length(sum);
  if (length > 1e-9) return sum / length;
  return glm::normalize(glm::cross(cc_frame(feed_at(path, k), a).x, a));
}

CcFrame frame_at(const PencilPath& path, std::size_t k) {
  return cc_frame(feed_at(path, k), bisector_at(path, k));
}

Vec3 unit_axis(const Vec3& axis, std::string_view what) {
  if (!geom::finite(axis)) throw std::invalid_argument(std::string(what) + ": not finite");
  const double length = glm::length(axis);
  if (!(std::abs(length - 1) < 1e-6)) throw std::invalid_argument(std::string(what) + ": not a unit vector");
  return std::abs(length - 1) < 1e-15 ? axis : axis / length;
}

}  // namespace riffler::plan
