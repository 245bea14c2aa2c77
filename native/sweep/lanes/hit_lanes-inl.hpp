// Intersects rays with a convex group of pieces, each lane at its own pose of the motion.
#if defined(RIFFLER_SWEEP_HIT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_HIT_LANES_INL_HPP
#undef RIFFLER_SWEEP_HIT_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_HIT_LANES_INL_HPP
#endif

#include "sweep/lanes/pose_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

class HitLanes : private AxisView {
 public:
  using AxisView::AxisView;

  /// The interval of each ray inside the group, in `active` lanes. A far end above `high` need not be exact.
  RayIntervals find(M active, V high) {
    out_ = nothing();
    for (std::size_t k = b_.count; k-- > 0;) {  // upper pieces are simple and often determine `far`
      const PieceShape& s = b_.pieces[k];
      if (!s.round)
        frustum(s);
      else if (s.ball)
        ball(s);
      else
        round(s, active, high);
    }
    return where(both(active, hn::Lt(out_.near, out_.far)), out_);
  }

 private:
  void add(M hit, RayIntervals s) {
    out_.near = min(out_.near, pick(hit, s.near, set(kInfinity)));
    out_.far = max(out_.far, pick(hit, s.far, set(-kInfinity)));
  }

  /// {s : (q2) s² + 2 q1 s + q0 ≤ 0} on the nappe with positive radius; `grow`: rate of the radius along the ray.
  static RayIntervals inside(V q2, V q1, V q0, V grow, bool cone) {
    const V disc = hn::Sub(hn::Mul(q1, q1), hn::Mul(q2, q0));
    const V q = hn::Neg(hn::Add(q1, with_sign(sqrt(max(disc, zero())), q1)));
    const M flat = hn::Eq(q, zero()), straight = hn::Eq(q2, zero());
    const V b = hn::Div(q0, pick(flat, set(1), q));
    const V a = pick(straight, with_sign(set(kInfinity), q), hn::Div(q, pick(straight, set(1), q2)));
    const V other = pick(flat, pick(straight, with_sign(set(kInfinity), hn::Neg(q0)), zero()), b);
    // A ray along the axis of a cylinder is inside entirely or not at all.
    const M whole = both(flat, straight);
    const V low = pick(whole, pick(hn::Le(q0, zero()), set(-kInfinity), set(kInfinity)), min(a, other));
    const V high = pick(whole, pick(hn::Le(q0, zero()), set(kInfinity), set(-kInfinity)), max(a, other));
    RayIntervals out = where(either(whole, hn::Ge(disc, zero())), {low, high});
    if (!cone) return out;
    const M open = hn::Lt(q2, zero()), up = hn::Gt(grow, zero());
    // A ray steeper than the flank stays inside one nappe beyond a root.
    out.near = pick(open, pick(up, high, set(-kInfinity)), out.near);
    out.far = pick(open, pick(up, set(kInfinity), low), out.far);
    return out;
  }

  void frustum(const PieceShape& s) {
    V radius = set(s.r0), q1 = b1_, q2 = a_, grow = zero();
    if (s.slope != 0) {
      grow = hn::Mul(set(s.slope), o_.z);
      radius = hn::Add(radius, hn::Mul(set(s.slope), hn::Sub(z_, set(s.z0))));
      q1 = hn::Sub(q1, hn::Mul(radius, grow)), q2 = hn::Sub(q2, hn::Mul(grow, grow));
    }
    const RayIntervals round = inside(q2, q1, hn::Sub(c_, hn::Mul(radius, radius)), grow, s.slope != 0);
    const RayIntervals at = common(round, slab(s.z0, s.z1));
    add(both(hn::Lt(at.near, at.far), both(hn::Gt(at.near, set(-kInfinity)), hn::Lt(at.far, set(kInfinity)))), at);
  }

  void ball(const PieceShape& s) {
    const V3 c = less(w_, set(s.zc), o_);
    const V square = hn::Add(hn::Mul(c.x, c.x), hn::Mul(c.y, c.y)), disc = hn::Sub(set(s.r * s.r), square);
    const V root = sqrt(max(disc, zero()));
    add(hn::Gt(disc, zero()), {hn::Neg(hn::Add(c.z, root)), hn::Sub(root, c.z)});
  }

  /// Moves `at` from where a ray enters the cylinder and slab around a Round to where it enters the Round (`sign` 1)
  /// or, traversed from the other side, to where it leaves it (−1), but not beyond `until`. Returns the lanes that hit
  /// the Round.
  ///
  /// A Round is the union of all balls centred on its disc. The ray first meets the ball whose centre is nearest to the
  /// entry point. So each step goes to the ball whose centre is nearest to the end of the last step; that ball is
  /// inside the Round, and the iteration converges like Newton's method. If the ray misses that ball, the step is one
  /// of Newton's on the squared distance from the disc, which is convex, so the step does not pass the Round.
  M walk(const PieceShape& s, M mask, double sign, V& at, V until) const {
    M open = mask, hit = no_lane();
    const double size = std::abs(s.e) + s.r;
    const V slack = set(1e-13 * size * s.r);
    for (int i = 0; i < kMaxSteps && !none(open); ++i) {
      const V grow = hn::Add(hn::Mul(a_, at), b1_), z = hn::Sub(z_at(at), set(s.zc));
      const V square = hn::Add(hn::Mul(at, hn::Add(grow, b1_)), c_);
      const V rho = max(sqrt(max(square, zero())), set(1e-150)), out = max(hn::Sub(rho, set(s.e)), zero());
      const V over = hn::Sub(hn::Add(hn::Mul(out, out), hn::Mul(z, z)), set(s.r * s.r));
      const M inside = both(open, hn::Le(over, slack));
      // half the rate of the squared distance, times ρ
      const V rate = hn::Add(hn::Mul(out, grow), hn::Mul(hn::Mul(z, o_.z), rho)), coming = hn::Mul(rate, set(-sign));
      const V disc = hn::Sub(hn::Mul(rate, rate), hn::Mul(over, hn::Mul(rho, rho)));
      const M meets = hn::Ge(disc, zero());
      const V root = pick(meets, sqrt(max(disc, zero())), coming), sum = hn::Add(coming, root);
      const V step = hn::Div(hn::Mul(over, rho), pick(hn::Gt(sum, zero()), sum, set(1)));
      hit = either(hit, inside);
      if (i == 0) open = without(open, inside);  // through the slab's end
      open = both(open, hn::Gt(sum, zero()));
      at = pick(open, hn::Add(at, hn::Mul(set(sign), step)), at);
      // The error after a step is proportional to the square of its length.
      const M arrived = both(open, both(either(meets, inside), hn::Le(abs(step), set(1e-7 * s.r))));
      hit = either(hit, arrived);
      open =
          without(open, either(arrived, both(hn::Not(meets), hn::Gt(hn::Mul(set(sign), hn::Sub(at, until)), zero()))));
    }
    return both(hit, hn::Le(hn::Mul(set(sign), hn::Sub(at, until)), zero()));
  }

  void round(const PieceShape& s, M active, V high) {
    const RayIntervals box = box_of(s);
    M mask = both(active, hn::Le(box.near, box.far));
    // Intervals that the pieces above already cover are not needed.
    mask = without(mask, both(hn::Le(out_.near, box.near), hn::Ge(out_.far, box.far)));
    if (none(mask)) return;
    RayIntervals at = box;
    const M hit = walk(s, mask, 1, at.near, box.far);
    if (none(hit)) return;
    const M rest = both(hit, hn::Lt(out_.far, min(high, box.far)));
    at.far = pick(rest, box.far, at.near);
    if (!none(rest)) at.far = pick(walk(s, rest, -1, at.far, at.near), at.far, at.near);
    add(hit, at);
  }

  /// The part of the ray inside the slab and cylinder around a Round.
  RayIntervals box_of(const PieceShape& s) const {
    const double most = s.e + s.r;
    const RayIntervals side = inside(a_, b1_, hn::Sub(c_, set(most * most)), zero(), false);
    return common(side, slab(std::max(s.z0, s.zc - s.r), std::min(s.z1, s.zc + s.r)));
  }

  RayIntervals out_;
};

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
