// SweptPiece's torus and barrel (swept_round.cpp) for many rays at a time.
//
// The distance D(s, τ) from a point of the section to the disc is convex in both, so a point with D = r, ∂D/∂τ = 0 (or
// at an end of the way, with the slope outwards) and ∂D/∂s < 0 *is* the near end, however it was found (the conditions
// of Karush, Kuhn and Tucker). Newton's method on the two equations finds most; the rest is left to the nested search,
// whose every step is safe.
#if defined(RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#undef RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#else
#define RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#endif

#include "sweep/cut_lanes-inl.hpp"
#include "sweep/swept_piece.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

class StraightRound {
 public:
  StraightRound(const SweptShape& shape, const SectionRays& rays) : p_(shape), r_(rays) {
    size_ = std::abs(shape.e) + shape.r;
  }

  /// Moves `at`, which lies outside, to the near (sign 1) or far (−1) end. Returns the lanes that meet the body; `open`
  /// are those in which it cannot say.
  M end(M mask, double sign, V& at, M& open) const {
    V way = nearest(at);
    at = onto_ball(at, way, sign);
    open = mask;
    M hit = no_lane();
    for (int i = 0; i < kSteps && !none(open); ++i) {
      const Gap g = gap(at, way);
      const M arrived = both(open, settled(g, way, sign));
      hit = either(hit, arrived), open = without(open, arrived);
      step(g, open, at, way);
    }
    return hit;
  }

  /// Lanes whose point at s lies in the body, surely.
  M holds(V s) const {
    const Gap g = gap(s, nearest(s));
    return hn::Le(g.distance, zero());
  }

 private:
  static constexpr int kSteps = 12;
  struct Gap {
    V distance;           // negative inside
    V along, across;      // ∂D/∂s, ∂D/∂τ
    V pull, bend, mixed;  // ½ ∂D²/∂τ, ½ ∂²D²/∂τ², ½ ∂²D²/∂s∂τ
  };

  Gap gap(V s, V way) const {
    const V a = hn::Sub(hn::Add(r_.x, hn::Mul(s, set(p_.tilt))), hn::Mul(way, set(p_.m1)));
    const V b = hn::Sub(r_.y, hn::Mul(way, set(p_.m2)));
    const V z = hn::Sub(hn::Add(hn::Sub(r_.z, set(p_.zc)), hn::Mul(s, set(p_.oz))), hn::Mul(way, set(p_.mo)));
    const V rho = max(sqrt(hn::Add(hn::Mul(a, a), hn::Mul(b, b))), set(1e-150)), per_rho = hn::Div(set(1), rho);
    const V out = max(hn::Sub(rho, set(p_.e)), zero());
    const V d = max(sqrt(hn::Add(hn::Mul(out, out), hn::Mul(z, z))), set(1e-150)), per_d = hn::Div(set(1), d);
    const V rho_s = hn::Mul(hn::Mul(a, set(p_.tilt)), per_rho);
    const V rho_t = hn::Neg(hn::Mul(hn::Add(hn::Mul(a, set(p_.m1)), hn::Mul(b, set(p_.m2))), per_rho));
    const M beside = hn::Gt(out, zero());
    const V share = hn::Mul(out, per_rho), along = hn::IfThenElseZero(beside, set(1));
    Gap g;
    g.distance = hn::Sub(d, set(p_.r));
    g.along = hn::Mul(hn::Add(hn::Mul(out, rho_s), hn::Mul(z, set(p_.oz))), per_d);
    g.pull = hn::Sub(hn::Mul(out, rho_t), hn::Mul(z, set(p_.mo)));
    g.across = hn::Mul(g.pull, per_d);
    // Second derivatives of ½ (out² + z²): ρ_i ρ_j + out ρ_ij beside the disc, and those of z.
    const V tt = hn::Add(hn::Mul(rho_t, rho_t),
                         hn::Mul(share, hn::Sub(set(p_.m1 * p_.m1 + p_.m2 * p_.m2), hn::Mul(rho_t, rho_t))));
    const V st = hn::Add(hn::Mul(rho_s, rho_t), hn::Mul(share, hn::Sub(set(-p_.tilt * p_.m1), hn::Mul(rho_s, rho_t))));
    g.bend = hn::Add(set(p_.mo * p_.mo), hn::Mul(along, tt));
    g.mixed = hn::Sub(hn::Mul(along, st), set(p_.oz * p_.mo));
    return g;
  }

  /// Where the ray meets the ball about the disc's point nearest to its point at s: close to the end even where it only
  /// grazes. Left as it is where it misses that ball.
  V onto_ball(V s, V way, double sign) const {
    if (p_.e <= 0) return s;
    const V a = hn::Sub(hn::Add(r_.x, hn::Mul(s, set(p_.tilt))), hn::Mul(way, set(p_.m1)));
    const V b = hn::Sub(r_.y, hn::Mul(way, set(p_.m2)));
    const V z = hn::Sub(hn::Add(hn::Sub(r_.z, set(p_.zc)), hn::Mul(s, set(p_.oz))), hn::Mul(way, set(p_.mo)));
    const V rho = sqrt(hn::Add(hn::Mul(a, a), hn::Mul(b, b)));
    const V beyond = max(hn::Sub(set(1), hn::Div(set(p_.e), max(rho, set(1e-150)))), zero());
    const V x = hn::Mul(a, beyond), y = hn::Mul(b, beyond);
    const V q1 = hn::Add(hn::Mul(x, set(p_.tilt)), hn::Mul(z, set(p_.oz)));
    const V q0 = hn::Sub(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)), set(p_.r * p_.r));
    const V disc = hn::Sub(hn::Mul(q1, q1), q0);
    const V move = hn::Neg(hn::Add(q1, hn::Mul(set(sign), sqrt(max(disc, zero())))));
    return pick(hn::Gt(disc, zero()), hn::Add(s, move), s);
  }

  V on_way(V way) const { return min(max(way, zero()), set(p_.way)); }

  /// The way at which the piece comes nearest to the point at s, roughly.
  V nearest(V s) const {
    V way = set(0.5 * p_.way);
    if (p_.way == 0) return way;
    for (int i = 0; i < 2; ++i) {
      const Gap g = gap(s, way);
      way = on_way(hn::Sub(way, hn::Div(g.pull, max(g.bend, set(1e-12)))));
    }
    return way;
  }

  /// On the surface, and there the first or the last point of the section.
  M settled(const Gap& g, V way, double sign) const {
    const V small = set(1e-7 * size_);
    const M first = both(hn::Le(way, zero()), hn::Ge(g.pull, hn::Neg(small)));
    const M last = both(hn::Ge(way, set(p_.way)), hn::Le(g.pull, small));
    const M still = either(hn::Le(abs(g.pull), small), either(first, last));
    return both(both(hn::Le(abs(g.distance), set(1e-12 * size_)), still), hn::Lt(hn::Mul(set(sign), g.along), zero()));
  }

  void step(const Gap& g, M open, V& at, V& way) const {
    const V per_bend = hn::Div(set(1), max(g.bend, set(1e-12)));
    // Free along the way, unless it ends there and the pull is outwards.
    const M stuck = either(both(hn::Le(way, zero()), hn::Ge(g.pull, zero())),
                           both(hn::Ge(way, set(p_.way)), hn::Le(g.pull, zero())));
    const V lean = hn::IfThenZeroElse(stuck, hn::Mul(g.across, per_bend));
    const V slope = hn::Sub(g.along, hn::Mul(lean, g.mixed));
    const V ds = hn::Div(hn::Sub(hn::Mul(lean, g.pull), g.distance), pick(hn::Eq(slope, zero()), set(1e-12), slope));
    const V reach = set(2 * size_);
    const V move = min(max(ds, hn::Neg(reach)), reach);
    const V dt = hn::Neg(hn::Mul(hn::Add(g.pull, hn::Mul(g.mixed, move)), per_bend));
    at = pick(open, hn::Add(at, move), at);
    way = pick(without(open, stuck), on_way(hn::Add(way, dt)), way);
  }

  const SweptShape& p_;
  const SectionRays& r_;
  double size_;
};

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
