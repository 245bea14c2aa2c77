#include "plan/lower_side.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"

namespace riffler::plan {

namespace {

constexpr double kAngle = 1e-15, kLastStep = 1e-9;  // rad; Newton's next step would be the square of the last one
constexpr double kSurely = 1e-9;                    // mm, far larger than rounding errors
// Least area of a parallelogram, seen from above, by the square of its longest edge (a slope of 88°, or 50 : 1), for
// its plane to be known to `kPlane` of the distance from it: at most 50 × 51 × a few roundings of 1.1e-16.
constexpr double kFlat = 0.02, kPlane = 1e-11;

}  // namespace

LowerSide::LowerSide(const tool::Piece& piece) : bottom_(bottom(piece)), flat_(radius_at(piece, bottom_)), rim_(flat_) {
  if (const auto* f = std::get_if<tool::Frustum>(&piece)) {
    if (f->r1 > f->r0) rim_ = f->r1, cone_ = (f->z1 - f->z0) / (f->r1 - f->r0);
    return;
  }
  const tool::Round& round = std::get<tool::Round>(piece);
  if (!(round.z0 < round.zc)) return;  // it narrows upwards: only its lower end is visible from below
  centre_ = {round.e, round.zc}, arc_ = round.r;
  rim_ = std::max(flat_, round.z1 >= round.zc ? round.e + round.r : radius_at(piece, round.z1));
}

double LowerSide::height(double rho) const {
  if (rho <= flat_) return bottom_;
  if (arc_ == 0) return bottom_ + cone_ * (rho - flat_);
  const double off = std::min(rho - centre_.x, arc_);
  return centre_.y - std::sqrt((arc_ - off) * (arc_ + off));
}

double LowerSide::radius_of_slope(double slope) const {
  if (arc_ == 0) return slope > cone_ ? rim_ : flat_;
  return std::clamp(centre_.x + arc_ * slope / std::sqrt(1 + slope * slope), flat_, rim_);
}

void LowerSide::at(const Vec3& p, Stop& stop) const {
  const double tip = p.z - height(std::min(glm::length(Vec2(p)), rim_));
  if (!stop.touches || tip > stop.tip) stop = {tip, p, true};
}

void LowerSide::corner(const Vec3& p, Stop& stop) const {
  if (p.x * p.x + p.y * p.y <= rim_ * rim_) at(p, stop);
}

/// u ≥ 0 that maximises slope·u − height(√(d² + u²)) beyond the flat end, for slope ≥ 0; not above the rim.
double LowerSide::best_on_line(double d, double slope) const {
  const double most = std::sqrt(std::max(0.0, (rim_ - d) * (rim_ + d)));
  if (arc_ == 0) return slope < cone_ ? std::min(most, d * slope / std::sqrt((cone_ - slope) * (cone_ + slope))) : most;
  if (centre_.x == 0) {
    const double half = std::sqrt(std::max(0.0, (arc_ - d) * (arc_ + d)));
    return std::min(most, half * slope / std::sqrt(1 + slope * slope));
  }
  // A torus or barrel: at angle φ of the arc the slope along the line is tan φ · u / ρ, which increases, so bracketed
  // Newton iteration finds where it equals `slope`. The bracket begins where the flat end stops: there is no arc
  // inside.
  const double inner = std::max(flat_, d), shortest = std::sqrt(std::max(0.0, (inner - d) * (inner + d)));
  if (slope == 0) return shortest;
  const auto angle = [&](double rho) { return base::asin(std::clamp((rho - centre_.x) / arc_, -1.0, 1.0)); };
  double low = angle(inner), high = angle(rim_);
  double phi = shortest > 0 ? base::atan(slope * inner / shortest) : 0.5 * (low + high);
  if (!(phi > low && phi < high)) phi = 0.5 * (low + high);
  for (int n = 0; n < 100 && high - low > kAngle; ++n) {
    const double s = base::sin(phi), c = base::cos(phi), rho = centre_.x + arc_ * s;
    const double u = std::sqrt(std::max(0.0, (rho - d) * (rho + d))), off = s * u - slope * rho * c;
    (off > 0 ? high : low) = phi;
    if (off == 0) break;
    const double grows = c * u + (u > 0 ? s * rho * arc_ * c / u : kInfinity) - slope * (arc_ * c * c - rho * s);
    const double next = phi - off / grows;
    if (!(next > low && next < high)) {
      phi = 0.5 * (low + high);
      continue;
    }
    const bool done = std::abs(next - phi) <= kLastStep;
    phi = next;
    if (done) break;
  }
  const double rho = centre_.x + arc_ * base::sin(phi);
  return std::min(most, std::sqrt(std::max(0.0, (rho - d) * (rho + d))));
}

void LowerSide::edge(const Vec3& a, const Vec3& b, Stop& stop) const {
  const Vec2 from(a.x, a.y), way(b.x - a.x, b.y - a.y);
  const double length = glm::length(way);
  if (!(length > 0)) return;  // vertical: its upper end decides
  const Vec2 along = way / length;
  const double start = glm::dot(from, along), slope = (b.z - a.z) / length;
  const double d = std::abs(from.x * along.y - from.y * along.x);
  if (d > rim_) return;
  if (stop.touches && std::max(a.z, b.z) - height(d) < stop.tip - kSurely) return;  // it cannot stop the tool higher
  const double sign = slope < 0 ? -1 : 1;
  const auto look = [&](double u) {
    const double t = u - start;
    if (t > 0 && t < length) at(glm::mix(a, b, t / length), stop);
  };
  if (d <= flat_) look(sign * std::sqrt((flat_ - d) * (flat_ + d)));
  if (rim_ > flat_)
    if (const double u = best_on_line(d, std::abs(slope)); std::sqrt(d * d + u * u) >= flat_) look(sign * u);
}

void LowerSide::facet(const Vec3& a, const Vec3& b, const Vec3& c, Stop& stop) const {
  Vec3 normal = glm::cross(b - a, c - a);
  if (normal.z < 0) normal = -normal;
  const double across = geom::hypot(normal.x, normal.y);
  if (!(normal.z > 1e-14 * across)) return;  // vertical or without area: its edges decide
  const double rho = across > 0 ? radius_of_slope(across / normal.z) : 0.0;
  const Vec2 p = across > 0 ? Vec2(normal.x, normal.y) * (-rho / across) : Vec2(0);
  const auto side = [&](const Vec3& s, const Vec3& t) { return (t.x - s.x) * (p.y - s.y) - (t.y - s.y) * (p.x - s.x); };
  const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
  if (!((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0))) return;
  at({p, a.z - (normal.x * (p.x - a.x) + normal.y * (p.y - a.y)) / normal.z}, stop);
}

std::optional<LowerSide::OnPlane> LowerSide::on_plane(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const Vec3 ab = b - a, bc = c - b, ca = a - c, normal = glm::cross(ab, bc);
  const double size2 = std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
  if (!(std::abs(normal.z) > kFlat * size2)) return {};
  const Vec2 slope(-normal.x / normal.z, -normal.y / normal.z);
  const double steep = glm::length(slope), rho = steep > 0 ? radius_of_slope(steep) : 0.0;
  const double error = kSurely + kPlane * (std::abs(a.x) + std::abs(a.y) + std::abs(a.z));
  return OnPlane{slope, steep > 0 ? slope * (rho / steep) : Vec2(0),
                 a.z - slope.x * a.x - slope.y * a.y + steep * rho - height(rho) + error};
}

void LowerSide::meet(const Vec3& a, const Vec3& b, const Vec3& c, Stop& stop) const {
  const std::optional<OnPlane> plane = on_plane(a, b, c);
  if (!plane) {
    corner(a, stop), corner(b, stop), corner(c, stop);
    edge(a, b, stop), edge(b, c, stop), edge(c, a, stop);
    facet(a, b, c, stop);
    return;
  }
  if (stop.touches && plane->tip < stop.tip) return;
  // Towards the plane's contact, the tip on the plane rises: it is highest there, or on the edges that face the
  // contact.
  const Vec2& place = plane->place;
  const double turn = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
  bool inside = true;
  const auto faces = [&](const Vec3& s, const Vec3& t) {
    const Vec2 way(t.x - s.x, t.y - s.y);
    const double across = way.x * (place.y - s.y) - way.y * (place.x - s.x), inwards = turn > 0 ? across : -across;
    inside = inside && inwards >= 0;
    return inwards <= kSurely * (std::abs(way.x) + std::abs(way.y));
  };
  const bool ab = faces(a, b), bc = faces(b, c), ca = faces(c, a);
  if (ca || ab) corner(a, stop);
  if (ab || bc) corner(b, stop);
  if (bc || ca) corner(c, stop);
  if (ab) edge(a, b, stop);
  if (bc) edge(b, c, stop);
  if (ca) edge(c, a, stop);
  if (inside) at({place, a.z + plane->slope.x * (place.x - a.x) + plane->slope.y * (place.y - a.y)}, stop);
}

}  // namespace riffler::plan
