#include "dexel/winding.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace riffler {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Distance of p from the segment ab.
double distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a, r = p - a;
  const double dd = glm::dot(d, d);
  const double t = dd > 0 ? std::clamp(glm::dot(r, d) / dd, 0.0, 1.0) : 0;
  return glm::length(r - t * d);
}

/// Bound of the second derivatives of an edge's K at the distance d or more: |∇(dl × r / |r|³)| ≤ 2 |dl| / |r|³,
/// integrated over the edge or over the whole line.
double edge_curvature(double length, double d) {
  if (!(d > 0)) return kInfinity;
  return std::min(2 * length / (d * d * d), 4 / (d * d)) / (4 * kPi);
}

/// A direction in stereographic coordinates up to a positive factor: (t : α) = (T : f α).
struct Stereographic {
  double t, f;
  Stereographic(double z, double length, double rr) : t(z < 0 ? rr : length + z), f(z < 0 ? length - z : 1.0) {}
};

/// The product of the edges' complex numbers, kept within range.
class Turn {
 public:
  void multiply(double re, double im) {
    const double x = re_ * re - im_ * im;
    im_ = re_ * im + im_ * re;
    re_ = x;
    if (++count_ % 4 == 0) normalise();
  }
  /// arg / 2π − ½, in (−1, 0].
  double phase() const { return std::atan2(im_, re_) / (2 * kPi) - 0.5; }

 private:
  void normalise() {
    const double size = std::abs(re_) + std::abs(im_);
    if (size > 0) re_ /= size, im_ /= size;
  }
  double re_ = 1, im_ = 0;
  int count_ = 0;
};

double wrap(double x) {
  return x - std::round(x);
}

/// Column coordinates relative to the ray. A boundary vertex exactly over or under the ray has no direction to its
/// side; any will do, since it enters both its edges and cancels.
Vec2 aside(double u, double v) {
  constexpr double kNone = 1.0 / (1LL << 36);
  return u == 0 && v == 0 ? Vec2(kNone, 0) : Vec2(u, v);
}

}  // namespace

void Field::clear() {
  points_.clear(), begins_.clear(), far_.clear(), near_.clear(), column_.clear();
  far_curvature_ = 0;
  last_ = -1;
}

void Field::add_edge(const std::vector<Vec3>& points, int a, int b) {
  if (last_ != a) points_.push_back(points[a]), begins_.push_back(1);
  points_.push_back(points[b]), begins_.push_back(0);
  last_ = b;
}

void Field::set_column(double u, double v) {
  u_ = u, v_ = v;
  column_.resize(points_.size());
  Vec2 before(0);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Vec2 a = aside(points_[k].x - u, points_[k].y - v);
    column_[k] = {a.x * a.x + a.y * a.y, before.x * a.x + before.y * a.y, before.x * a.y - before.y * a.x};
    before = a;
  }
}

Field::Value Field::at(double z) const {
  Turn turn;
  double slope = 0, z_a = 0, length_a = 0;
  Stereographic a(0, 0, 0);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Column& c = column_[k];
    const double z_b = points_[k].z - z, length_b = std::sqrt(c.rr + z_b * z_b);
    const Stereographic b(z_b, length_b, c.rr);
    if (!begins_[k]) {
      const double ff = a.f * b.f, product = length_a * length_b;
      turn.multiply(a.t * b.t + ff * c.dot, ff * c.cross);
      const double below = product * (product + c.dot + z_a * z_b);
      if (below > 0) slope += c.cross * (length_a + length_b) / below;
    }
    a = b, z_a = z_b, length_a = length_b;
  }
  double more = 0;
  for (const Multipole& m : far_) {
    const Vec3 r = m.centre - Vec3(u_, v_, z);
    const double inverse = 1 / glm::dot(r, r), cube = inverse * std::sqrt(inverse);
    const Vec3 q = m.quadrupole * r;
    const double dipole = glm::dot(m.dipole, r), quadrupole = glm::dot(r, q);
    more += (dipole + m.trace - 3 * quadrupole * inverse) * cube;
    slope -= (m.dipole.z - 3 * (dipole * r.z + m.trace * r.z + 2 * q.z) * inverse +
              15 * quadrupole * r.z * inverse * inverse) *
             cube;
  }
  return {wrap(turn.phase() + more / (4 * kPi)), slope / (4 * kPi)};
}

double Field::at(const Vec3& p, Vec3& gradient) const {
  Turn turn;
  Vec3 sum(0), a(0);
  Vec2 aside_a(0);
  double length_a = 0;
  Stereographic from(0, 0, 0);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Vec3 b = points_[k] - p;
    const Vec2 aside_b = aside(b.x, b.y);
    const double rr = glm::dot(aside_b, aside_b), length_b = std::sqrt(rr + b.z * b.z);
    const Stereographic to(b.z, length_b, rr);
    if (!begins_[k]) {
      const double ff = from.f * to.f, product = length_a * length_b;
      turn.multiply(from.t * to.t + ff * glm::dot(aside_a, aside_b),
                    ff * (aside_a.x * aside_b.y - aside_a.y * aside_b.x));
      const double below = product * (product + glm::dot(a, b));
      if (below > 0) sum += glm::cross(a, b) * ((length_a + length_b) / below);
    }
    a = b, aside_a = aside_b, length_a = length_b, from = to;
  }
  double more = 0;
  for (const Multipole& m : far_) {
    const Vec3 r = m.centre - p;
    const double inverse = 1 / glm::dot(r, r), cube = inverse * std::sqrt(inverse);
    const Vec3 q = m.quadrupole * r;
    const double dipole = glm::dot(m.dipole, r), quadrupole = glm::dot(r, q);
    more += (dipole + m.trace - 3 * quadrupole * inverse) * cube;
    sum -=
        (m.dipole - 3 * inverse * ((dipole + m.trace) * r + 2.0 * q) + 15 * quadrupole * inverse * inverse * r) * cube;
  }
  gradient = sum / (4 * kPi);
  return wrap(turn.phase() + more / (4 * kPi));
}

double Field::curvature(double z, double half) const {
  double sum = far_curvature_;
  const Vec3 p(u_, v_, z);
  for (const auto& [a, b] : near_) sum += edge_curvature(glm::length(b - a), distance(p, a, b) - half);
  return sum;
}

double Field::variation(double z, double half, double slope) const {
  double up[2] = {0, 0}, down[2] = {0, 0};  // of the near edges, above and below z
  for (const auto& [from, to] : near_) {
    for (const Vec3& end : {from, to})
      if (end.x == u_ && end.y == v_ && std::abs(end.z - z) <= half) return kInfinity;
    const Vec2 a = aside(from.x - u_, from.y - v_), b = aside(to.x - u_, to.y - v_);
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), dot = glm::dot(a, b), cross = a.x * b.y - a.y * b.x;
    const auto share = [&](double height) {
      const double za = from.z - height, zb = to.z - height;
      const Stereographic s(za, std::sqrt(aa + za * za), aa), t(zb, std::sqrt(bb + zb * zb), bb);
      return std::atan2(s.f * t.f * cross, s.t * t.t + s.f * t.f * dot) / (2 * kPi);
    };
    const double za = from.z - z, zb = to.z - z, la = std::sqrt(aa + za * za), lb = std::sqrt(bb + zb * zb);
    const double below = la * lb * (la * lb + dot + za * zb);
    if (below > 0) slope -= cross * (la + lb) / below / (4 * kPi);
    const double middle = share(z);
    for (const int side : {0, 1}) {
      const double change = share(side == 0 ? z + half : z - half) - middle;
      // On a column through the edge K may turn either way: that is not for rounding to decide.
      if (change > 0 || cross == 0) up[side] += std::abs(change);
      if (change < 0 || cross == 0) down[side] += std::abs(change);
    }
  }
  return std::max({up[0], up[1], down[0], down[1]}) + std::abs(slope) * half + 0.5 * far_curvature_ * half * half;
}

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
      const double d = distance(centre, a, b) - reach;
      const double bound = edge_curvature(node.length, d);
      if (!on_edge(node, bound, d)) return kInfinity;
      sum += bound;
      continue;
    }
    const Vec3 offset = glm::max(glm::abs(node.centre - centre) - half, Vec3(0));
    const double d = glm::length(offset) - node.radius;
    // Third derivatives of 1/r are at most 6 / r⁴, so the remainder after the quadrupole is at most 3 area radius² /
    // d⁴.
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

double BoundaryTree::curvature(const Vec3& centre, const Vec3& half) const {
  return visit(centre, half, [](const Node&, double, double d) { return d > 0; }, [](const Node&, double) {});
}

double BoundaryTree::gather(const Vec3& centre, const Vec3& half, Field& field) const {
  field.clear();
  const double reach = glm::length(half);
  return visit(
      centre, half,
      [&](const Node& node, double bound, double d) {
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
