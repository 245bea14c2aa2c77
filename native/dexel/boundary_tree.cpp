#include "dexel/boundary_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace riffler {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

BoundaryTree::BoundaryTree(const std::vector<std::vector<Vec3>>& loops) {
  std::vector<int> roots;
  for (const std::vector<Vec3>& loop : loops) {
    if (loop.size() < 2) continue;  // one point: an edge from it to itself
    const int from = static_cast<int>(points_.size());
    points_.insert(points_.end(), loop.begin(), loop.end());
    points_.push_back(loop.front());
    const int root = chain(from, static_cast<int>(points_.size()) - 1);
    nodes_[root].from = nodes_[root].to = -1;  // the chord has no length
    roots.push_back(root);
  }
  if (!roots.empty()) root_ = group(roots, 0, roots.size());
}

/// Length, area and multipoles of both children, about the node's centre.
void BoundaryTree::join(Node& node) const {
  for (const int child : {node.left, node.right}) {
    const Node& c = nodes_[child];
    node.length += c.length, node.area += c.area, node.dipole += c.dipole;
    node.quadrupole += c.quadrupole + glm::outerProduct(c.dipole, c.centre - node.centre);
  }
}

int BoundaryTree::chain(int from, int to) {
  Node node;
  node.from = from, node.to = to;
  Box3 box;
  for (int k = from; k <= to; ++k) box.add(points_[k]);
  node.centre = 0.5 * (box.lower + box.upper);
  for (int k = from; k <= to; ++k) node.radius = std::max(node.radius, glm::length(points_[k] - node.centre));
  if (to - from == 1) {
    node.length = glm::length(points_[to] - points_[from]);
  } else {
    const int middle = (from + to) / 2;
    node.left = chain(from, middle), node.right = chain(middle, to);
    join(node);
    const Vec3 &a = points_[from], &b = points_[middle], &c = points_[to];
    const Vec3 vector = 0.5 * glm::cross(b - a, c - a);
    node.area += glm::length(vector), node.dipole += vector;
    node.quadrupole += glm::outerProduct(vector, (a + b + c) / 3.0 - node.centre);
  }
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

int BoundaryTree::group(std::vector<int>& loops, std::size_t begin, std::size_t end) {
  if (end - begin == 1) return loops[begin];
  Box3 box, centres;
  for (std::size_t k = begin; k < end; ++k) {
    const Node& n = nodes_[loops[k]];
    box.add(Box3{n.centre, n.centre}.grown(n.radius)), centres.add(n.centre);
  }
  const Vec3 size = centres.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::sort(loops.begin() + static_cast<std::ptrdiff_t>(begin), loops.begin() + static_cast<std::ptrdiff_t>(end),
            [&](int a, int b) {
              const double x = nodes_[a].centre[axis], y = nodes_[b].centre[axis];
              return x != y ? x < y : a < b;
            });
  const std::size_t middle = (begin + end) / 2;
  Node node;
  node.left = group(loops, begin, middle), node.right = group(loops, middle, end);
  node.centre = 0.5 * (box.lower + box.upper);
  for (std::size_t k = begin; k < end; ++k)
    node.radius = std::max(node.radius, glm::length(nodes_[loops[k]].centre - node.centre) + nodes_[loops[k]].radius);
  join(node);
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

template <class OnEdge, class OnFar>
double BoundaryTree::visit(const Vec3& centre, const Vec3& half, const OnEdge& on_edge, const OnFar& on_far) const {
  double sum = 0;
  const double reach = glm::length(half);
  int stack[128], top = 0;
  if (root_ >= 0) stack[top++] = root_;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (node.left < 0) {
      const Vec3 &a = points_[node.from], &b = points_[node.to];
      // The sphere about an edge is nearer than the edge, but quickly seen to be far.
      double d = glm::length(node.centre - centre) - node.radius - reach;
      if (d < 4 * node.length) d = segment_distance(centre, a, b) - reach;
      const double bound = edge_curvature(node.length, d);
      if (!on_edge(node, bound, d)) return kInfinity;
      sum += bound;
      continue;
    }
    const Vec3 offset = glm::max(glm::abs(node.centre - centre) - half, Vec3(0));
    const double d = glm::length(offset) - node.radius;
    // Third derivatives of 1/r are at most 6 / r⁴: what the quadrupole leaves is at most 3 area radius² / d⁴.
    if (d > 0 && 3 * node.area * node.radius * node.radius <= 4 * kPi * kAccuracy * d * d * d * d) {
      const double bound = node.length / (d * d * d) / (2 * kPi);
      sum += bound;
      on_far(node, bound);
      continue;
    }
    stack[top++] = node.right, stack[top++] = node.left;
  }
  return sum;
}

double BoundaryTree::gather(const Vec3& centre, const Vec3& half, Field& field, bool clear_only) const {
  field.clear();
  const double reach = glm::length(half);
  return visit(
      centre, half,
      [&](const Node& node, double bound, double d) {
        if (clear_only && !(d > 0)) return false;
        field.add_edge(points_, node.from, node.to);
        if (d < reach)
          field.near_.emplace_back(points_[node.from], points_[node.to]);
        else
          field.far_curvature_ += bound;
        return true;
      },
      [&](const Node& node, double bound) {
        if (node.from >= 0) field.add_edge(points_, node.from, node.to);
        const Mat3& q = node.quadrupole;
        field.far_.push_back({node.centre, node.dipole, 0.5 * (q + glm::transpose(q)), q[0][0] + q[1][1] + q[2][2]});
        field.far_curvature_ += bound;
      });
}

}  // namespace riffler
