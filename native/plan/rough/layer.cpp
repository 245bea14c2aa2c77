#include "plan/rough/layer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/math.hpp"

namespace riffler::plan {

namespace {

int first_from(double x, double low, double spacing, int n) {
  return static_cast<int>(std::clamp(std::ceil((x - low) / spacing), 0.0, static_cast<double>(n)));
}

int last_to(double x, double low, double spacing, int n) {
  return static_cast<int>(std::clamp(std::floor((x - low) / spacing), -1.0, static_cast<double>(n - 1)));
}

/// Calls visit(place, squared distance) for the places within `radius` of a straight line.
template <class Visit>
void each_along(const PlaceGrid& grid, const Vec2& from, const Vec2& to, double radius, const Visit& visit) {
  const double g = grid.spacing;
  const Vec2 way = to - from, low = glm::min(from, to) - radius, high = glm::max(from, to) + radius;
  const double square = glm::dot(way, way);
  const int last_row = last_to(high.y, grid.lower.y, g, grid.rows);
  const int first_column = first_from(low.x, grid.lower.x, g, grid.columns),
            last_column = last_to(high.x, grid.lower.x, g, grid.columns);
  for (int row = first_from(low.y, grid.lower.y, g, grid.rows); row <= last_row; ++row)
    for (int column = first_column; column <= last_column; ++column) {
      const Vec2 off = grid.lower + g * Vec2(column, row) - from;
      const double share = square > 0 ? std::clamp(glm::dot(off, way) / square, 0.0, 1.0) : 0;
      const Vec2 aside = off - share * way;
      if (const double far = glm::dot(aside, aside); far <= radius * radius) visit(grid.index(column, row), far);
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
  each_along(*grid_, p, p, radius_ + 2 * kCellRadius * grid_->spacing,
             [&](std::size_t k, double) { out = std::max(out, tops_[k]); });
  return out;
}

void StockTops::cut(const Vec3& from, const Vec3& to) {
  const double z = std::max(from.z, to.z);
  // A long slanted line has a large box: divide it into pieces.
  const int pieces = 1 + static_cast<int>(glm::length(Vec2(to) - Vec2(from)) / (2 * radius_));
  for (int piece = 0; piece < pieces; ++piece)
    each_along(*grid_, Vec2(glm::mix(from, to, static_cast<double>(piece) / pieces)),
               Vec2(glm::mix(from, to, static_cast<double>(piece + 1) / pieces)), radius_,
               [&](std::size_t k, double square) {
                 if (tops_[k] <= z) return;
                 const auto step = static_cast<std::size_t>(std::sqrt(square) / grid_->spacing * kSteps);
                 if (step < heights_.size()) tops_[k] = std::min(tops_[k], z + heights_[step]);
               });
}

PlaceBits::PlaceBits(const PlaceGrid& grid, const PlaceSet& set)
    : grid_(&grid),
      per_row_((static_cast<std::size_t>(grid.columns) + 63) / 64),
      words_(per_row_ * static_cast<std::size_t>(grid.rows), 0) {
  const auto n = static_cast<std::size_t>(grid.columns);
  for (std::size_t k = 0; k < set.size(); ++k)
    if (set[k]) words_[k / n * per_row_ + k % n / 64] |= std::uint64_t{1} << (k % n % 64);
}

std::array<int, 2> PlaceBits::rows_within(const Vec2& p, double radius) const {
  return {first_from(p.y - radius, grid_->lower.y, grid_->spacing, grid_->rows),
          last_to(p.y + radius, grid_->lower.y, grid_->spacing, grid_->rows)};
}

PlaceBits::Run PlaceBits::run_within(int row, const Vec2& p, double radius) const {
  const double dy = grid_->lower.y + row * grid_->spacing - p.y;
  const double half = std::sqrt(std::max(0.0, (radius - dy) * (radius + dy)));
  return {first_from(p.x - half, grid_->lower.x, grid_->spacing, grid_->columns),
          last_to(p.x + half, grid_->lower.x, grid_->spacing, grid_->columns)};
}

bool PlaceBits::any_within(const Vec2& p, double radius) const {
  const auto [first, last] = rows_within(p, radius);
  for (int row = first; row <= last; ++row)
    if (each_word(row, run_within(row, p, radius),
                  [&](std::size_t word, std::uint64_t mask) { return (words_[word] & mask) != 0; }))
      return true;
  return false;
}

Layer::Layer(const PlaceGrid& grid, const PlaceSet& material, const PlaceSet& touched, double radius)
    : grid_(&grid), material_(grid, material), middles_(grid, touched), radius_(radius) {}

bool Layer::touches(const Vec2& p) const {
  return material_.any_within(p, radius_ - kCellRadius * grid_->spacing);
}

bool Layer::frees(const Vec2& p) const {
  // With this radius the cutter is free of every cell also between two such places that are a diagonal apart.
  const double cell = kCellRadius * grid_->spacing, wide = radius_ + cell;
  return frees(p, std::sqrt(wide * wide + cell * cell));
}

bool Layer::frees(const Vec2& p, double radius) const {
  return !material_.any_within(p, radius) && !middles_.any_within(p, radius);
}

bool Layer::spares(const Vec2& p, double more) const {
  return !touches(p) && !middles_.any_within(p, radius_ + more * grid_->spacing);
}

double Layer::move(const Vec2& from, const Vec2& to) {
  const double length = glm::length(to - from);
  if (length == 0) return 0;
  const Vec2 across(-(to.y - from.y) / length, (to.x - from.x) / length);
  Interval& now = widths_[moves_++ % widths_.size()];
  now = {};
  material_.take_within(to, radius_ - kCellRadius * grid_->spacing, [](const Vec2&) {});
  middles_.take_within(to, radius_, [&](const Vec2& off) { now.include(glm::dot(across, off)); });
  if (now.near > now.far) return 0;
  Interval all;
  for (const Interval& one : widths_) all.near = std::min(all.near, one.near), all.far = std::max(all.far, one.far);
  return all.far - all.near + grid_->spacing;
}

void Layer::place(const Vec2& p) {
  widths_.fill({});
  material_.take_within(p, radius_ - kCellRadius * grid_->spacing, [](const Vec2&) {});
  middles_.take_within(p, radius_, [](const Vec2&) {});
}

}  // namespace riffler::plan
