#include "plan/rough/layer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/math.hpp"

namespace riffler::plan {

namespace {

/// Calls visit(place, distance) for the grid's places within `radius` of p.
template <class Visit>
void each_within(const PlaceGrid& grid, const Vec2& p, double radius, const Visit& visit) {
  const double g = grid.spacing;
  const auto first = [&](double x, double low, int n) {
    return static_cast<int>(std::clamp(std::ceil((x - radius - low) / g), 0.0, static_cast<double>(n)));
  };
  const auto last = [&](double x, double low, int n) {
    return static_cast<int>(std::clamp(std::floor((x + radius - low) / g), -1.0, static_cast<double>(n - 1)));
  };
  for (int row = first(p.y, grid.lower.y, grid.rows); row <= last(p.y, grid.lower.y, grid.rows); ++row) {
    const double dy = grid.lower.y + row * g - p.y;
    for (int column = first(p.x, grid.lower.x, grid.columns); column <= last(p.x, grid.lower.x, grid.columns);
         ++column) {
      const double dx = grid.lower.x + column * g - p.x, square = dx * dx + dy * dy;
      if (square <= radius * radius) visit(grid.index(column, row), Vec2(dx, dy));
    }
  }
}

}  // namespace

StockTops::StockTops(const PlaceGrid& grid, Field tops, const CutterProfile& profile)
    : grid_(&grid), tops_(std::move(tops)), radius_(profile.radius()) {
  const double cell = kCellRadius * grid.spacing;
  const int n = static_cast<int>(std::ceil(profile.radius() / grid.spacing * kSteps)) + 1;
  for (int k = 0; k <= n; ++k) {
    const double far = static_cast<double>(k + 1) * grid.spacing / kSteps + cell;
    heights_.push_back(far <= profile.radius() ? profile.height(far) : kInfinity);
  }
}

double StockTops::highest(const Vec2& p) const {
  double out = -kInfinity;
  each_within(*grid_, p, radius_ + 2 * kCellRadius * grid_->spacing,
              [&](std::size_t k, const Vec2&) { out = std::max(out, tops_[k]); });
  return out;
}

void StockTops::cut(const Vec3& tip) {
  each_within(*grid_, Vec2(tip), radius_, [&](std::size_t k, const Vec2& off) {
    if (tops_[k] <= tip.z) return;
    const auto step = static_cast<std::size_t>(glm::length(off) / grid_->spacing * kSteps);
    if (step < heights_.size()) tops_[k] = std::min(tops_[k], tip.z + heights_[step]);
  });
}

Layer::Layer(const PlaceGrid& grid, PlaceSet material, PlaceSet touched, double radius)
    : grid_(&grid), material_(std::move(material)), middles_(std::move(touched)), radius_(radius) {}

bool Layer::touches(const Vec2& p) const {
  bool any = false;
  each_within(*grid_, p, radius_ - kCellRadius * grid_->spacing,
              [&](std::size_t k, const Vec2&) { any = any || material_[k]; });
  return any;
}

bool Layer::frees(const Vec2& p) const {
  bool any = false;
  each_within(*grid_, p, radius_ + kCellRadius * grid_->spacing,
              [&](std::size_t k, const Vec2&) { any = any || material_[k]; });
  return !any;
}

double Layer::move(const Vec2& from, const Vec2& to) {
  const double length = glm::length(to - from);
  if (length == 0) return 0;
  const Vec2 across(-(to.y - from.y) / length, (to.x - from.x) / length);
  const double whole = radius_ - kCellRadius * grid_->spacing;
  Interval& now = widths_[moves_++ % widths_.size()];
  now = {};
  each_within(*grid_, to, radius_, [&](std::size_t k, const Vec2& off) {
    if (glm::dot(off, off) <= whole * whole) material_[k] = 0;
    if (!middles_[k]) return;
    middles_[k] = 0;
    now.include(glm::dot(across, off));
  });
  if (now.near > now.far) return 0;
  Interval all;
  for (const Interval& one : widths_) all.near = std::min(all.near, one.near), all.far = std::max(all.far, one.far);
  return all.far - all.near + grid_->spacing;
}

void Layer::place(const Vec2& p) {
  const double whole = radius_ - kCellRadius * grid_->spacing;
  widths_.fill({});
  each_within(*grid_, p, radius_, [&](std::size_t k, const Vec2& off) {
    middles_[k] = 0;
    if (glm::dot(off, off) <= whole * whole) material_[k] = 0;
  });
}

}  // namespace riffler::plan
