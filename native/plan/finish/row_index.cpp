#include "plan/finish/row_index.hpp"

#include <algorithm>
#include <cmath>

#include "geom/hypot.hpp"
#include "geom/math.hpp"

namespace riffler::plan {

namespace {

constexpr double kMostBins = 4e6;

}  // namespace

RowIndex::RowIndex(const Box3& area, double window)
    : lower_(Vec2(area.lower) - 2 * window), window_(window), size_(1.25 * window) {
  const Vec2 size = Vec2(area.upper) - Vec2(area.lower) + 4 * window;
  size_ = std::max(size_, std::sqrt(size.x * size.y / kMostBins));
  columns_ = static_cast<std::size_t>(size.x / size_) + 1, rows_ = static_cast<std::size_t>(size.y / size_) + 1;
  bins_.resize(columns_ * rows_);
}

std::size_t RowIndex::bin(double x, double y) const {
  const auto along = [&](double at, std::size_t n) {
    return static_cast<std::size_t>(std::clamp(std::floor(at / size_), 0.0, static_cast<double>(n - 1)));
  };
  return along(y - lower_.y, rows_) * columns_ + along(x - lower_.x, columns_);
}

void RowIndex::add(const std::vector<Vec3>& tips) {
  for (std::size_t k = 1; k < tips.size(); ++k) {
    const Vec3 &a = tips[k - 1], &b = tips[k];
    const auto number = static_cast<std::uint32_t>(from_.size());
    from_.push_back(a), to_.push_back(b);
    // Steps of a tenth of a bin: a piece between two steps is nearer to them than the rest of the window is wide.
    const int steps = 1 + static_cast<int>(geom::hypot(b.x - a.x, b.y - a.y) / (0.1 * size_));
    for (int i = 0; i <= steps; ++i) {
      const Vec3 p = glm::mix(a, b, static_cast<double>(i) / steps);
      std::vector<std::uint32_t>& here = bins_[bin(p.x, p.y)];
      if (here.empty() || here.back() != number) here.push_back(number);
    }
  }
}

std::optional<Vec3> RowIndex::nearest(const Vec3& p) const {
  std::optional<Vec3> best;
  double least = kInfinity;
  const std::size_t middle = bin(p.x, p.y), column = middle % columns_, row = middle / columns_;
  for (std::size_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, rows_ - 1); ++r)
    for (std::size_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 1, columns_ - 1); ++c)
      for (const std::uint32_t k : bins_[r * columns_ + c]) {
        const Vec3 way = to_[k] - from_[k];
        const double square = glm::dot(way, way);
        const double s = square > 0 ? std::clamp(glm::dot(p - from_[k], way) / square, 0.0, 1.0) : 0.0;
        const Vec3 at = from_[k] + s * way, off = p - at;
        const double d = glm::dot(off, off);
        if (d < least && !(geom::hypot(off.x, off.y) > window_)) least = d, best = at;
      }
  return best;
}

}  // namespace riffler::plan
