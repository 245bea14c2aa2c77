#include "marching/corner_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/sort_unique.hpp"
#include "geom/math.hpp"
#include "marching/mesh_state.hpp"

namespace riffler::marching {

namespace {

/// A triangle at one of the patch's vertices.
struct Wedge {
  Vec3 normal;
  double angle;
};

/// The bricks with triangles adjacent to `bricks`, without these.
std::vector<std::size_t> beside(const Bricks& all, std::span<const std::size_t> bricks) {
  std::vector<std::size_t> out, own(bricks.begin(), bricks.end());
  std::sort(own.begin(), own.end());
  for (const std::size_t n : bricks) {
    const Vec3i at = all.place(n);
    for (int i = at.x - 1; i <= at.x + 1; ++i)
      for (int j = at.y - 1; j <= at.y + 1; ++j)
        for (int k = at.z - 1; k <= at.z + 1; ++k)
          if (const ActiveBrick* const active = all.active(i, j, k); active && active->edges() > 0)
            if (const std::size_t m = all.index(i, j, k); !std::binary_search(own.begin(), own.end(), m))
              out.push_back(m);
  }
  base::sort_unique(out);
  return out;
}

/// Maps a vertex number of the mesh to the patch's number, −1 if the patch lacks it.
class Numbers {
 public:
  Numbers(const MeshState& state, const MeshPatch& patch) : own_(patch.own), foreign_(patch.foreign) {
    for (const std::size_t n : patch.bricks) {
      const ActiveBrick& brick = *state.bricks.active(n);
      ranges_.push_back({brick.first_vertex, brick.vertices(), count_});
      count_ += brick.vertices();
    }
    std::sort(ranges_.begin(), ranges_.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
  }
  /// For all of a brick's own vertices, in order: most are far from the patch, so there is no search for each one.
  void of_brick(const ActiveBrick& brick, std::vector<std::int64_t>& out) const {
    out.assign(brick.vertices(), -1);
    const auto first = static_cast<std::int32_t>(brick.first_vertex);
    for (auto at = std::lower_bound(foreign_.begin(), foreign_.end(), first);
         at != foreign_.end() && static_cast<std::size_t>(*at - first) < out.size(); ++at)
      out[static_cast<std::size_t>(*at - first)] = static_cast<std::int64_t>(own_) + (at - foreign_.begin());
  }
  std::int64_t of(std::int32_t v) const {
    const auto vertex = static_cast<std::size_t>(v);
    const auto after = std::upper_bound(ranges_.begin(), ranges_.end(), vertex,
                                        [](std::size_t x, const Range& r) { return x < r.first; });
    if (after != ranges_.begin() && vertex < (after - 1)->first + (after - 1)->size)
      return static_cast<std::int64_t>((after - 1)->number + vertex - (after - 1)->first);
    const auto at = std::lower_bound(foreign_.begin(), foreign_.end(), v);
    return at != foreign_.end() && *at == v ? static_cast<std::int64_t>(own_) + (at - foreign_.begin()) : -1;
  }

 private:
  struct Range {
    std::size_t first, size, number;
  };
  std::vector<Range> ranges_;
  std::size_t own_, count_ = 0;
  const std::vector<std::int32_t>& foreign_;
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
  out.angle = {std::atan2(twice, glm::dot(b - a, c - a)), std::atan2(twice, glm::dot(c - b, a - b)), 0};
  out.angle[2] = kPi - out.angle[0] - out.angle[1];
  return out;
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

/// The normals of an adaptive patch, from the triangles of the full mesh around its vertices.
base::BulkVector<Vec3f> adaptive_normals(const MeshState& state, const MeshPatch& patch, double least) {
  struct Found {
    Vec3i triangle;
    std::array<std::int64_t, 3> vertex;
  };
  // Patch numbers by full number, ascending.
  std::vector<std::pair<std::int32_t, std::int64_t>> sorted;
  for (std::size_t v = 0; v < patch.numbers.size(); ++v)
    sorted.emplace_back(patch.numbers[v], static_cast<std::int64_t>(v));
  std::sort(sorted.begin(), sorted.end());
  const Mesh& mesh = state.surface.mesh;
  std::vector<std::size_t> bricks = beside(state.bricks, patch.bricks);
  bricks.insert(bricks.end(), patch.bricks.begin(), patch.bricks.end());
  std::vector<Found> found;
  Fans<FullWedge> fans(patch.vertices.size());
  std::vector<std::int64_t> of_brick;
  for (const std::size_t n : bricks) {
    const ActiveBrick& brick = *state.bricks.active(n);
    const auto lookup = [&](std::int32_t v) {
      const auto at = std::lower_bound(sorted.begin(), sorted.end(), std::pair{v, std::int64_t{0}});
      return at != sorted.end() && at->first == v ? at->second : -1;
    };
    const auto first = static_cast<std::int32_t>(brick.first_vertex);
    of_brick.assign(brick.vertices(), -1);
    for (auto at = std::lower_bound(sorted.begin(), sorted.end(), std::pair{first, std::int64_t{0}});
         at != sorted.end() && static_cast<std::size_t>(at->first - first) < of_brick.size(); ++at)
      of_brick[static_cast<std::size_t>(at->first - first)] = at->second;
    const auto number = [&](std::int32_t v) {
      const std::size_t k = static_cast<std::size_t>(v) - brick.first_vertex;  // large for the vertices before it
      return k < of_brick.size() ? of_brick[k] : lookup(v);
    };
    for (std::size_t t = 2 * brick.first_edge; t < 2 * (brick.first_edge + brick.edges()); ++t) {
      const Vec3i& triangle = mesh.triangles[t];
      const Found one{triangle, {number(triangle.x), number(triangle.y), number(triangle.z)}};
      if (std::max({one.vertex[0], one.vertex[1], one.vertex[2]}) < 0) continue;
      found.push_back(one);
      for (const std::int64_t v : one.vertex)
        if (v >= 0) fans.count(static_cast<std::size_t>(v));
    }
  }
  fans.reserve();
  const auto place = [&](std::int32_t v) { return Vec3(Vec3f(to_world(state.lattice.axis(), mesh.vertices[v]))); };
  for (const Found& one : found) {
    const std::array<Vec3, 3> at{place(one.triangle.x), place(one.triangle.y), place(one.triangle.z)};
    const Corners corners = corners_of(at[0], at[1], at[2]);
    for (int c = 0; c < 3; ++c)
      if (one.vertex[c] >= 0)
        fans.add(static_cast<std::size_t>(one.vertex[c]),
                 {{corners.normal, corners.angle[c]}, at[(c + 1) % 3] - at[c], at[(c + 2) % 3] - at[c]});
  }
  base::BulkVector<Vec3f> out(3 * patch.triangles.size());
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    const Vec3i& v = patch.triangles[t];
    const std::array<Vec3, 3> at{Vec3(patch.vertices[v.x]), Vec3(patch.vertices[v.y]), Vec3(patch.vertices[v.z])};
    const Vec3 own = corners_of(at[0], at[1], at[2]).normal;
    for (int c = 0; c < 3; ++c)
      out[3 * t + c] = CornerOfLarge(at[(c + 1) % 3] - at[c], at[(c + 2) % 3] - at[c], own, state.adaptive->tolerance())
                           .normal(fans.at(static_cast<std::size_t>(v[c])), least);
  }
  return out;
}

}  // namespace

base::BulkVector<Vec3f> corner_normals(const MeshState& state, std::span<const std::size_t> bricks,
                                       const MeshPatch& patch, double sharp) {
  struct Outside {
    Vec3i triangle;
    std::array<std::int64_t, 3> vertex;
  };
  if (state.adaptive) return adaptive_normals(state, patch, std::cos(sharp));
  const Mesh& mesh = state.surface.mesh;
  const Numbers numbers(state, patch);
  std::vector<Outside> outside;
  Fans<Wedge> fans(patch.vertices.size());
  for (const Vec3i& t : patch.triangles)
    for (int c = 0; c < 3; ++c) fans.count(static_cast<std::size_t>(t[c]));
  std::vector<std::int64_t> of_brick;
  for (const std::size_t n : beside(state.bricks, bricks)) {
    const ActiveBrick& brick = *state.bricks.active(n);
    numbers.of_brick(brick, of_brick);
    const auto number = [&](std::int32_t v) {
      const std::size_t k = static_cast<std::size_t>(v) - brick.first_vertex;  // large for the vertices before it
      return k < of_brick.size() ? of_brick[k] : numbers.of(v);
    };
    for (std::size_t t = 2 * brick.first_edge; t < 2 * (brick.first_edge + brick.edges()); ++t) {
      const Vec3i& triangle = mesh.triangles[t];
      const Outside found{triangle, {number(triangle.x), number(triangle.y), number(triangle.z)}};
      if (std::max({found.vertex[0], found.vertex[1], found.vertex[2]}) < 0) continue;
      outside.push_back(found);
      for (const std::int64_t v : found.vertex)
        if (v >= 0) fans.count(static_cast<std::size_t>(v));
    }
  }
  fans.reserve();
  // Uses the coordinates that patches have: world frame, float32.
  std::vector<Vec3> normals;
  normals.reserve(patch.triangles.size());
  const auto place = [&](std::int32_t v) { return Vec3(Vec3f(to_world(state.lattice.axis(), mesh.vertices[v]))); };
  for (const Vec3i& t : patch.triangles) {
    const Corners corners = corners_of(Vec3(patch.vertices[t.x]), Vec3(patch.vertices[t.y]), Vec3(patch.vertices[t.z]));
    normals.push_back(corners.normal);
    for (int c = 0; c < 3; ++c) fans.add(static_cast<std::size_t>(t[c]), {corners.normal, corners.angle[c]});
  }
  for (const Outside& o : outside) {
    const Corners corners = corners_of(place(o.triangle.x), place(o.triangle.y), place(o.triangle.z));
    for (int c = 0; c < 3; ++c)
      if (o.vertex[c] >= 0) fans.add(static_cast<std::size_t>(o.vertex[c]), {corners.normal, corners.angle[c]});
  }
  base::BulkVector<Vec3f> out;
  out.resize(3 * patch.triangles.size());
  const double least = std::cos(sharp);
  for (std::size_t t = 0; t < patch.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c)
      out[3 * t + c] = mean_near(fans.at(static_cast<std::size_t>(patch.triangles[t][c])), normals[t], least);
  return out;
}

}  // namespace riffler::marching
