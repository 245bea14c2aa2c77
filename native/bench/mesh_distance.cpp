#include "bench/mesh_distance.hpp"

#include <algorithm>
#include <array>
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

MeshDistance::MeshDistance(const Mesh& mesh) {
  if (mesh.empty()) throw std::invalid_argument("the mesh has no triangles");
  for (const Vec3i& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
    triangles_.push_back({a, b, c, glm::cross(b - a, c - a)});
  }
  build(triangles_.begin(), triangles_.end());
}

/// Halves the triangles at the median of their middles along the longest side. Returns the number of the node.
int MeshDistance::build(std::vector<Corners>::iterator begin, std::vector<Corners>::iterator end) {
  constexpr std::ptrdiff_t kLeaf = 4;
  Box3 box, middles;
  const auto middle = [](const Corners& t) { return t.a + t.b + t.c; };
  for (auto t = begin; t != end; ++t) box.add(t->a), box.add(t->b), box.add(t->c), middles.add(middle(*t));
  const auto node = static_cast<int>(nodes_.size());
  nodes_.push_back({box, -1, static_cast<int>(begin - triangles_.begin()), static_cast<int>(end - begin)});
  if (end - begin <= kLeaf) return node;
  const Vec3 size = middles.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto half = begin + (end - begin) / 2;
  std::nth_element(begin, half, end,
                   [&](const Corners& s, const Corners& t) { return middle(s)[axis] < middle(t)[axis]; });
  build(begin, half);
  const int other = build(half, end);
  nodes_[node].other = other;
  return node;
}

double MeshDistance::operator()(const Vec3& p, double enough, int* near) const {
  struct Entry {
    int node;
    double square;
  };
  const auto to_box = [&](int n) {
    return squared(glm::max(Vec3(0), glm::max(nodes_[n].box.lower - p, p - nodes_[n].box.upper)));
  };
  std::array<Entry, 64> stack;  // as deep as a tree of 2^31 triangles is
  int depth = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto look_at = [&](int n) {
    const Corners& t = triangles_[n];
    const double height = glm::dot(p - t.a, t.normal);
    if (height * height > 1.0001 * least * squared(t.normal)) return;  // its plane is farther
    if (const double square = squared_distance(p, t.a, t.b, t.c); square < least) {
      least = square;
      if (near) *near = n;
    }
  };
  if (near) look_at(*near);
  stack[depth++] = {0, to_box(0)};
  while (depth > 0 && !(least <= enough * enough)) {
    const auto [n, square] = stack[--depth];
    if (square >= least) continue;
    const Node& node = nodes_[n];
    if (node.other < 0) {
      for (int t = node.first; t < node.first + node.count; ++t) look_at(t);
      continue;
    }
    Entry close{n + 1, to_box(n + 1)}, far{node.other, to_box(node.other)};
    if (far.square < close.square) std::swap(close, far);
    stack[depth++] = far, stack[depth++] = close;
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

double MeshDistance::farthest(std::span<const Vec3> points) const {
  double worst = 0;
  int near = 0;
  for (const Vec3& p : points) worst = std::max(worst, (*this)(p, worst, &near));
  return worst;
}

}  // namespace riffler::bench
