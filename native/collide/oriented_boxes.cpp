#include "collide/oriented_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "riffler/base/parallel.hpp"

namespace riffler::collide {

namespace {

using Axes = std::array<Vec3, 3>;

/// Eigenvectors of a symmetric matrix by Jacobi's rotations (Golub and Van Loan, Matrix Computations, 8.5).
Axes principal_axes(Mat3 m) {
  Axes v{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  for (int sweep = 0; sweep < 12; ++sweep)
    for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (std::abs(m[p][q]) <= 1e-15 * (std::abs(m[p][p]) + std::abs(m[q][q]))) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (int k = 0; k < 3; ++k) {
        const double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
      }
      for (int k = 0; k < 3; ++k) {
        const double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
      }
      const Vec3 a = v[p], b = v[q];
      v[p] = c * a - s * b, v[q] = s * a + c * b;
    }
  // Rounding leaves them not quite square to each other, which boxes must be.
  v[0] = glm::normalize(v[0]), v[1] = glm::normalize(v[1] - glm::dot(v[0], v[1]) * v[0]), v[2] = glm::cross(v[0], v[1]);
  return v;
}

template <class Visit>
void each_corner(std::span<const Corners> triangles, const Visit& visit) {
  for (const Corners& t : triangles) visit(t.a), visit(t.b), visit(t.c);
}

Axes axes_of(std::span<const Corners> triangles) {
  const Vec3 first = triangles.front().a;
  const double n = 3 * static_cast<double>(triangles.size());
  Vec3 mean(0);
  each_corner(triangles, [&](const Vec3& p) { mean += (p - first) / n; });
  Mat3 spread(0);
  each_corner(triangles, [&](const Vec3& p) { spread += glm::outerProduct(p - first - mean, p - first - mean); });
  return principal_axes(spread);
}

struct Box {
  Vec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

  double surface() const {
    const Vec3 size = high - low;
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

/// Relative to a place near the triangles: rounding is then that of the box's size.
Box box_of(std::span<const Corners> triangles, const Axes& axes, const Vec3& near) {
  Box out;
  each_corner(triangles, [&](const Vec3& p) {
    const Vec3 d = p - near, at(glm::dot(d, axes[0]), glm::dot(d, axes[1]), glm::dot(d, axes[2]));
    out.low = glm::min(out.low, at), out.high = glm::max(out.high, at);
  });
  return out;
}

OrientedBoxes boxes_of(const SphereTree& tree, std::size_t group, const std::vector<Corners>& corners,
                       const std::vector<double>& chords) {
  const auto under = [&](std::size_t g) {
    return std::span<const Corners>(corners).subspan(tree.first_under(g), tree.under(g));
  };
  const Vec3 near = under(group).front().a;
  const Axes straight{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, turned = axes_of(under(group));
  std::array<Box, base::kLanes> along, across;
  double by_straight = 0, by_turned = 0;
  for (int k = 0; k < base::kLanes; ++k) {
    if (tree.group(group).radius[k] < 0) continue;
    const auto triangles = under(tree.first_child(group) + static_cast<std::size_t>(k));
    along[k] = box_of(triangles, straight, near), across[k] = box_of(triangles, turned, near);
    by_straight += along[k].surface(), by_turned += across[k].surface();
  }
  const bool turn = by_turned < by_straight;
  OrientedBoxes out;
  const Axes& axes = turn ? turned : straight;
  std::copy(axes.begin(), axes.end(), out.axis);
  for (int k = 0; k < base::kLanes; ++k) {
    if (tree.group(group).radius[k] < 0) continue;
    const Box& box = turn ? across[k] : along[k];
    const Vec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    const Vec3 centre = near + middle.x * axes[0] + middle.y * axes[1] + middle.z * axes[2];
    out.x[k] = centre.x, out.y[k] = centre.y, out.z[k] = centre.z;
    const double far = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z), glm::length(half)});
    double chord = 0;
    if (!chords.empty()) {
      const std::size_t child = tree.first_child(group) + static_cast<std::size_t>(k), low = tree.first_under(child);
      for (std::size_t i = low; i < low + tree.under(child); ++i) chord = std::max(chord, chords[i]);
    }
    for (int i = 0; i < 3; ++i) out.half[i][k] = half[i] + chord + 4e-15 * far;  // rounding
  }
  return out;
}

}  // namespace

std::vector<OrientedBoxes> oriented_boxes(const SphereTree& tree, const std::vector<Corners>& corners,
                                          const std::vector<double>& chords) {
  std::vector<OrientedBoxes> out;
  std::size_t above = 0;  // groups of the last level come last
  while (above < tree.groups() && !tree.holds_items(above)) ++above;
  out.resize(above);
  base::parallel_for(above, 16, [&](std::size_t from, std::size_t to) {
    for (std::size_t g = from; g < to; ++g) out[g] = boxes_of(tree, g, corners, chords);
  });
  return out;
}

}  // namespace riffler::collide
