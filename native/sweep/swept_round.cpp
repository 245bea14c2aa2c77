// The torus and the barrel. Distance to a disc (or, for a barrel, to a circle beyond the axis) is a convex function of
// the point, so its least value over the way is convex along the ray, and Newton's method started outside of the body
// walks to the first root without a bracket and without passing it.
#include <algorithm>
#include <cmath>

#include "sweep/swept_piece.hpp"

namespace riffler {

namespace {
constexpr int kNewtonSteps = 80;  // at a tangent ray each step only halves the gap; 2⁻⁸⁰ is far below rounding
}

/// Distance from a point of the section to the round's surface, and what its square does along the way.
struct SweptPiece::Gap {
  double distance;    // negative inside
  double along_s;     // ∂ distance / ∂s
  double pull, bend;  // ½ ∂D²/∂τ and ½ ∂²D²/∂τ², D the distance to the disc
};

SweptPiece::Gap SweptPiece::gap(const Ray& ray, double s, double way) const {
  const double a = ray.x + s * tilt_ - way * m1_, b = ray.y - way * m2_, z = ray.z + s * ray.oz - way * mo_ - zc_;
  const double rho = std::hypot(a, b), out = std::max(rho - e_, 0.0), d = std::hypot(out, z);
  const double rho_s = rho > 0 ? a * tilt_ / rho : 0, rho_t = rho > 0 ? -(a * m1_ + b * m2_) / rho : 0;
  Gap g{d - r_, d > 0 ? (out * rho_s + z * ray.oz) / d : 0, out * rho_t - z * mo_, mo_ * mo_};
  if (out > 0) g.bend += rho_t * rho_t + out * (m1_ * m1_ + m2_ * m2_ - rho_t * rho_t) / rho;
  return g;
}

double SweptPiece::nearest_way(const Ray& ray, double s, const Interval& ways, double guess) const {
  if (ways.near == ways.far) return ways.near;
  if (gap(ray, s, ways.near).pull >= 0) return ways.near;
  if (gap(ray, s, ways.far).pull <= 0) return ways.far;
  Interval bracket = ways;
  double t = std::clamp(guess, ways.near, ways.far);
  for (int i = 0; i < 200; ++i) {
    const Gap g = gap(ray, s, t);
    if (g.pull == 0) break;
    (g.pull < 0 ? bracket.near : bracket.far) = t;
    double next = g.bend > 0 ? t - g.pull / g.bend : bracket.near;
    if (!(next > bracket.near && next < bracket.far)) next = (bracket.near + bracket.far) / 2;
    const bool done = std::abs(next - t) <= 1e-15 * way_ || bracket.length() <= 1e-15 * way_;
    t = next;
    if (done) break;
  }
  return t;
}

bool SweptPiece::extreme(const Ray& ray, double sign, const Interval& ways, SweptHit& out) const {
  // Starts beyond everything the round can reach on this ray, seen from its centre at both ends of the way.
  const double reach = (std::max(e_, 0.0) + r_) * (1 + 1e-9), size = std::abs(e_) + r_;
  const double c0 = zc_ * axis_.z + ways.near * direction_.z, c1 = zc_ * axis_.z + ways.far * direction_.z;
  double s = sign > 0 ? std::min(c0, c1) - reach : std::max(c0, c1) + reach;
  double way = (ways.near + ways.far) / 2;
  double before = s;
  bool smooth = true;
  for (int i = 0; i < kNewtonSteps; ++i) {
    way = nearest_way(ray, s, ways, way);
    const Gap g = gap(ray, s, way);
    const bool end = way == ways.near || way == ways.far;
    smooth = smooth && (end || std::abs(g.pull) <= 1e-6 * size);
    // Deep inside, or past it, after a step with a wrong slope: at a barrel's pole the distance has an edge.
    const bool past = g.distance < -1e-9 * size || (g.distance > 1e-15 * size && !(sign * g.along_s < 0));
    if (past && !smooth) return between(ray, before, s, ways, out);
    if (g.distance <= 1e-15 * size) return out = {s, way, Surface::Lateral}, true;
    if (!(sign * g.along_s < 0)) return false;
    const double next = s - g.distance / g.along_s;
    // From outside the way only goes on; where it does not, rounding is all that is left.
    if (!(sign * (next - s) > 0)) return out = {s, way, Surface::Lateral}, true;
    before = s, s = next;
  }
  return false;
}

/// The end between `outside` and `beyond`, without slopes: the least distance over the way is convex along the ray.
bool SweptPiece::between(const Ray& ray, double outside, double beyond, const Interval& ways, SweptHit& out) const {
  const auto least = [&](double s) {
    return gap(ray, s, nearest_way(ray, s, ways, (ways.near + ways.far) / 2)).distance;
  };
  const double golden = 0.6180339887498949;
  double inside = beyond;
  if (least(beyond) > 0) {
    double a = outside, b = beyond + (beyond - outside), x = b - golden * (b - a), y = a + golden * (b - a);
    double fx = least(x), fy = least(y);
    for (int i = 0; i < 100 && std::min(fx, fy) > 0; ++i) {
      if (fx < fy)
        b = y, y = x, fy = fx, x = b - golden * (b - a), fx = least(x);
      else
        a = x, x = y, fx = fy, y = a + golden * (b - a), fy = least(y);
    }
    if (std::min(fx, fy) > 0) return false;
    inside = fx < fy ? x : y;
  }
  for (int i = 0; i < 200; ++i) {
    const double middle = (outside + inside) / 2;
    if (middle == outside || middle == inside) break;
    (least(middle) > 0 ? outside : inside) = middle;
  }
  out = {inside, nearest_way(ray, inside, ways, (ways.near + ways.far) / 2), Surface::Lateral};
  return true;
}

void SweptPiece::torus(const Ray& ray, Extremes& out) const {
  const bool cut = cut_bottom_ || cut_top_;
  SweptHit low, high;
  // One by one: at a barrel's pole, which is always cut off, the search may fail where the other end is good.
  for (const double sign : {1.0, -1.0}) {
    SweptHit h;
    if (!extreme(ray, sign, {0, way_}, h)) continue;
    const double z = ray.z + ray.oz * h.s - mo_ * h.way;
    if (z >= low_ && z <= high_) out.add(h.s, h.way, Surface::Lateral);
  }
  if (!cut) return;
  clip_faces(ray, out);
  for (const double way : {0.0, way_}) {
    const Interval inside = slab_at(ray, way);
    if (!inside.empty() && extreme(ray, 1, {way, way}, low) && extreme(ray, -1, {way, way}, high)) {
      const bool up = ray.oz > 0;
      const Interval at = inside.cut({low.s, high.s});
      if (!at.empty()) {
        out.add(at.near, way, at.near > low.s ? (up ? Surface::Bottom : Surface::Top) : Surface::Lateral);
        out.add(at.far, way, at.far < high.s ? (up ? Surface::Top : Surface::Bottom) : Surface::Lateral);
      }
    }
    if (way_ == 0) return;
  }
}

}  // namespace riffler
