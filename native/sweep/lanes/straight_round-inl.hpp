// Finds the ends of the cut by a torus or barrel on a straight path, many rays at a time.
//
// The distance D(s, τ) from a point of the section to the disc (for a barrel, to a circle beyond the axis) is convex in
// both variables, and so is its square F. A point with F = r², ∂F/∂s < 0 and ∂F/∂τ = 0 (or at an end of the path, with
// the slope pointing outwards) *is* the near end, no matter how it was found (Karush-Kuhn-Tucker conditions). If a
// tangent plane of F stays above r² for all heights and path lengths, there is no end. The search tests both conditions
// at every step. Each step replaces F by a quadratic, which is exact for a ball, and for any Round whose axis is
// parallel to the ray.
#if defined(RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#undef RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#else
#define RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#endif

#include "sweep/lanes/cut_lanes-inl.hpp"
#include "sweep/straight_part.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

class StraightRound {
 public:
  StraightRound(const StraightBody& body, const SweptShape& piece, const SectionRays& rays)
      : b_(body), p_(piece), r_(rays), size_(std::abs(piece.e) + piece.r) {}

  /// Finds the near (sign 1) or far (−1) end, and the path length at which it arises, in lanes of `mask`. Returns the
  /// lanes that have one. A lane that does not meet the Round between the heights `low` and `high` may count as having
  /// none.
  M end(M mask, double sign, V low, V high, V& end, V& end_way) const {
    V s, way;
    M hit = both(mask, start(sign, s, way)), open = without(mask, hit);
    for (int i = 0; i < kSteps && !none(open); ++i) {
      const Gap g = gap(s, way);
      open = without(open, misses(g, s, way, low, high));
      M falls;
      const M arrived = both(open, step(g, open, sign, s, way, falls));
      hit = either(hit, both(arrived, falls)), open = without(open, arrived);
    }
    if (!none(open)) hit = either(hit, search(open, sign, s, way));
    end = s, end_way = way;
    return hit;
  }

 private:
  static constexpr int kSteps = 16;
  static constexpr double kNear = 3e-5;      // of the smaller radius; a step shorter than this ends exactly
  static constexpr double kNearAxis = 3e-4;  // of ρ; the same for a barrel
  struct Point {
    V a, b, z, square, rho;  // relative to the centre; ρ² and ρ
  };
  struct Gap {
    V f;                               // F − r²
    V along, across;                   // ½ ∂F/∂s, ½ ∂F/∂τ
    V along_bend, across_bend, mixed;  // ½ ∂²F/∂s², ½ ∂²F/∂τ², ½ ∂²F/∂s∂τ
    V rho;
  };

  HWY_INLINE Point point(V s, V way) const {
    Point p;
    p.a = hn::Sub(hn::Add(r_.x, hn::Mul(s, set(b_.tilt))), hn::Mul(way, set(b_.m1)));
    p.b = hn::Sub(r_.y, hn::Mul(way, set(b_.m2)));
    p.z = hn::Sub(hn::Add(hn::Sub(r_.z, set(p_.zc)), hn::Mul(s, set(b_.oz))), hn::Mul(way, set(b_.mo)));
    p.square = hn::Add(hn::Mul(p.a, p.a), hn::Mul(p.b, p.b)), p.rho = sqrt(p.square);
    return p;
  }

  HWY_INLINE Gap gap(V s, V way) const {
    const Point p = point(s, way);
    // avoids 1 / ρ, which would have to wait for the root
    const V per_rho = hn::Mul(p.rho, hn::Div(set(1), max(p.square, set(1e-300))));
    const V out = max(hn::Sub(p.rho, set(p_.e)), zero());
    const V rho_s = hn::Mul(hn::Mul(p.a, set(b_.tilt)), per_rho);
    const V rho_t = hn::Neg(hn::Mul(hn::Add(hn::Mul(p.a, set(b_.m1)), hn::Mul(p.b, set(b_.m2))), per_rho));
    const V share = hn::Mul(out, per_rho);
    const M beside = hn::Gt(out, zero());
    // ρ_i ρ_j + out ρ_ij outside the disc, plus the contribution of the height
    const auto bend = [&](V i, V j, double plane, double height) {
      const V product = hn::Mul(i, j);
      const V aside = hn::Add(product, hn::Mul(share, hn::Sub(set(plane), product)));
      return hn::Add(set(height), hn::IfThenElseZero(beside, aside));
    };
    Gap g;
    g.f = hn::Sub(hn::Add(hn::Mul(out, out), hn::Mul(p.z, p.z)), set(p_.r * p_.r));
    g.along = hn::Add(hn::Mul(out, rho_s), hn::Mul(p.z, set(b_.oz)));
    g.across = hn::Sub(hn::Mul(out, rho_t), hn::Mul(p.z, set(b_.mo)));
    g.along_bend = bend(rho_s, rho_s, b_.tilt * b_.tilt, b_.oz * b_.oz);
    g.across_bend = bend(rho_t, rho_t, b_.m1 * b_.m1 + b_.m2 * b_.m2, b_.mo * b_.mo);
    g.mixed = bend(rho_s, rho_t, -b_.tilt * b_.m1, -b_.oz * b_.mo);
    g.rho = p.rho;
    return g;
  }

  V on_way(V way) const { return min(max(way, zero()), set(b_.way)); }

  /// Start of the search. Returns the lanes in which the start is already the end: on the flat face of a disc, at the
  /// end of the path where it is farthest out.
  HWY_INLINE M start(double sign, V& s, V& way) const {
    const double steep = 0.3, level = b_.m1 * b_.m1 + b_.m2 * b_.m2, along = sign * b_.oz;
    if (!(std::abs(b_.oz) > steep)) {
      way = set(0.5 * b_.way);
      s = beside(sign, way);
      return no_lane();
    }
    const bool below = along > 0;
    const double face = below ? std::max(p_.z0, p_.zc - p_.r) : std::min(p_.z1, p_.zc + p_.r);
    const auto crossing = [&](V t) {
      return hn::Mul(hn::Add(hn::Sub(set(face), r_.z), hn::Mul(t, set(b_.mo))), set(1 / b_.oz));
    };
    const V last = set((below ? b_.mo < 0 : b_.mo > 0) ? b_.way : 0);
    s = crossing(last);
    const V a = hn::Sub(hn::Add(r_.x, hn::Mul(s, set(b_.tilt))), hn::Mul(last, set(b_.m1)));
    const V b = hn::Sub(r_.y, hn::Mul(last, set(b_.m2)));
    const V aside = hn::Add(hn::Mul(a, a), hn::Mul(b, b)), disc = set(p_.e > 0 ? p_.e * p_.e : 0);
    const M over = hn::Le(aside, disc);
    // Otherwise start nearest to the axis or, if the disc passes over the ray, just after it has left the ray, where F
    // bends sharply.
    const double left = 1 + 1e-9;
    const double per_level = level > 1e-12 ? 1 / level : 0;
    const V ahead = hn::Mul(hn::Add(hn::Mul(a, set(b_.m1)), hn::Mul(b, set(b_.m2))), set(per_level));
    const V chord = hn::Mul(
        hn::Sub(hn::Mul(disc, set(left)), hn::Sub(aside, hn::Mul(hn::Mul(ahead, ahead), set(level)))), set(per_level));
    const V half = sqrt(max(chord, zero()));
    way = pick(over, last, on_way(hn::Add(hn::Add(last, ahead), half)));
    s = pick(over, s, crossing(way));
    return (below ? p_.cut0 : p_.cut1) ? no_lane() : over;
  }

  /// Start outside the Round: over the disc, F is constant and gives no search direction.
  V beside(double sign, V way) const {
    const V x = hn::Sub(r_.x, hn::Mul(way, set(b_.m1)));
    const V z = hn::Sub(hn::Sub(r_.z, set(p_.zc)), hn::Mul(way, set(b_.mo)));
    const V nearest = hn::Neg(hn::Add(hn::Mul(x, set(b_.tilt)), hn::Mul(z, set(b_.oz))));
    return hn::Sub(nearest, set(sign * (std::max(p_.e, 0.0) + p_.r)));
  }

  /// Whether the tangent plane of F shows that the Round is nowhere on the path at these heights.
  HWY_INLINE M misses(const Gap& g, V s, V way, V low, V high) const {
    const V up = min(hn::Mul(g.along, hn::Sub(low, s)), hn::Mul(g.along, hn::Sub(high, s)));
    const V on = min(hn::Neg(hn::Mul(g.across, way)), hn::Mul(g.across, hn::Sub(set(b_.way), way)));
    return hn::Ge(hn::Add(hn::Mul(set(0.5), g.f), hn::Add(up, on)), zero());
  }

  /// Steps to the end of the quadratic with the same derivatives or, if it has none (`falls` false), to its lowest
  /// point. Returns the lanes in which the step was so short that its third-order error is below rounding.
  HWY_INLINE M step(const Gap& g, M open, double sign, V& s, V& way, M& falls) const {
    const V bend = max(g.across_bend, set(1e-12)), per_bend = hn::Div(set(1), bend);
    // If the lowest point along the path is at one of its ends, it stays there as s changes.
    const V back = hn::Neg(hn::Mul(way, bend)), ahead = hn::Mul(hn::Sub(set(b_.way), way), bend);
    const V wanted = hn::Neg(g.across);
    const M free = both(hn::Ge(wanted, back), hn::Le(wanted, ahead));
    const V on = hn::Sub(pick(hn::Lt(wanted, back), zero(), set(b_.way)), way);
    // For the free lanes, multiply all coefficients by the bend: the root is the same, without waiting for a division.
    const V a =
        max(pick(free, hn::Sub(hn::Mul(g.along_bend, bend), hn::Mul(g.mixed, g.mixed)), g.along_bend), set(1e-24));
    const V b = hn::Mul(set(sign), pick(free, hn::Sub(hn::Mul(g.along, bend), hn::Mul(g.across, g.mixed)),
                                        hn::Add(g.along, hn::Mul(g.mixed, on))));
    const V c = pick(free, hn::Sub(hn::Mul(g.f, bend), hn::Mul(g.across, g.across)),
                     hn::Add(g.f, hn::Mul(on, hn::Add(hn::Add(g.across, g.across), hn::Mul(bend, on)))));
    const V disc = hn::Sub(hn::Mul(b, b), hn::Mul(a, c)), root = sqrt(max(disc, zero()));
    falls = both(hn::Lt(b, zero()), hn::Gt(disc, zero()));
    const V top = pick(falls, c, hn::Neg(hn::Add(b, root))), bottom = pick(falls, hn::Sub(root, b), a);
    const V reach = set(2 * size_);
    const V move = hn::Mul(set(sign), min(max(hn::Div(top, bottom), hn::Neg(reach)), reach));
    const V lean = hn::Mul(hn::Sub(wanted, hn::Mul(g.mixed, move)), per_bend);
    const V next = pick(free, on_way(hn::Add(way, lean)), hn::Add(way, on)), turn = hn::Sub(next, way);
    s = pick(open, hn::Add(s, move), s), way = pick(open, next, way);
    const V near = set(kNear * std::min(p_.r, p_.e + p_.r));
    // A barrel's F has an edge on the axis: near it, F bends within a length of ρ.
    return hn::Le(max(abs(move), abs(turn)), p_.e < 0 ? min(near, hn::Mul(set(kNearAxis), g.rho)) : near);
  }

  // Fallback, slow and safe:

  /// The path length at which the piece comes nearest to the point at s: a root of a monotonic slope.
  V nearest(V s) const {
    V low = zero(), high = set(b_.way);
    for (int i = 0; i < 64; ++i) {
      const V middle = hn::Mul(set(0.5), hn::Add(low, high));
      const M past = hn::Gt(gap(s, middle).across, zero());
      high = pick(past, middle, high), low = pick(past, low, middle);
    }
    return low;
  }
  V least(V s) const { return gap(s, nearest(s)).f; }

  /// Brackets the minimum over s of the least F along the path, then bisects towards the end.
  HWY_NOINLINE M search(M mask, double sign, V& s, V& way) const {
    const double reach = std::max(p_.e, 0.0) + p_.r, slack = 1e-9 * size_, golden = 0.6180339887498949;
    const double c0 = p_.zc * b_.oz, c1 = c0 + b_.way * (b_.m1 * b_.tilt + b_.mo * b_.oz);
    const double first = std::min(c0, c1) - reach - slack, last = std::max(c0, c1) + reach + slack;
    V low = set(first), high = set(last);
    for (int i = 0; i < 90; ++i) {
      const V part = hn::Mul(set(golden), hn::Sub(high, low)), a = hn::Sub(high, part), b = hn::Add(low, part);
      const M left = hn::Lt(least(a), least(b));
      high = pick(left, b, high), low = pick(left, low, a);
    }
    V in = hn::Mul(set(0.5), hn::Add(low, high)), out = set(sign > 0 ? first : last);
    const M hit = both(mask, hn::Lt(least(in), zero()));
    for (int i = 0; i < 64; ++i) {
      const V middle = hn::Mul(set(0.5), hn::Add(in, out));
      const M inside = hn::Le(least(middle), zero());
      in = pick(inside, middle, in), out = pick(inside, out, middle);
    }
    s = pick(mask, in, s), way = pick(mask, nearest(in), way);
    return hit;
  }

  const StraightBody& b_;
  const SweptShape& p_;
  const SectionRays& r_;
  double size_;
};

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
