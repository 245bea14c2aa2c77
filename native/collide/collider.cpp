#include "collide/collider.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "marching/to_mesh.hpp"

namespace riffler {

namespace {

struct Ball {
  Vec3 centre;
  double radius;
};

/// Triangles in a complete tree of bounding spheres.
struct Surface {
  struct Corners {
    Vec3 a, b, c;
  };
  std::vector<Corners> corners;
  std::vector<Ball> balls;
  std::size_t levels = 0;

  explicit Surface(const Mesh& mesh) {
    std::vector<int> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<Corners> all(order.size());
    for (std::size_t t = 0; t < all.size(); ++t) {
      const Vec3i& v = mesh.triangles[t];
      all[t] = {mesh.vertices[v.x], mesh.vertices[v.y], mesh.vertices[v.z]};
    }
    while ((order.size() >> levels) > 4) ++levels;
    balls.resize((std::size_t{2} << levels) - 1);
    build(all, order, 0, 0, order.size(), 0);
    for (const int t : order) corners.push_back(all[t]);
  }

  void build(const std::vector<Corners>& all, std::vector<int>& order, std::size_t node, std::size_t from,
             std::size_t to, std::size_t level) {
    Box3 box;
    for (std::size_t i = from; i < to; ++i)
      box.add(all[order[i]].a), box.add(all[order[i]].b), box.add(all[order[i]].c);
    const Vec3 centre = (box.lower + box.upper) * 0.5, size = box.size();
    double radius = 0;
    for (std::size_t i = from; i < to; ++i)
      for (const Vec3& p : {all[order[i]].a, all[order[i]].b, all[order[i]].c})
        radius = std::max(radius, glm::length(p - centre));
    balls[node] = {centre, radius};
    if (level == levels) return;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = (from + to) / 2;
    const auto key = [&](int t) { return all[t].a[axis] + all[t].b[axis] + all[t].c[axis]; };
    std::nth_element(order.begin() + from, order.begin() + middle, order.begin() + to,
                     [&](int i, int j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
    build(all, order, 2 * node + 1, from, middle, level + 1);
    build(all, order, 2 * node + 2, middle, to, level + 1);
  }
};

struct Search {
  const Outline& outline;
  const Pose& pose;
  double best = std::numeric_limits<double>::infinity();
  Vec3 point{0};
  Part part = Part::Cutter;

  double look(const Vec3& p) {
    const Vec3 d = p - pose.tip;
    const double z = glm::dot(d, pose.axis);
    const Outline::Nearest at = outline.nearest(glm::length(d - z * pose.axis), z);
    if (at.distance < best) best = at.distance, point = p, part = at.part;
    return at.distance;
  }

  void triangle(const Surface::Corners& t) {
    const Vec3 centre = (t.a + t.b + t.c) / 3.0;
    const double radius = std::max({glm::length(t.a - centre), glm::length(t.b - centre), glm::length(t.c - centre)});
    const double f = look(centre);
    if (f - radius >= best - 2e-3) return;
    look(t.a), look(t.b), look(t.c);
    const Vec3 ab = 0.5 * (t.a + t.b), bc = 0.5 * (t.b + t.c), ca = 0.5 * (t.c + t.a);
    for (const Surface::Corners& s : {Surface::Corners{t.a, ab, ca}, {ab, t.b, bc}, {ca, bc, t.c}, {ab, bc, ca}})
      triangle(s);
  }

  void surface(const Surface& s) {
    std::vector<std::pair<double, std::size_t>> heap{{bound(s.balls[0]), 0}};
    while (!heap.empty()) {
      std::pop_heap(heap.begin(), heap.end(), std::greater<>());
      const auto [low, node] = heap.back();
      heap.pop_back();
      if (low >= best) return;
      std::size_t level = 0;
      while ((std::size_t{2} << level) - 1 <= node) ++level;
      if (level == s.levels) {
        const std::size_t place = node + 1 - (std::size_t{1} << level), n = s.corners.size();
        for (std::size_t i = (place * n) >> level; i < (((place + 1) * n) >> level); ++i) triangle(s.corners[i]);
        continue;
      }
      for (const std::size_t child : {2 * node + 1, 2 * node + 2}) {
        heap.emplace_back(bound(s.balls[child]), child);
        std::push_heap(heap.begin(), heap.end(), std::greater<>());
      }
    }
  }
  double bound(const Ball& b) { return look_only(b.centre) - b.radius; }
  double look_only(const Vec3& p) const {
    const Vec3 d = p - pose.tip;
    const double z = glm::dot(d, pose.axis);
    return outline.nearest(glm::length(d - z * pose.axis), z).distance;
  }
};

}  // namespace

Assembly::Assembly(const Tool& tool) : tool_(tool), outline_(tool), reach_(0) {
  for (const OutlineEdge& e : outline_.edges()) {
    reach_ = std::max({reach_, glm::length(e.from), glm::length(e.to)});
    if (e.centre) reach_ = std::max(reach_, glm::length(*e.centre) + std::abs(e.bulge));
  }
}

struct Collider::Data {
  Surface part;
  std::vector<Surface> fixtures;
  Settings settings;
};

Collider::Collider(const Mesh& part, std::vector<Volume> fixtures, const Settings& settings) {
  validate(part);
  if (part.empty()) throw std::invalid_argument("a part without triangles");
  data_ = std::make_unique<Data>(Data{Surface(part), {}, settings});
  for (const Volume& v : fixtures)
    if (const Mesh m = to_mesh(v); !m.empty()) data_->fixtures.emplace_back(m);
}
Collider::~Collider() = default;
Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;

double Collider::clearance(const Assembly& assembly, const Pose& pose) const {
  Search search{assembly.outline(), pose};
  search.surface(data_->part);
  return search.best;
}

Collider::Nearest Collider::nearest(const Assembly& assembly, const Pose& pose) const {
  Search search{assembly.outline(), pose};
  search.surface(data_->part);
  Touch touch = static_cast<Touch>(search.part);
  for (const Surface& s : data_->fixtures) {
    const double before = search.best;
    search.surface(s);
    if (search.best < before) touch = Touch::Fixture;
  }
  return {search.best, search.point, touch};
}

Contact Collider::query(const Assembly& assembly, const Pose& pose, std::optional<double>) const {
  Contact out;
  const Nearest at = nearest(assembly, pose);
  if (at.distance >= 0) return out;
  out.depth = -at.distance, out.points = {at.point}, out.touches = {at.touch};
  return out;
}

}  // namespace riffler
