#include "riffler/plan/path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "riffler/base/check.hpp"

namespace riffler::plan {

double PencilPath::length() const {
  double sum = 0;
  for (std::size_t k = 1; k < centres.size(); ++k) sum += glm::length(centres[k] - centres[k - 1]);
  return closed && centres.size() > 1 ? sum + glm::length(centres.front() - centres.back()) : sum;
}

namespace {

constexpr double kMaxPoints = 1e7;

Vec3 between(const Vec3& a, const Vec3& b, double t) {
  return a + t * (b - a);
}

/// Interpolates two unit vectors; the first if they are opposite.
Vec3 normal_between(const Vec3& a, const Vec3& b, double t) {
  const Vec3 sum = between(a, b, t);
  const double length = glm::length(sum);
  return length > 0 ? sum / length : a;
}

}  // namespace

PencilPath divided(const PencilPath& path, double step) {
  base::require_positive(step, "step", base::kPositiveAndFinite);
  if (path.length() / step > kMaxPoints) throw std::invalid_argument("step is too short: more than ten million points");
  PencilPath out;
  out.radius = path.radius, out.closed = path.closed;
  const std::size_t n = path.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t next = (k + 1) % n;
    const bool edge = k + 1 < n || (path.closed && n > 1);
    const double parts = edge ? std::ceil(glm::length(path.centres[next] - path.centres[k]) / step * (1 - 1e-12)) : 1;
    for (int i = 0; i < std::max(1.0, parts); ++i) {
      const double t = i / parts;
      out.centres.push_back(i == 0 ? path.centres[k] : between(path.centres[k], path.centres[next], t));
      auto& contacts = out.contacts.emplace_back(path.contacts[k]);
      auto& normals = out.normals.emplace_back(path.normals[k]);
      for (int side = 0; i > 0 && side < 2; ++side) {
        contacts[side] = between(path.contacts[k][side], path.contacts[next][side], t);
        normals[side] = normal_between(path.normals[k][side], path.normals[next][side], t);
      }
    }
  }
  return out;
}

}  // namespace riffler::plan
