#include "brush/crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace riffler::brush {

namespace {

using dexel::Grid;

/// Twice the signed area of (a, b, p), computed in one order of a and b, so that two triangles with a common edge get
/// exactly opposite numbers; `forward`: whether a comes first. Zero counts as positive in that order.
bool left_of(const Vec3& a, const Vec3& b, bool forward, double u, double v, double& area) {
  const Vec3 &p = forward ? a : b, &q = forward ? b : a;
  const double s = (q.x - p.x) * (v - p.y) - (q.y - p.y) * (u - p.x);
  area = forward ? s : -s;
  return (s >= 0) == forward;
}

/// For each vertex, the first ray at or after it along u and along v. A triangle crosses only rays between those of its
/// corners: most cross none and are skipped.
class FirstRays {
 public:
  FirstRays(const Grid& grid, const std::vector<Vec3>& vertices) : first_(vertices.size()) {
    const double inverse = 1 / grid.pitch();
    const double u0 = grid.shifted_u(0), v0 = grid.shifted_v(0);
    const auto ray = [](double x, int count) { return static_cast<int>(std::ceil(std::clamp(x, 0.0, count + 0.0))); };
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const Vec3 p = to_local(grid.axis(), vertices[k]);
      first_[k] = {ray((p.x - u0) * inverse, grid.nu()), ray((p.y - v0) * inverse, grid.nv())};
    }
  }
  /// Calls f(i, j) for the rays that the triangle may cross.
  template <class F>
  void for_each_between(const Vec3i& triangle, const F& f) const {
    const auto &a = of(triangle.x), &b = of(triangle.y), &c = of(triangle.z);
    const auto [i0, i1] = std::minmax({a[0], b[0], c[0]});
    const auto [j0, j1] = std::minmax({a[1], b[1], c[1]});
    for (int i = i0; i < i1; ++i)
      for (int j = j0; j < j1; ++j) f(i, j);
  }

 private:
  const std::array<int, 2>& of(int vertex) const { return first_[static_cast<std::size_t>(vertex)]; }
  std::vector<std::array<int, 2>> first_;
};

/// Corners of a triangle in the cyclic frame.
struct Facet {
  Vec3 corner[3];
  Vec3i number;

  Facet(Axis axis, const std::vector<Vec3>& vertices, const Vec3i& triangle) : number(triangle) {
    for (int k = 0; k < 3; ++k) corner[k] = to_local(axis, vertices[static_cast<std::size_t>(triangle[k])]);
  }
  /// Whether ray (i, j) crosses the triangle, and where: the weights of the corners.
  bool crosses(const Grid& grid, int i, int j, Vec3& weights, bool& enters) const {
    const double u = grid.shifted_u(i), v = grid.shifted_v(j);
    double area[3];
    bool left[3];
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      left[k] = left_of(corner[a], corner[b], number[a] < number[b], u, v, area[k]);
    }
    if (left[0] != left[1] || left[1] != left[2]) return false;
    const double sum = area[0] + area[1] + area[2];
    if (sum == 0) return false;
    weights = Vec3(area[0], area[1], area[2]) / sum, enters = !left[0];
    return true;
  }
};

/// The crossing at the corner weights. Between the vertices the surface is the mean of the triangle and of the tangent
/// planes at its corners, which is exact for quadrics: the sagitta is half of the planes' height.
Crossing crossing_at(const Facet& facet, const Vec3 (&normals)[3], const Vec3& weights, double pitch) {
  Crossing out{};
  Vec3 place(0), normal(0);
  for (int k = 0; k < 3; ++k) place += weights[k] * facet.corner[k], normal += weights[k] * normals[k];
  double over = 0;
  for (int k = 0; k < 3; ++k) over += 0.5 * weights[k] * glm::dot(facet.corner[k] - place, normals[k]);
  out.raw = out.w = place.z;
  const double length = glm::length(normal);
  if (length > 1e-9) normal /= length;
  out.normal = normal;
  constexpr double grazing = 0.02, most = 0.5;  // pitches
  if (std::abs(normal.z) > grazing) out.w += std::clamp(over / normal.z, -most * pitch, most * pitch);
  return out;
}

class CrossingFinder {
 public:
  CrossingFinder(const Grid& grid, const Patch& patch, CrossedRays& out)
      : grid_(grid),
        patch_(patch),
        out_(out),
        before_(grid, patch.before().vertices),
        after_(grid, patch.after().vertices) {
    out.wanted.assign(static_cast<std::size_t>(grid.nu()) * static_cast<std::size_t>(grid.nv()), false);
  }

  void mark() {
    for (const std::uint32_t t : patch_.near()) {
      const Vec3i& triangle = patch_.triangles()[t];
      if (!patch_.moved(triangle)) continue;
      mark(triangle, patch_.before(), before_), mark(triangle, patch_.after(), after_);
    }
  }

  void find() {
    std::size_t near = 0;
    for (std::size_t t = 0; t < patch_.triangles().size(); ++t) {
      const bool is_near = near < patch_.near().size() && patch_.near()[near] == t;
      const bool moved = is_near && patch_.moved(patch_.triangles()[t]);
      const std::size_t corner = is_near ? 3 * near : kFar;
      cross(t, corner, patch_.before(), before_, out_.before, moved ? nullptr : &out_.after);
      if (moved) cross(t, corner, patch_.after(), after_, out_.after, nullptr);
      near += is_near;
    }
    out_.before.finish(grid_), out_.after.finish(grid_);
  }

 private:
  static constexpr std::size_t kFar = static_cast<std::size_t>(-1);

  std::size_t ray(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(grid_.nv()) + static_cast<std::size_t>(j);
  }

  void mark(const Vec3i& triangle, const Patch::State& state, const FirstRays& rays) {
    const Facet facet(grid_.axis(), state.vertices, triangle);
    rays.for_each_between(triangle, [&](int i, int j) {
      Vec3 weights;
      bool enters;
      if (facet.crosses(grid_, i, j, weights, enters)) out_.wanted[ray(i, j)] = true;
    });
  }

  /// Adds the crossings of triangle `t`, whose corner normals begin at `corner`, to one list or two.
  void cross(std::size_t t, std::size_t corner, const Patch::State& state, const FirstRays& rays, Crossings& to,
             Crossings* also) {
    const Vec3i& triangle = patch_.triangles()[t];
    const Axis axis = grid_.axis();
    rays.for_each_between(triangle, [&](int i, int j) {
      if (!out_.wanted[ray(i, j)]) return;
      const Facet facet(axis, state.vertices, triangle);
      Vec3 weights, normals[3], way(0);
      bool enters;
      if (!facet.crosses(grid_, i, j, weights, enters)) return;
      const Vec3 own = glm::cross(facet.corner[1] - facet.corner[0], facet.corner[2] - facet.corner[0]);
      for (int k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(triangle[k]);
        normals[k] = corner == kFar ? own / glm::length(own)
                                    : to_local(axis, state.corners[corner + static_cast<std::size_t>(k)]);
        way += weights[k] * (state.vertices[v] - patch_.before().vertices[v]);
      }
      Crossing c = crossing_at(facet, normals, weights, grid_.pitch());
      c.way = to_local(axis, way);
      c.enters = enters;
      for (Crossings* list : {&to, also})
        if (list) list->add(ray(i, j), c);
    });
  }

  const Grid& grid_;
  const Patch& patch_;
  CrossedRays& out_;
  FirstRays before_, after_;
};

}  // namespace

CrossedRays::CrossedRays(const Grid& grid, const Patch& patch) {
  CrossingFinder finder(grid, patch, *this);
  finder.mark();
  finder.find();
}

void Crossings::finish(const Grid& grid) {
  sort(grid), unite();
}

/// By ray, then along it.
void Crossings::sort(const Grid& grid) {
  nv_ = grid.nv();
  begin_.assign(static_cast<std::size_t>(grid.nu()) * static_cast<std::size_t>(grid.nv()) + 1, 0);
  for (const std::uint32_t ray : ray_) ++begin_[ray + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  std::vector<Crossing> sorted(found_.size());
  for (std::size_t k = 0; k < found_.size(); ++k) sorted[next[ray_[k]]++] = found_[k];
  found_ = std::move(sorted);
  ray_.clear();
  for (std::size_t r = 0; r + 1 < begin_.size(); ++r)
    if (begin_[r + 1] - begin_[r] > 1)
      std::sort(found_.begin() + static_cast<std::ptrdiff_t>(begin_[r]),
                found_.begin() + static_cast<std::ptrdiff_t>(begin_[r + 1]));
}

/// Keeps the crossings where the number of sheets around changes between 0 and 1.
void Crossings::unite() {
  std::size_t n = 0, from = 0;
  for (std::size_t r = 0; r + 1 < begin_.size(); ++r) {
    const std::size_t to = begin_[r + 1];
    begin_[r] = n;
    int sheets = 0;
    for (std::size_t k = from; k < to; ++k) {
      const int next = sheets + (found_[k].enters ? 1 : -1);
      if ((sheets > 0) != (next > 0)) found_[n++] = found_[k];
      sheets = next;
    }
    from = to;
  }
  begin_.back() = n;
  found_.resize(n);
}

}  // namespace riffler::brush
