#include "marching/corner_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "marching/mesh_state.hpp"
#include "marching/vertex_star.hpp"

namespace riffler::marching {

namespace {

/// A triangle at one of the patch's vertices.
struct Wedge {
  Vec3 normal;
  double angle;
};

/// Finds the bricks of vertices in a patch's triangles: its own bricks and all around them. A brick may have vertices
/// and no triangles, if the crossed edges of its cells begin in the next bricks.
class Owners {
 public:
  Owners(const MeshState& state, std::span<const std::size_t> bricks) {
    for (const std::size_t n : bricks) {
      const Vec3i at = state.bricks.place(n);
      for (int i = at.x - 1; i <= at.x + 1; ++i)
        for (int j = at.y - 1; j <= at.y + 1; ++j)
          for (int k = at.z - 1; k <= at.z + 1; ++k)
            if (const ActiveBrick* const active = state.bricks.active(i, j, k); active && active->vertices() > 0)
              bricks_.push_back(active);
    }
    std::sort(bricks_.begin(), bricks_.end(),
              [](const ActiveBrick* a, const ActiveBrick* b) { return a->first_vertex < b->first_vertex; });
    bricks_.erase(std::unique(bricks_.begin(), bricks_.end()), bricks_.end());
  }
  const ActiveBrick& of(std::int32_t vertex) const {
    const auto after =
        std::upper_bound(bricks_.begin(), bricks_.end(), static_cast<std::size_t>(vertex),
                         [](std::size_t v, const ActiveBrick* brick) { return v < brick->first_vertex; });
    return **(after - 1);
  }

 private:
  std::vector<const ActiveBrick*> bricks_;
};

/// Lists of wedges by vertex: counted first, then filled.
template <class Wedge>
class Fans {
 public:
  explicit Fans(std::size_t vertices) : begin_(vertices + 1, 0) {}
  void count(std::size_t v) { ++begin_[v + 1]; }
  void reserve() {
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    wedges_.resize(begin_.back());
    next_.assign(begin_.begin(), begin_.end() - 1);
  }
  void add(std::size_t v, const Wedge& wedge) { wedges_[next_[v]++] = wedge; }
  std::span<const Wedge> at(std::size_t v) const {
    return {wedges_.data() + begin_[v], wedges_.data() + begin_[v + 1]};
  }

 private:
  std::vector<std::size_t> begin_, next_;
  std::vector<Wedge> wedges_;
};

struct Corners {
  Vec3 normal{0.0};  // unit, or 0 if the triangle has no area
  std::array<double, 3> angle{};
};

Corners corners_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  Corners out;
  const Vec3 cross = glm::cross(b - a, c - a);
  const double twice = glm::length(cross);
  if (!(twice > 0)) return out;
  out.normal = cross / twice;
  out.angle = {base::atan2(twice, glm::dot(b - a, c - a)), base::atan2(twice, glm::dot(c - b, a - b)), 0};
  out.angle[2] = kPi - out.angle[0] - out.angle[1];
  return out;
}

/// The same for the corner `a` alone.
Wedge wedge_at(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 cross = glm::cross(b - a, c - a);
  const double twice = glm::length(cross);
  if (!(twice > 0)) return {Vec3(0.0), 0};
  return {cross / twice, base::atan2(twice, glm::dot(b - a, c - a))};
}

/// The mean of the fan's normals within an angle of `own`, or `own` if there is none.
Vec3f mean_near(std::span<const Wedge> fan, const Vec3& own, double least) {
  const bool flat = own == Vec3(0.0);
  Vec3 sum(0.0);
  for (const Wedge& w : fan)
    if (flat || glm::dot(w.normal, own) >= least) sum += w.angle * w.normal;
  const double size = glm::length(sum);
  return Vec3f(size > 0 ? sum / size : own);
}

/// A triangle of the full mesh at a vertex of an adaptive patch.
struct FullWedge : Wedge {
  Vec3 next, previous;  // its sides, from the vertex
};

/// The normal of a large triangle at one of its corners. Small triangles next to it, such as the wall of a shallow
/// groove in flat ground, bend the light on one cell of the full mesh, and would do so on all of the large triangle. So
/// a small one counts as far as the surface bends under the large one itself: its `bend` is the distance of the large
/// one's corners from its plane.
class CornerOfLarge {
 public:
  /// `next`, `previous`: the triangle's sides, from the corner; `own`: its normal.
  CornerOfLarge(const Vec3& next, const Vec3& previous, const Vec3& own, double tolerance)
      : next_(next), previous_(previous), own_(own), tolerance_(tolerance) {}

  Vec3f normal(std::span<const FullWedge> fan, double least) const {
    double most = 0;  // bend of the small triangles that it replaces here
    for (const FullWedge& w : fan)
      if (glm::dot(w.normal, own_) >= least && is_under(w)) most = std::max(most, bend(w));
    Vec3 sum(0.0);
    for (const FullWedge& w : fan)
      if (own_ == Vec3(0.0) || (glm::dot(w.normal, own_) >= least && counts(w, most))) sum += w.angle * w.normal;
    const double size = glm::length(sum);
    return Vec3f(size > 0 ? sum / size : own_);
  }

 private:
  /// Between 4, which the tolerance allows where a surface bends evenly, and more for the tilt of small triangles.
  static constexpr double kMost = 6;
  static constexpr double kMore = 2, kSlack = 0.25;
  static constexpr double kLarge = 3;  // sizes of a small triangle

  double bend(const FullWedge& w) const {
    return std::max(std::abs(glm::dot(next_, w.normal)), std::abs(glm::dot(previous_, w.normal)));
  }
  static bool is_between(const Vec3& d, const Vec3& a, const Vec3& b, const Vec3& normal) {
    return glm::dot(glm::cross(a, d), normal) >= 0 && glm::dot(glm::cross(d, b), normal) >= 0;
  }
  bool is_under(const FullWedge& w) const {
    const Vec3 middle = glm::length(previous_) * next_ + glm::length(next_) * previous_;
    return is_between(w.next + w.previous, next_, previous_, own_) || is_between(middle, w.next, w.previous, own_);
  }
  bool counts(const FullWedge& w, double most) const {
    const double far = bend(w);
    if (far > kMost * tolerance_) return false;
    const double small = std::max(glm::dot(w.next, w.next), glm::dot(w.previous, w.previous));
    const double large = std::max(glm::dot(next_, next_), glm::dot(previous_, previous_));
    return large <= kLarge * kLarge * small || far <= kMore * most + kSlack * tolerance_;
  }

  Vec3 next_, previous_, own_;
  double tolerance_;
};

/// Corners (a, b, c) of a triangle of the full mesh, from `vertex` on, at the coordinates that patches have: world
/// frame, float32.
std::array<Vec3, 3> corners_from(const MeshState& state, std::size_t triangle, std::int32_t vertex) {
  const Mesh& mesh = state.surface.mesh;
  const Vec3i& t = mesh.triangles[triangle];
  const int first = t.x == vertex ? 0 : t.y == vertex ? 1 : 2;
  const auto place = [&](int c) { return Vec3(Vec3f(to_world(state.lattice.axis(), mesh.vertices[t[c % 3]]))); };
  return {place(first), place(first + 1), place(first + 2)};
}

/// The normals of an adaptive patch, from the triangles of the full mesh around its vertices.
base::BulkVector<Vec3f> adaptive_normals(const MeshState& state, const MeshPatch& patch, double least) {
  const Owners owners(state, patch.bricks);
  VertexStar star(state.surface);
  std::vector<FullWedge> wedges;
  std::vector<std::size_t> begin{0};
  for (const std::int32_t vertex : patch.numbers) {
    for (const std::size_t t : star.of(owners.of(vertex), vertex)) {
      const auto [a, b, c] = corners_from(state, t, vertex);
      wedges.push_back({wedge_at(a, b, c), b - a, c - a});
    }
    begin.push_back(wedges.size());
  }
  base::BulkVector<Vec3f> out(3 * patch.triangles.size());
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    const Vec3i& v = patch.triangles[t];
    const std::array<Vec3, 3> at{Vec3(patch.vertices[v.x]), Vec3(patch.vertices[v.y]), Vec3(patch.vertices[v.z])};
    const Vec3 own = corners_of(at[0], at[1], at[2]).normal;
    for (int c = 0; c < 3; ++c)
      out[3 * t + c] = CornerOfLarge(at[(c + 1) % 3] - at[c], at[(c + 2) % 3] - at[c], own, state.adaptive->tolerance())
                           .normal({wedges.data() + begin[v[c]], wedges.data() + begin[v[c] + 1]}, least);
  }
  return out;
}

/// A triangle of another brick at a vertex of a full patch.
struct OutsideWedge {
  std::size_t vertex;  // of the patch
  Wedge wedge;
};

/// Those of the patch's vertices that lie at its border.
std::vector<OutsideWedge> wedges_outside(const MeshState& state, const MeshPatch& patch) {
  std::vector<std::pair<std::size_t, std::size_t>> inside;  // ranges of the patch's triangles in the mesh
  for (const std::size_t n : patch.bricks) {
    const ActiveBrick& brick = *state.bricks.active(n);
    inside.emplace_back(2 * brick.first_edge, 2 * (brick.first_edge + brick.edges()));
  }
  std::sort(inside.begin(), inside.end());
  const auto is_inside = [&](std::size_t t) {
    const auto after = std::upper_bound(inside.begin(), inside.end(), std::pair{t, ~std::size_t{0}});
    return after != inside.begin() && t < (after - 1)->second;
  };
  std::vector<OutsideWedge> out;
  VertexStar star(state.surface);
  const auto add = [&](const ActiveBrick& brick, std::int32_t vertex, std::size_t of_patch) {
    for (const std::size_t t : star.of(brick, vertex)) {
      if (is_inside(t)) continue;
      const auto [a, b, c] = corners_from(state, t, vertex);
      out.push_back({of_patch, wedge_at(a, b, c)});
    }
  };
  std::size_t own = 0;
  for (const std::size_t n : patch.bricks) {
    const ActiveBrick& brick = *state.bricks.active(n);
    for_upper_vertices(state.surface, brick, [&](std::int32_t vertex) {
      add(brick, vertex, own + static_cast<std::size_t>(vertex) - brick.first_vertex);
    });
    own += brick.vertices();
  }
  const Owners owners(state, patch.bricks);
  for (std::size_t f = 0; f < patch.foreign.size(); ++f)
    add(owners.of(patch.foreign[f]), patch.foreign[f], patch.own + f);
  return out;
}

/// The normals at a vertex's corners: one for all, if no triangle around it is at a sharp edge to another.
class Means {
 public:
  Means(const Fans<Wedge>& fans, std::size_t vertices, double sharp)
      : fans_(fans), least_(base::cos(sharp)), half_(base::cos(sharp / 2)), common_(vertices) {
    for (std::size_t v = 0; v < vertices; ++v)
      if (const std::span<const Wedge> fan = fans.at(v); is_smooth(fan))
        common_[v] = mean_near(fan, fan.front().normal, least_);
  }
  Vec3f at(std::size_t vertex, const Vec3& own) const {
    return common_[vertex] != Vec3f(0.0F) && own != Vec3(0.0) ? common_[vertex]
                                                              : mean_near(fans_.at(vertex), own, least_);
  }

 private:
  bool is_smooth(std::span<const Wedge> fan) const {
    for (const Wedge& w : fan)
      if (!(glm::dot(w.normal, fan.front().normal) > half_ + kRounding)) return false;
    return !fan.empty();
  }
  static constexpr double kRounding = 1e-9;

  const Fans<Wedge>& fans_;
  double least_, half_;
  std::vector<Vec3f> common_;  // 0: there is none
};

}  // namespace

base::BulkVector<Vec3f> corner_normals(const MeshState& state, const MeshPatch& patch, double sharp) {
  if (state.adaptive) return adaptive_normals(state, patch, base::cos(sharp));
  const std::vector<OutsideWedge> outside = wedges_outside(state, patch);
  Fans<Wedge> fans(patch.vertices.size());
  for (const Vec3i& t : patch.triangles)
    for (int c = 0; c < 3; ++c) fans.count(static_cast<std::size_t>(t[c]));
  for (const OutsideWedge& o : outside) fans.count(o.vertex);
  fans.reserve();
  std::vector<Vec3> normals;
  normals.reserve(patch.triangles.size());
  for (const Vec3i& t : patch.triangles) {
    const Corners corners = corners_of(Vec3(patch.vertices[t.x]), Vec3(patch.vertices[t.y]), Vec3(patch.vertices[t.z]));
    normals.push_back(corners.normal);
    for (int c = 0; c < 3; ++c) fans.add(static_cast<std::size_t>(t[c]), {corners.normal, corners.angle[c]});
  }
  for (const OutsideWedge& o : outside) fans.add(o.vertex, o.wedge);
  const Means means(fans, patch.vertices.size(), sharp);
  base::BulkVector<Vec3f> out(3 * patch.triangles.size());
  for (std::size_t t = 0; t < patch.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) out[3 * t + c] = means.at(static_cast<std::size_t>(patch.triangles[t][c]), normals[t]);
  return out;
}

}  // namespace riffler::marching
