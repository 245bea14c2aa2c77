#include "riffler/plan/contact_location.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "riffler/plan/cc_frame.hpp"

namespace riffler::plan {

namespace {

/// Below this sine of the angle between axis and normal, the contact may lie anywhere on the contact circle.
constexpr double kParallel = 1e-12;

/// From the tip to the cutter's furthest point against `normal`.
Vec3 touching_point(const CutterSupport& cutter, const Vec3& normal, const Vec3& axis, const Vec3& feed) {
  const double up = glm::dot(normal, axis);
  const Vec3 across = glm::cross(glm::cross(axis, normal), axis);  // normal − (n·O) O, without cancellation
  const double sine = glm::length(across);
  const Vec3 out = sine > kParallel ? -across / sine : cc_frame(feed, axis).x;
  const Vec2 at = cutter.point({sine > kParallel ? sine : 0.0, -up});
  return at.x * out + at.y * axis;
}

}  // namespace

CutterSupport::CutterSupport(const Tool& tool) : top_(tool.length()) {
  Vec2 from{0, 0};
  corners_.push_back(from);
  for (const tool::ProfileSegment& s : tool.profile().segments()) {
    const bool bulges = s.centre && from.x + s.to.x >= 2 * s.centre->x;
    if (bulges) arcs_.push_back({*s.centre, from, s.to, glm::length(from - *s.centre)});
    if (bulges && arcs_.size() == 1 && corners_.size() == 1 && s.centre->x == 0) ball_radius_ = arcs_[0].radius;
    corners_.push_back(from = s.to);
  }
  for (const Vec2& c : corners_) size_ = std::max({size_, c.x, c.y});
}

Vec2 CutterSupport::point(const Vec2& d) const {
  Vec2 best{0, 0};
  double most = 0;
  // Equal up to rounding counts as equal: then take the outer of two points at one height, otherwise the lower.
  const double same = 1e-14 * size_ * (std::abs(d.x) + std::abs(d.y));
  const auto look = [&](const Vec2& p) {
    const double reach = glm::dot(d, p);
    const bool preferred = p.y == best.y ? p.x > best.x : p.y < best.y;
    if (reach > most + same || (reach >= most - same && preferred)) best = p, most = std::max(most, reach);
  };
  for (const Vec2& c : corners_) look(c);
  const double length = glm::length(d);
  for (const Arc& a : arcs_) {
    const Vec2 p = a.centre + d * (a.radius / length);
    if (p.x >= 0 && p.y > a.from.y && p.y < a.to.y) look(p);
  }
  return best;
}

Pose location_of_contact(const CutterSupport& cutter, const Vec3& contact, const Vec3& normal, const Vec3& axis,
                         const Vec3& feed) {
  const Vec3 at = touching_point(cutter, normal, axis, feed);
  if (glm::dot(normal, axis) < -kParallel && glm::dot(at, axis) >= cutter.top() * (1 - 1e-12))
    throw std::invalid_argument("only the cutter's upper end could touch there: the axis points into the part");
  return {contact - at, axis};
}

Pose location_on_path(const CutterSupport& cutter, const PencilPath& path, std::size_t k, const Vec3& axis) {
  const double r = path.radius;
  if (std::abs(cutter.ball_radius() - r) <= 1e-9 * r) return {path.centres[k] - r * axis, axis};
  Vec3 normal[2], point[2];
  const Vec3 feed = feed_at(path, k);
  for (int side = 0; side < 2; ++side) {
    const Vec3 way = path.centres[k] - path.contacts[k][side];
    normal[side] = glm::length(way) > 1e-9 * r ? glm::normalize(way) : path.normals[k][side];
    point[side] = touching_point(cutter, normal[side], axis, feed);
  }
  const Vec3 line = glm::cross(normal[0], normal[1]);  // direction of the line in which the two offset planes intersect
  const double square = glm::dot(line, line);
  if (square < 1e-12) return location_of_contact(cutter, path.contacts[k][0], normal[0], axis, feed);
  const double b0 = glm::dot(normal[0], path.contacts[k][0] - point[0]);
  const double b1 = glm::dot(normal[1], path.contacts[k][1] - point[1]);
  const double along = glm::dot(line, path.centres[k] - 0.5 * (point[0] + point[1]));
  // Intersection of three planes (Goldman, Graphics Gems, 1990, 305).
  return {(b0 * glm::cross(normal[1], line) + b1 * glm::cross(line, normal[0]) + along * line) / square, axis};
}

}  // namespace riffler::plan
