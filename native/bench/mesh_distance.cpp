#include "bench/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "riffler/base/parallel.hpp"

namespace riffler::bench {

namespace {

double squared(const Vec3& v) {
  return glm::dot(v, v);
}

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double length = squared(b - a);
  const double t = length > 0 ? std::clamp(glm::dot(p - a, b - a) / length, 0.0, 1.0) : 0.0;
  return squared(a + t * (b - a) - p);
}

}  // namespace

double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = glm::cross(b - a, c - a);
  const auto left = [&](const Vec3& from, const Vec3& to) { return glm::dot(glm::cross(to - from, p - from), n) >= 0; };
  if (squared(n) > 0 && left(a, b) && left(b, c) && left(c, a)) {
    const double height = glm::dot(p - a, n);
    return height * height / squared(n);
  }
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

MeshDistance::MeshDistance(const Mesh& mesh) : mesh_(mesh) {
  if (mesh.empty()) throw std::invalid_argument("the mesh has no triangles");
  const Box3 box = bounds(mesh);
  // Twice the edge of a triangle of mean area; not so small that flat pieces of large triangles become many.
  const double even = 2 * std::sqrt(area(mesh) / static_cast<double>(mesh.triangles.size()));
  side_ = std::max(std::min(even, glm::length(box.size()) / 100), glm::length(box.size()) / 2000);
  origin_ = box.lower;
  for (int k = 0; k < 3; ++k) counts_[k] = static_cast<int>(box.size()[k] / side_) + 1;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const Vec3i& t = mesh.triangles[n];
    insert(static_cast<int>(n), mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]);
  }
}

Vec3i MeshDistance::cell_of(const Vec3& p) const {
  Vec3i out;
  for (int k = 0; k < 3; ++k) {
    const double at = std::floor((p[k] - origin_[k]) / side_);
    out[k] = static_cast<int>(std::clamp(at, 0.0, static_cast<double>(counts_[k] - 1)));
  }
  return out;
}

void MeshDistance::insert(int triangle, const Vec3& a, const Vec3& b, const Vec3& c) {
  // Halve the triangle across its longest side until its box is small.
  const double ab = squared(b - a), bc = squared(c - b), ca = squared(a - c);
  if (const double longest = std::max({ab, bc, ca}); longest > 4 * side_ * side_) {
    if (longest > ab && longest == bc) return insert(triangle, b, c, a);
    if (longest > ab) return insert(triangle, c, a, b);
    const Vec3 middle = 0.5 * (a + b);
    insert(triangle, a, middle, c);
    return insert(triangle, middle, b, c);
  }
  const Vec3i from = cell_of(glm::min(glm::min(a, b), c)), to = cell_of(glm::max(glm::max(a, b), c));
  for (int i = from.x; i <= to.x; ++i)
    for (int j = from.y; j <= to.y; ++j)
      for (int k = from.z; k <= to.z; ++k) {
        std::vector<int>& list = cells_[(static_cast<std::size_t>(i) * counts_.y + j) * counts_.z + k];
        if (list.empty() || list.back() != triangle) list.push_back(triangle);
      }
}

double MeshDistance::in_cell(const Vec3i& cell, const Vec3& p, double least) const {
  const auto found = cells_.find((static_cast<std::size_t>(cell.x) * counts_.y + cell.y) * counts_.z + cell.z);
  if (found == cells_.end()) return least;
  for (const int n : found->second) {
    const Vec3i& t = mesh_.triangles[n];
    least = std::min(least, squared_distance(p, mesh_.vertices[t.x], mesh_.vertices[t.y], mesh_.vertices[t.z]));
  }
  return least;
}

double MeshDistance::operator()(const Vec3& p) const {
  const Vec3i middle = cell_of(p);
  const Vec3 lower = origin_ + side_ * Vec3(middle);
  double least = std::numeric_limits<double>::infinity();
  for (int ring = 0; ring <= std::max({counts_.x, counts_.y, counts_.z}); ++ring) {
    for (int i = std::max(0, middle.x - ring); i <= std::min(counts_.x - 1, middle.x + ring); ++i)
      for (int j = std::max(0, middle.y - ring); j <= std::min(counts_.y - 1, middle.y + ring); ++j) {
        const bool wall = std::abs(i - middle.x) == ring || std::abs(j - middle.y) == ring;
        for (int k = middle.z - ring; k <= middle.z + ring; k += wall || ring == 0 ? 1 : 2 * ring)
          if (k >= 0 && k < counts_.z) least = in_cell({i, j, k}, p, least);
      }
    // Triangles beyond the examined rings are at least as far away as the rings' wall.
    double wall = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      if (middle[k] - ring > 0) wall = std::min(wall, p[k] - lower[k] + ring * side_);
      if (middle[k] + ring < counts_[k] - 1) wall = std::min(wall, lower[k] + (ring + 1) * side_ - p[k]);
    }
    if (wall > 0 && least <= wall * wall) break;
  }
  return std::sqrt(least);
}

std::vector<double> MeshDistance::operator()(std::span<const Vec3> points) const {
  std::vector<double> out(points.size());
  base::parallel_for(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) out[n] = (*this)(points[n]);
  });
  return out;
}

}  // namespace riffler::bench
