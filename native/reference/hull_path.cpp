#include "reference/hull_path.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

namespace riffler::reference {

namespace {

glm::dquat orientation(const RolledPose& p) {
  const Vec3 z = glm::normalize(p.axis), y = glm::normalize(glm::cross(z, p.forward)), x = glm::cross(y, z);
  return glm::normalize(glm::quat_cast(glm::dmat3(x, y, z)));
}

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double square = glm::dot(way, way);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0;
  return glm::length(p - (a + t * way));
}

}  // namespace

HullPath::HullPath(std::span<const std::vector<Vec3>> hulls, std::span<const RolledPose> poses, double step) {
  double reach = 0;
  for (const std::vector<Vec3>& corners : hulls) {
    bodies_.push_back(body_of(corners));
    for (const Vec3& p : corners) reach = std::max(reach, glm::length(p));
  }
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const glm::dquat from = orientation(poses[k]);
    glm::dquat to = orientation(poses[k + 1]);
    if (glm::dot(from, to) < 0) to = -to;
    const double angle = 2 * std::asin(std::min(1.0, glm::length(to - from) / 2)) * 2;
    const double moved = glm::length(poses[k + 1].tip - poses[k].tip) + angle * reach;
    const int n = std::max(1, static_cast<int>(std::ceil(moved / step)));
    for (int i = 0; i <= n; ++i) {
      const double t = static_cast<double>(i) / n;
      const glm::dquat q = glm::normalize(glm::slerp(from, to, t));
      poses_.push_back(
          {glm::mix(poses[k].tip, poses[k + 1].tip, t), q * Vec3(1, 0, 0), q * Vec3(0, 1, 0), q * Vec3(0, 0, 1)});
    }
  }
}

/// Each plane through three corners with all others on one side, once, with its corners sorted around it.
HullPath::Body HullPath::body_of(const std::vector<Vec3>& c) {
  Body body{{}, Vec3(0), 0};
  double size = 0;
  for (const Vec3& p : c) body.middle += p / static_cast<double>(c.size());
  for (const Vec3& p : c) body.radius = std::max(body.radius, glm::length(p - body.middle));
  size = body.radius;
  for (std::size_t i = 0; i < c.size(); ++i)
    for (std::size_t j = i + 1; j < c.size(); ++j)
      for (std::size_t k = j + 1; k < c.size(); ++k) {
        Vec3 n = glm::cross(c[j] - c[i], c[k] - c[i]);
        if (!(glm::length(n) > 1e-12 * size * size)) continue;
        n = glm::normalize(n);
        if (glm::dot(n, c[i] - body.middle) < 0) n = -n;
        const double offset = glm::dot(n, c[i]);
        Facet f{n, offset, {}};
        bool bounds = true;
        for (const Vec3& p : c) {
          bounds = bounds && glm::dot(n, p) - offset <= 1e-9 * size;
          if (std::abs(glm::dot(n, p) - offset) <= 1e-9 * size) f.corners.push_back(p);
        }
        const auto known = [&](const Facet& g) { return glm::length(g.normal - n) < 1e-7; };
        if (!bounds || std::any_of(body.facets.begin(), body.facets.end(), known)) continue;
        Vec3 centre(0);
        for (const Vec3& p : f.corners) centre += p / static_cast<double>(f.corners.size());
        const Vec3 u = glm::normalize(c[i] - centre), v = glm::cross(n, u);
        const auto turn = [&](const Vec3& p) { return std::atan2(glm::dot(p - centre, v), glm::dot(p - centre, u)); };
        std::sort(f.corners.begin(), f.corners.end(), [&](const Vec3& a, const Vec3& b) { return turn(a) < turn(b); });
        body.facets.push_back(std::move(f));
      }
  return body;
}

double HullPath::distance(const Body& body, const Vec3& p) {
  double inside = -std::numeric_limits<double>::infinity(), outside = -inside;
  for (const Facet& f : body.facets) {
    const double height = glm::dot(f.normal, p) - f.offset;
    inside = std::max(inside, height);
    if (height <= 0) continue;
    bool over = true;
    for (std::size_t k = 0; k < f.corners.size(); ++k) {
      const Vec3 a = f.corners[k], b = f.corners[(k + 1) % f.corners.size()];
      over = over && glm::dot(glm::cross(f.normal, b - a), p - a) >= 0;
      outside = std::min(outside, segment_distance(p, a, b));
    }
    if (over) outside = std::min(outside, height);
  }
  return inside <= 0 ? inside : outside;
}

double HullPath::operator()(const Vec3& p, double enough) const {
  double best = std::numeric_limits<double>::infinity();
  for (const Placed& at : poses_) {
    const Vec3 w = p - at.tip, q{glm::dot(w, at.x), glm::dot(w, at.y), glm::dot(w, at.z)};
    for (const Body& body : bodies_)
      if (glm::length(q - body.middle) - body.radius < std::min(best, enough)) best = std::min(best, distance(body, q));
  }
  return best;
}

}  // namespace riffler::reference
