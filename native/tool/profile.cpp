#include "riffler/tool/profile.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/hypot.hpp"

namespace riffler::tool {

namespace {

[[noreturn]] void refuse(std::size_t segment, const std::string& what) {
  throw std::invalid_argument("profile segment " + std::to_string(segment) + ": " + what);
}

/// An arc of a profile with non-falling heights lies entirely on one side of its centre: on the right it bulges
/// outwards (convex), on the left it is concave.
bool bulges(const Vec2& from, const Vec2& to, const Vec2& centre) {
  return from.x + to.x >= 2 * centre.x;
}

void check_arc(std::size_t i, const Vec2& from, const Vec2& to, const Vec2& centre) {
  const double r = glm::length(from - centre), slack = std::min(1e-6 * r, Profile::kConcaveTolerance);
  if (!(r > 0) || std::abs(glm::length(to - centre) - r) > slack)
    refuse(i, "the arc's two ends are not equally far from its centre");
  const bool right = from.x >= centre.x - slack && to.x >= centre.x - slack;
  const bool left = from.x <= centre.x + slack && to.x <= centre.x + slack;
  if (!right && !left) refuse(i, "the arc's height rises and falls; split it at its highest or lowest point");
}

/// Adds truncated cones inside a concave arc. The tangent polygon is outside the arc's circle, inside the solid, so the
/// cones cut nothing that the arc would leave.
void add_hollow(const Vec2& from, const Vec2& to, const Vec2& centre, std::vector<Piece>& out) {
  const double r = glm::length(from - centre);
  const double start = base::atan2(from.y - centre.y, from.x - centre.x);
  const double turn = std::remainder(base::atan2(to.y - centre.y, to.x - centre.x) - start, 2 * base::acos(-1.0));
  const double widest = 2 * base::acos(r / (r + Profile::kConcaveTolerance));
  const int n = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / widest)));
  const double half = turn / n / 2, far = r / base::cos(half);
  const double thinnest = 1e-9 * r;  // rounding may leave such a thin remainder of a level tangent
  Vec2 last = from;
  for (int k = 0; k <= n; ++k) {
    const double angle = start + (2 * k + 1) * half;
    Vec2 next = k == n ? to : centre + far * Vec2(base::cos(angle), base::sin(angle));
    next = {std::max(next.x, 0.0), std::clamp(next.y, last.y, to.y)};
    if (to.y - next.y <= thinnest) next.y = to.y;
    if (next.y - last.y <= thinnest) next.y = last.y;
    if (next.y > last.y) out.push_back(Frustum{last.y, last.x, next.y, next.x});
    last = next;
  }
}

/// Whether the frustum contains the part of `round`'s full shape above round.z1.
bool contains_rest(const Frustum& f, const Round& round) {
  if (round.e < 0 || std::abs(f.z0 - round.z1) > 1e-12 * round.r || round.zc + round.r > f.z1) return false;
  const double slope = (f.r1 - f.r0) / (f.z1 - f.z0);
  if (slope < 0) return false;
  const double to_flank = (f.r0 + slope * (round.zc - f.z0) - round.e) / geom::hypot(1.0, slope);
  return to_flank >= round.r * (1 - 1e-12);
}

}  // namespace

Profile::Profile(std::vector<ProfileSegment> segments) : segments_(std::move(segments)) {
  if (segments_.empty()) throw std::invalid_argument("a profile needs at least one segment");
  Vec2 from{0, 0};
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const ProfileSegment& s = segments_[i];
    if (!std::isfinite(s.to.x) || !std::isfinite(s.to.y)) refuse(i, "its end is not finite");
    if (s.to.x < 0) refuse(i, "its radius is negative");
    if (std::max(s.to.x, s.to.y) > kLargest) refuse(i, "it exceeds the largest size of a tool, 1e6 mm");
    if (s.to.y < from.y) refuse(i, "its height falls; heights go from the tip upwards");
    if (s.centre) {
      if (!std::isfinite(s.centre->x) || !std::isfinite(s.centre->y)) refuse(i, "its centre is not finite");
      if (std::max(std::abs(s.centre->x), std::abs(s.centre->y)) > kLargest)
        refuse(i, "its centre is farther away than 1e6 mm; replace so flat an arc by a line");
      check_arc(i, from, s.to, *s.centre);
      if (bulges(from, s.to, *s.centre) && s.centre->y > from.y && s.centre->y < s.to.y)
        max_radius_ = std::max(max_radius_, s.centre->x + glm::length(from - *s.centre));
    }
    max_radius_ = std::max(max_radius_, s.to.x);
    from = s.to;
  }
  if (!(length() > 0)) throw std::invalid_argument("a profile needs a length greater than 0");
  if (!(max_radius_ > 0)) throw std::invalid_argument("a profile needs a radius greater than 0 somewhere");
}

std::vector<Piece> Profile::pieces() const {
  std::vector<Piece> out;
  Vec2 from{0, 0};
  for (const ProfileSegment& s : segments_) {
    if (s.to.y > from.y) {
      if (!s.centre)
        out.push_back(Frustum{from.y, from.x, s.to.y, s.to.x});
      else if (bulges(from, s.to, *s.centre))
        out.push_back(Round{s.centre->x, s.centre->y, glm::length(from - *s.centre), from.y, s.to.y});
      else
        add_hollow(from, s.to, *s.centre, out);
    }
    from = s.to;
  }
  // A complete ball or torus is simpler to sweep than a zone of it: use it if the piece above hides the rest.
  for (std::size_t i = 0; i + 1 < out.size(); ++i)
    if (auto* round = std::get_if<Round>(&out[i]))
      if (const auto* above = std::get_if<Frustum>(&out[i + 1]); above && contains_rest(*above, *round))
        round->z1 = round->zc + round->r;
  return out;
}

}  // namespace riffler::tool
