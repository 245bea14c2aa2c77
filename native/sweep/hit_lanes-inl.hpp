// Where rays meet a convex group of pieces at poses of its motion, a pose of its own for every lane.
#if defined(RIFFLER_SWEEP_HIT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_HIT_LANES_INL_HPP
#undef RIFFLER_SWEEP_HIT_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_HIT_LANES_INL_HPP
#endif

#include "sweep/pose_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

class HitLanes : private AxisView {
 public:
  using AxisView::AxisView;

  /// What the group covers of the rays; `active` lanes only. A far end above `high` need not be exact.
  Stretch find(M active, V high) {
    out_ = nothing();
    for (std::size_t k = b_.count; k-- > 0;) {  // the upper pieces are simple and often make `far` known
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
  static constexpr double kArrived = 1e-13;  // of the size: where Newton's method has arrived

  void add(M hit, Stretch s) {
    out_.near = min(out_.near, pick(hit, s.near, set(kInfinity)));
    out_.far = max(out_.far, pick(hit, s.far, set(-kInfinity)));
  }

  /// {s : (q2) s² + 2 q1 s + q0 ≤ 0} on the nappe whose radius is positive; `grow`: how it widens along the ray.
  static Stretch inside(V q2, V q1, V q0, V grow, bool cone) {
    const V disc = hn::Sub(hn::Mul(q1, q1), hn::Mul(q2, q0));
    const V q = hn::Neg(hn::Add(q1, with_sign(sqrt(max(disc, zero())), q1)));
    const M flat = hn::Eq(q, zero()), straight = hn::Eq(q2, zero());
    const V b = hn::Div(q0, pick(flat, set(1), q));
    const V a = pick(straight, with_sign(set(kInfinity), q), hn::Div(q, pick(straight, set(1), q2)));
    const V other = pick(flat, pick(straight, with_sign(set(kInfinity), hn::Neg(q0)), zero()), b);
    // Along the axis of a cylinder: all or nothing.
    const M whole = both(flat, straight);
    const V low = pick(whole, pick(hn::Le(q0, zero()), set(-kInfinity), set(kInfinity)), min(a, other));
    const V high = pick(whole, pick(hn::Le(q0, zero()), set(kInfinity), set(-kInfinity)), max(a, other));
    Stretch out = where(either(whole, hn::Ge(disc, zero())), {low, high});
    if (!cone) return out;
    const M open = hn::Lt(q2, zero()), up = hn::Gt(grow, zero());
    // Steeper than the flank, a ray stays inside of one nappe beyond a root.
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
    const Stretch round = inside(q2, q1, hn::Sub(c_, hn::Mul(radius, radius)), grow, s.slope != 0);
    const Stretch at = common(round, slab(s.z0, s.z1));
    add(both(hn::Lt(at.near, at.far), both(hn::Gt(at.near, set(-kInfinity)), hn::Lt(at.far, set(kInfinity)))), at);
  }

  void ball(const PieceShape& s) {
    const V3 c = less(w_, set(s.zc), o_);
    const V square = hn::Add(hn::Mul(c.x, c.x), hn::Mul(c.y, c.y)), disc = hn::Sub(set(s.r * s.r), square);
    const V root = sqrt(max(disc, zero()));
    add(hn::Gt(disc, zero()), {hn::Neg(hn::Add(c.z, root)), hn::Sub(root, c.z)});
  }

  /// The squared distance from the disc is convex along the ray, so Newton's method from outside walks to the root
  /// without passing it. Starts where the ray enters the cylinder and slab about the piece. `sign` 1: near end, −1: far
  /// end.
  M walk(const PieceShape& s, M mask, double sign, V& at, V until) const {
    M hit = no_lane(), open = mask;
    const double size = std::abs(s.e) + s.r;
    const V arrives = set(kArrived * size * s.r);
    for (int i = 0; i < kMostSteps && !none(open); ++i) {
      const V3 r = radial(at);
      const V z = hn::Sub(z_at(at), set(s.zc)), rho = max(sqrt(dot(r, r)), set(1e-150));
      const V out = max(hn::Sub(rho, set(s.e)), zero());
      const V over = hn::Sub(hn::Add(hn::Mul(out, out), hn::Mul(z, z)), set(s.r * s.r));
      const V slope = hn::Add(hn::Div(hn::Mul(out, r.z), rho), hn::Mul(z, o_.z));  // half the derivative
      const M arrived = both(open, hn::Le(over, arrives));
      hit = either(hit, arrived);
      open = both(without(open, arrived), hn::Lt(hn::Mul(slope, set(sign)), zero()));
      at = pick(open, hn::Sub(at, hn::Div(hn::Mul(set(0.5), over), pick(open, slope, set(1)))), at);
      open = both(open, hn::Le(hn::Mul(set(sign), hn::Sub(at, until)), zero()));
    }
    return hit;
  }

  void round(const PieceShape& s, M active, V high) {
    const Stretch box = box_of(s);
    M mask = both(active, hn::Le(box.near, box.far));
    // What the pieces above cover already need not be found.
    mask = without(mask, both(hn::Le(out_.near, box.near), hn::Ge(out_.far, box.far)));
    if (none(mask)) return;
    Stretch at = box;
    const M hit = walk(s, mask, 1, at.near, box.far);
    if (none(hit)) return;
    const M rest = both(hit, hn::Lt(out_.far, min(high, box.far)));
    at.far = pick(rest, box.far, at.near);
    if (!none(rest)) at.far = pick(walk(s, rest, -1, at.far, at.near), at.far, at.near);
    add(hit, at);
  }

  /// The ray inside of the slab and the cylinder about a Round.
  Stretch box_of(const PieceShape& s) const {
    const double most = s.e + s.r;
    const Stretch side = inside(a_, b1_, hn::Sub(c_, set(most * most)), zero(), false);
    return common(side, slab(std::max(s.z0, s.zc - s.r), std::min(s.z1, s.zc + s.r)));
  }

  Stretch out_;
};

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
