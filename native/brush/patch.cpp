#include "brush/patch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "riffler/marching/to_mesh.hpp"

namespace riffler::brush {

namespace {

using dexel::Grid;
using dexel::PackedNormal;
using dexel::Span;
using dexel::SpanNormals;

/// Cosine of the largest angle between triangles of one smooth part at a vertex: 40°.
constexpr double kSmoothPart = 0.766;

/// Copies the part of a ray within [lower, upper], shifted to begin at 0.
void copy_ray(const Grid& from, int i, int j, double lower, double upper, dexel::TileBuilder& out) {
  const auto ray = from.ray(i, j);
  const auto normals = from.ray_normals(i, j);
  const auto cap = [&](double w) { return PackedNormal::pack(to_world(from.axis(), Vec3(0, 0, w))); };
  for (std::size_t k = 0; k < ray.size(); ++k) {
    if (ray[k].far <= lower || ray[k].near >= upper) continue;
    Span span{ray[k].near - lower, ray[k].far - lower};
    SpanNormals ends = normals[k];
    if (ray[k].near < lower) span.near = 0, ends.near = cap(-1);
    if (ray[k].far > upper) span.far = upper - lower, ends.far = cap(1);
    if (span.near < span.far) out.add(span, ends);
  }
}

}  // namespace

std::optional<Crop> crop(const Volume& volume, const Box3& box) {
  const dexel::Frame& frame = volume.frame();
  const double h = frame.pitch;
  Vec3i first(0), last(0);  // cells [first, last)
  Box3 inner;
  for (int k = 0; k < 3; ++k) {
    const int count = dexel::ray_count(frame.box.upper[k] - frame.box.lower[k], h);
    const auto cell = [&](double x) {
      return static_cast<int>(std::clamp(std::floor((x - frame.box.lower[k]) / h), -1.0, static_cast<double>(count)));
    };
    first[k] = std::max(cell(box.lower[k]), 0), last[k] = std::min(cell(box.upper[k]) + 1, count);
    if (first[k] >= last[k]) return std::nullopt;
    inner.lower[k] = frame.box.lower[k] + first[k] * h;
    inner.upper[k] = last[k] == count ? frame.box.upper[k] : frame.box.lower[k] + last[k] * h;
  }
  Box3 own{Vec3(0), inner.size()};
  for (int k = 0; k < 3; ++k)  // rounding must not change the number of rays
    for (int n = last[k] - first[k]; dexel::ray_count(own.upper[k], h) != n;)
      own.upper[k] += dexel::ray_count(own.upper[k], h) < n ? 1e-9 * h : -1e-9 * h;
  Crop out{Volume({own, h, frame.directions}), inner.lower, first};
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const Grid& from = volume.grids()[g];
    Grid& to = out.volume.grids()[g];
    const Axis axis = from.axis();
    const Vec3 lower = to_local(axis, inner.lower), upper = to_local(axis, inner.upper);
    const Vec3 cells = to_local(axis, Vec3(first));
    const int i0 = static_cast<int>(cells.x), j0 = static_cast<int>(cells.y);
    for (std::size_t t = 0; t < to.tile_count(); ++t)
      to.fill_tile(t, [&](int i, int j, dexel::TileBuilder& builder) {
        copy_ray(from, i0 + i, j0 + j, lower.z, upper.z, builder);
      });
  }
  return out;
}

Patch::Patch(const Volume& crop) : pitch_(crop.frame().pitch) {
  Mesh mesh = marching::to_mesh(crop);
  triangles_ = std::move(mesh.triangles);
  before_.vertices.assign(mesh.vertices.begin(), mesh.vertices.end());
}

/// Those that may have moved, and their neighbours.
void Patch::find_near(const Reach& reach) {
  Reach wide = reach;
  wide.radius += 2.5 * pitch_;
  std::vector<std::uint8_t> inside(before_.vertices.size());
  for (std::size_t k = 0; k < inside.size(); ++k) inside[k] = wide.contains(before_.vertices[k]);
  near_.clear();
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Vec3i& c = triangles_[t];
    if (inside[static_cast<std::size_t>(c.x)] || inside[static_cast<std::size_t>(c.y)] ||
        inside[static_cast<std::size_t>(c.z)])
      near_.push_back(static_cast<std::uint32_t>(t));
  }
}

void Patch::group_corners() {
  const std::size_t n = near_.size();
  std::vector<Vec3> normals(n);
  std::vector<std::uint32_t> begin(before_.vertices.size() + 1, 0), around(3 * n);
  const auto& v = before_.vertices;
  for (std::size_t t = 0; t < n; ++t) {
    const Vec3i& c = triangles_[near_[t]];
    const Vec3 cross = glm::cross(v[c.y] - v[c.x], v[c.z] - v[c.x]);
    const double length = glm::length(cross);
    normals[t] = length > 0 ? cross / length : Vec3(0);
    for (int k = 0; k < 3; ++k) ++begin[static_cast<std::size_t>(c[k]) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < n; ++t)
    for (int k = 0; k < 3; ++k)
      around[next[static_cast<std::size_t>(triangles_[near_[t]][k])]++] = static_cast<std::uint32_t>(t);
  group_begin_.reserve(3 * n + 1), group_.reserve(18 * n);
  group_begin_.push_back(0);
  for (std::size_t t = 0; t < n; ++t)
    for (int k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(triangles_[near_[t]][k]);
      for (std::uint32_t a = begin[vertex]; a < begin[vertex + 1]; ++a)
        if (around[a] == t || glm::dot(normals[around[a]], normals[t]) > kSmoothPart) group_.push_back(around[a]);
      group_begin_.push_back(static_cast<std::uint32_t>(group_.size()));
    }
}

void Patch::fill_corners(State& state) const {
  std::vector<Vec3> areas(near_.size());
  const auto& v = state.vertices;
  for (std::size_t t = 0; t < near_.size(); ++t) {
    const Vec3i& c = triangles_[near_[t]];
    areas[t] = glm::cross(v[c.y] - v[c.x], v[c.z] - v[c.x]);
  }
  state.corners.resize(3 * near_.size());
  for (std::size_t c = 0; c < state.corners.size(); ++c) {
    Vec3 sum(0);
    for (std::uint32_t k = group_begin_[c]; k < group_begin_[c + 1]; ++k) sum += areas[group_[k]];
    const double length = glm::length(sum);
    state.corners[c] = length > 0 ? sum / length : Vec3(0);
  }
}

/// Mean place and mean normal of the surface that faces the axis, weighted by area and falloff.
void Patch::fit_plane(Displacement& displacement) const {
  Vec3 place(0), normal(0);
  double weights = 0;
  const auto& v = before_.vertices;
  for (const std::uint32_t t : near_) {
    const Vec3i& c = triangles_[t];
    const Vec3 cross = glm::cross(v[c.y] - v[c.x], v[c.z] - v[c.x]);
    const double area = glm::length(cross);
    if (!(area > 0)) continue;
    const Vec3 middle = (v[c.x] + v[c.y] + v[c.z]) / 3.0;
    const double weight = area * displacement.weight(middle) * displacement.facing(cross / area);
    weights += weight, place += weight * middle, normal += weight / area * cross;
  }
  const double length = glm::length(normal);
  if (weights > 0 && length > 1e-3 * weights) displacement.set_plane(place / weights, normal / length);
}

bool Patch::displace(Displacement& displacement) {
  find_near(displacement.reach());
  if (displacement.needs_plane()) fit_plane(displacement);
  after_.vertices = before_.vertices;
  moved_.assign(before_.vertices.size(), 0);
  std::vector<Vec3> normals(before_.vertices.size(), Vec3(0));
  for (const std::uint32_t t : near_) {
    const Vec3i& c = triangles_[t];
    const auto& v = before_.vertices;
    const Vec3 area = glm::cross(v[c.y] - v[c.x], v[c.z] - v[c.x]);
    for (int k = 0; k < 3; ++k) normals[static_cast<std::size_t>(c[k])] += area;
  }
  bool any = false;
  for (std::size_t k = 0; k < normals.size(); ++k) {
    const Vec3& p = before_.vertices[k];
    const double length = glm::length(normals[k]);
    if (!(length > 0) || displacement.weight(p) == 0) continue;
    const Vec3 d = displacement(p, normals[k] / length);
    if (d == Vec3(0)) continue;
    after_.vertices[k] += d, moved_[k] = 1, any = true;
  }
  if (!any) return false;
  group_corners();
  fill_corners(before_), fill_corners(after_);
  return true;
}

}  // namespace riffler::brush
