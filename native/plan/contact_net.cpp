#include "plan/contact_net.hpp"

#include <algorithm>
#include <array>

#include "base/functions.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr std::size_t kGrain = 256;

/// A strip between the sides from `a` to `b` and from `c` to `d`; at the tip of a triangle, a = c. Unlike triangles,
/// thin strips that are halved need only as many pieces as their length requires.
struct Cell {
  Vec3 a, b, c, d;

  Vec3 middle() const { return 0.25 * (a + b + c + d); }
  double reach(const Vec3& from) const {
    return std::max({glm::length(a - from), glm::length(b - from), glm::length(c - from), glm::length(d - from)});
  }
  std::array<Vec3, 4> ways(const Vec3& from) const { return {a - from, b - from, c - from, d - from}; }
  double length() const { return std::max(glm::length(b - a), glm::length(d - c)); }
  double width() const { return std::max(glm::length(c - a), glm::length(d - b)); }
  double area() const { return 0.5 * (glm::length(glm::cross(b - a, c - a)) + glm::length(glm::cross(b - d, c - d))); }
  std::array<Cell, 2> halves() const {
    if (length() >= width()) {
      const Vec3 m = 0.5 * (a + b), n = 0.5 * (c + d);
      return {Cell{a, m, c, n}, Cell{m, b, n, d}};
    }
    const Vec3 m = 0.5 * (a + c), n = 0.5 * (b + d);
    return {Cell{a, b, m, n}, Cell{m, n, c, d}};
  }
};

/// A triangle as a strip that ends at its shortest edge.
Cell strip_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = glm::length(b - a), bc = glm::length(c - b), ca = glm::length(a - c);
  if (bc <= ab && bc <= ca) return {a, b, a, c};
  return ca <= ab ? Cell{b, c, b, a} : Cell{c, a, c, b};
}

/// The net on one triangle.
struct Triangle {
  const RollingBall& ball;
  double spacing, depth, cosine;
  int id;
  std::vector<Unreached>& points;
  std::size_t balls = 0;

  void try_all(const Cell& whole) {
    const Vec3& normal = ball.normal(id);
    std::vector<Cell> stack{whole};
    while (!stack.empty()) {
      const Cell cell = stack.back();
      stack.pop_back();
      const Vec3 middle = cell.middle();
      const double around = cell.reach(middle);
      // A ball moved by `around` changes its distance from anything above its plane by at most that.
      const double radius = ball.radius();
      const mesh::Closest::Above above{middle, normal, depth, cosine};
      const Vec3 centre = middle + radius * normal;
      const mesh::Closest::Hit hit = ball.part().above(centre, radius + around, above);
      ++balls;
      if (hit.triangle < 0) continue;
      const double entered = radius - hit.distance;
      if (entered < around && std::max(cell.length(), cell.width()) > spacing) {
        if (entered <= depth && !ball.part().may_meet(centre, radius - depth, cell.ways(middle), above)) continue;
        const auto [first, second] = cell.halves();
        stack.push_back(second), stack.push_back(first);
      } else if (entered > depth) {
        points.push_back({middle, normal, entered, id, cell.area()});
      }
    }
  }
};

}  // namespace

ContactNet contact_net(const Mesh& part, const RollingBall& ball, double spacing, double depth, double angle,
                       const Progress& progress) {
  const std::size_t n = part.triangles.size(), chunks = (n + kGrain - 1) / kGrain;
  const double cosine = base::cos(0.99 * angle);
  ContactNet net;
  std::vector<std::vector<Unreached>> points(chunks);
  std::vector<std::size_t> balls(chunks, 0);
  base::parallel_for(
      n, kGrain,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
          if (ball.normal(static_cast<int>(t)) == Vec3(0)) continue;
          const Vec3i& v = part.triangles[t];
          Triangle triangle{ball, spacing, depth, cosine, static_cast<int>(t), points[begin / kGrain]};
          triangle.try_all(strip_of(part.vertices[v.x], part.vertices[v.y], part.vertices[v.z]));
          balls[begin / kGrain] += triangle.balls;
        }
      },
      progress);
  for (const auto& some : points) net.points.insert(net.points.end(), some.begin(), some.end());
  for (const std::size_t some : balls) net.balls += some;
  return net;
}

}  // namespace riffler::plan
