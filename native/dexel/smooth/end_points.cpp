#include "dexel/smooth/end_points.hpp"

#include <numeric>

namespace riffler::dexel {

namespace {

bool holds(std::span<const Span> ray, double w) {
  const auto after = std::partition_point(ray.begin(), ray.end(), [w](const Span& s) { return s.far < w; });
  return after != ray.end() && after->near <= w;
}

/// Adds the ends on ray (i, j) within `reach`.
void add_ends(const Grid& grid, int i, int j, const Interval& reach, const Grid* protect, std::vector<EndPoint>& out) {
  const std::span<const Span> ray = grid.ray(i, j);
  const std::span<const SpanNormals> normals = grid.ray_normals(i, j);
  const auto add = [&](double w, const PackedNormal& packed) {
    if (w < reach.near || w > reach.far) return;
    const Vec3 n = packed.unpack();
    const double area = 1 / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    const bool held = protect && holds(protect->ray(i, j), w);
    out.push_back({to_world(grid.axis(), {grid.u(i), grid.v(j), w}), n, area, held});
  };
  const auto first =
      std::partition_point(ray.begin(), ray.end(), [&](const Span& s) { return s.far < reach.near; }) - ray.begin();
  for (std::size_t k = static_cast<std::size_t>(first); k < ray.size() && ray[k].near <= reach.far; ++k)
    add(ray[k].near, normals[k].near), add(ray[k].far, normals[k].far);
}

}  // namespace

std::vector<EndPoint> end_points(const Volume& volume, const Vec3& centre, double radius, const Volume* protect) {
  std::vector<EndPoint> out;
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const Grid& grid = volume.grids()[g];
    const Grid* kept = protect ? &protect->grids()[g] : nullptr;
    const Vec3 c = to_local(grid.axis(), centre);
    const auto [i0, i1] = ray_indices({c.x - radius, c.x + radius}, grid.box().lower.x, grid.pitch(), grid.nu());
    for (int i = i0; i <= i1; ++i) {
      const double du = grid.u(i) - c.x, across = std::sqrt(std::max(0.0, radius * radius - du * du));
      const auto [j0, j1] = ray_indices({c.y - across, c.y + across}, grid.box().lower.y, grid.pitch(), grid.nv());
      for (int j = j0; j <= j1; ++j) {
        const double dv = grid.v(j) - c.y, along = std::sqrt(std::max(0.0, across * across - dv * dv));
        add_ends(grid, i, j, {c.z - along, c.z + along}, kept, out);
      }
    }
  }
  return out;
}

Columns::Columns(Axis axis, std::vector<Vec3> places, double side) : axis_(axis), side_(side) {
  Box3 box;
  for (Vec3& p : places) p = to_local(axis, p), box.add(p);
  if (!places.empty()) lower_ = box.lower;
  const Vec3 size = places.empty() ? Vec3(0) : box.size();
  nu_ = static_cast<int>(size.x / side) + 1, nv_ = static_cast<int>(size.y / side) + 1;
  first_.assign(static_cast<std::size_t>(nu_) * nv_ + 1, 0);
  std::vector<std::uint32_t> column(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    column[k] = static_cast<std::uint32_t>(cell(places[k].x, lower_.x, nu_) * nv_ + cell(places[k].y, lower_.y, nv_));
    ++first_[column[k] + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  order_.resize(places.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < places.size(); ++k) order_[next[column[k]]++] = static_cast<std::uint32_t>(k);
  for (std::size_t c = 0; c + 1 < first_.size(); ++c)
    std::sort(order_.begin() + first_[c], order_.begin() + first_[c + 1], [&](std::uint32_t a, std::uint32_t b) {
      return places[a].z != places[b].z ? places[a].z < places[b].z : a < b;
    });
  along_.reserve(places.size());
  for (const std::uint32_t k : order_) along_.push_back(places[k].z);
}

}  // namespace riffler::dexel
