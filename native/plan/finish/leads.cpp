#include "plan/finish/leads.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/lead_arc.hpp"
#include "plan/pose_leads.hpp"

namespace riffler::plan {

namespace {

constexpr double kLeastTurn = kPi / 6;  // an arc from straight above a steep row turns less than a quarter
constexpr double kLongestTurn = 0.75 * kPi;

/// The direction of the first move of a row that is longer than rounding.
std::optional<Vec3> direction(const std::vector<Vec3>& tips, double least) {
  for (const Vec3& tip : tips)
    if (const Vec3 way = tip - tips.front(); glm::length(way) > least) return glm::normalize(way);
  return {};
}

}  // namespace

Leads::Leads(const FinishSurface& surface, const Tool& tool, double radius, bool level, const Mesh& stock)
    : surface_(surface), radius_(radius), level_(level) {
  if (!(radius > 0) || stock.empty()) return;
  if (const auto body = body_of(tool)) body_.emplace(stock, body->first), body_height_ = body->second;
}

std::vector<Vec3> Leads::out(const CutPiece& piece) const {
  std::vector<Vec3> found = arc({piece.tips.rbegin(), piece.tips.rend()}, true);
  std::reverse(found.begin(), found.end());
  return found;
}

/// An arc towards the first of the tips. `reversed`: the tool moves on it in the opposite direction.
std::vector<Vec3> Leads::arc(const std::vector<Vec3>& tips, bool reversed) const {
  if (!(radius_ > 0)) return {};
  const std::optional<Vec3> way = direction(tips, 0.1 * surface_.tolerance());
  if (!way) return {};
  const Vec3& p = tips.front();
  const double across = geom::hypot(way->x, way->y);
  if (!(across > 1e-3)) return {};  // upright: the move itself is a plunge
  if (level_ && std::abs(way->z) < 1e-6) {
    const Vec3 left(-way->y / across, way->x / across, 0);
    for (const double side : {1.0, -1.0})
      if (std::vector<Vec3> found =
              lead_arc(p, Vec3(way->x, way->y, 0) / across, side * (reversed ? -1.0 : 1.0) * left, radius_, 0.5 * kPi);
          fits(found, p))
        return found;
  }
  // In the upright plane through the move; the arc begins straight above the surface.
  const Vec3 up(-way->z * way->x / across, -way->z * way->y / across, across);
  const double turn = std::clamp(0.5 * kPi + base::atan2(way->z, across), kLeastTurn, kLongestTurn);
  std::vector<Vec3> found = lead_arc(p, *way, up, radius_, turn);
  return fits(found, p) ? found : std::vector<Vec3>{};
}

bool Leads::fits(const std::vector<Vec3>& arc, const Vec3& end) const {
  for (std::size_t k = 0; k < arc.size(); ++k) {
    const Vec3 &from = arc[k], &to = k + 1 < arc.size() ? arc[k + 1] : end;
    if (surface_.above(from, to) > 0) return false;
    const Vec3 up(0, 0, body_height_);
    if (body_ && body_->rise(from + up, to + up, 0).above > 0) return false;
  }
  return true;
}

}  // namespace riffler::plan
