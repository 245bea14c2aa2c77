#include "plan/finish/cusp.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"

namespace riffler::plan {

namespace {

constexpr int kPoints = 256, kBisections = 48;

}  // namespace

CutterProfile::CutterProfile(const Tool& tool) {
  for (const tool::Piece& piece : tool.cutter()) sides_.emplace_back(piece);
  for (const LowerSide& side : sides_) radius_ = std::max(radius_, side.rim());
  // Dense near the rim, where a ball is steep.
  for (int k = 0; k <= kPoints; ++k) {
    const double rho = radius_ * base::sin(kPi / 2 * k / kPoints);
    points_.emplace_back(rho, height(std::min(rho, radius_)));
  }
}

double CutterProfile::height(double rho) const {
  double least = kInfinity;
  for (const LowerSide& side : sides_)
    if (rho <= side.rim() * (1 + 1e-12)) least = std::min(least, side.height(std::min(rho, side.rim())));
  return least;
}

double CutterProfile::radius_at(double height_above) const {
  double low = 0, high = radius_;
  if (height(high) <= height_above) return high;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (low + high);
    (height(middle) <= height_above ? low : high) = middle;
  }
  return low;
}

double CutterProfile::ridge(double across, double up) const {
  across = std::abs(across), up = std::abs(up);
  if (across == 0) return 0;
  // The higher cutter stands to the right. The ridge's top lies where both lower sides have one height.
  if (across > 2 * radius_) return kInfinity;
  const auto above = [&](double x) { return height(x) - up - height(std::abs(x - across)); };
  double low = std::max(0.0, across - radius_), high = radius_;
  Vec2 top;
  if (above(high) < 0) {
    top = {high, up + height(std::abs(high - across))};  // on the lower cutter's flank
  } else {
    for (int k = 0; k < kBisections; ++k) {
      const double x = 0.5 * (low + high);
      (above(x) < 0 ? low : high) = x;
    }
    top = {low, std::max(height(low), up + height(std::abs(low - across)))};
  }
  // The tangent of both is parallel to the line from one tip to the other.
  const Vec2 normal = Vec2(-up, across) / geom::hypot(up, across);
  double least = kInfinity;
  for (const Vec2& p : points_) least = std::min({least, glm::dot(normal, p), glm::dot(normal, Vec2(-p.x, p.y))});
  return std::max(0.0, glm::dot(normal, top) - least);
}

double CutterProfile::spacing(double cusp) const {
  double low = 0, high = radius_;
  if (ridge(high, 0) <= cusp) return high;
  for (int k = 0; k < kBisections; ++k) {
    const double d = 0.5 * (low + high);
    (ridge(d, 0) <= cusp ? low : high) = d;
  }
  return low;
}

RowSteps::RowSteps(const CutterProfile& profile, double cusp) {
  for (int k = 0; k <= kSlopes; ++k) {
    const double slope = kPi / 2 * k / kSlopes, x = base::cos(slope), z = base::sin(slope);
    double low = 0, high = profile.radius();
    for (int i = 0; i < 40; ++i) {
      const double d = 0.5 * (low + high);
      (profile.ridge(d * x, d * z) <= cusp ? low : high) = d;
    }
    steps_[static_cast<std::size_t>(k)] = low;
  }
}

double RowSteps::operator()(double across, double up) const {
  const double at = base::atan2(std::abs(up), across) / (kPi / 2) * kSlopes;
  const auto k = static_cast<std::size_t>(std::min(at, kSlopes - 1.0));
  return std::min(steps_[k], steps_[k + 1]);
}

}  // namespace riffler::plan
