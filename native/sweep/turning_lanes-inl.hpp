// What a turning part takes from a ray, for many rays at a time. docs/methods.md, "Carving", has the proof.
//
// A convex body lies behind each of its supporting planes at every pose, for the plane moves with it. Hits at exact
// poses say what the body surely takes; planes at the same poses say what it surely does not reach between them. Where
// both agree up to the tolerance, a ray is done; where they do not, the time between two poses is halved for that ray.
#if defined(RIFFLER_SWEEP_TURNING_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_TURNING_LANES_INL_HPP
#undef RIFFLER_SWEEP_TURNING_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_TURNING_LANES_INL_HPP
#endif

#include "sweep/cut_lanes-inl.hpp"
#include "sweep/pose_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

/// A supporting plane seen along the rays: height over it of the ray's point s, h0 + h1 s, and how that changes, its
/// rate g0 + g1 s and acceleration k0 + k1 s.
struct Plane {
  V h0, h1, g0, g1, k0, k1;
};

HWY_INLINE Plane choose(M m, const Plane& a, const Plane& b) {
  return {pick(m, a.h0, b.h0), pick(m, a.h1, b.h1), pick(m, a.g0, b.g0),
          pick(m, a.g1, b.g1), pick(m, a.k0, b.k0), pick(m, a.k1, b.k1)};
}

/// One pose a lane: where the rays meet the body, and a supporting plane for each end. Where a ray misses, both planes
/// are the one between ray and body.
struct Sample {
  V t;
  Stretch hit;
  Plane near, far;
  V across, tip;  ///< distance of the ray's foot from the tip, across the ray; height of the tip
};

class TurningLanes {
 public:
  TurningLanes(const TurningBody& body, RayWindow& window) : b_(body), w_(window) {}

  void cut(double u, Group& g) {
    u_ = u, group_ = &g, emitted_ = false;
    const V origin = set(b_.origin);
    low_ = hn::Sub(g.near, origin), high_ = hn::Sub(g.far, origin);
    found_ = nothing(), t_near_ = t_far_ = zero();
    const Sample first = sample(set(b_.t0), g.active);
    merge(first, g.active);
    // Behind the tool, what the last move left is where this one begins: one plane tells that it moves away.
    const M open = without(g.active, certain_alone(first));
    if (!none(open)) refine(0, first, sample(set(b_.t1), open), open);
    take(both(g.active, hn::Lt(found_.near, found_.far)));
  }

 private:
  Sample sample(V t, M active) {
    w_.hits += hn::CountTrue(kD, active);
    PoseLanes pose(b_, set(u_), group_->v, t);
    const M hit = pose.find(active, high_);
    const V3& w = pose.from_tip();
    Sample s;
    s.t = t, s.tip = hn::Neg(w.z), s.across = sqrt(hn::Add(hn::Mul(w.x, w.x), hn::Mul(w.y, w.y)));
    s.hit = where(hit, pose.stretch());
    s.near = plane(w, pose.near(hit));
    s.near.h0 = hn::Neg(hn::Mul(s.near.h1, s.hit.near));
    s.far = s.near;
    // Ends above the material need no plane.
    const M inside = both(hit, hn::Lt(s.hit.far, high_));
    if (!none(inside)) {
      s.far = plane(w, pose.far(inside));
      s.far.h0 = hn::Neg(hn::Mul(s.far.h1, s.hit.far));
    }
    const M missed = without(active, hit);
    if (!none(missed)) {
      V height = zero();
      Plane between = plane(w, pose.between(missed, height));
      between.h0 = height;
      s.near = choose(hit, s.near, between), s.far = choose(hit, s.far, between);
    }
    return s;
  }

  /// The plane with outward normal n, but for its height. With X from the tip to the ray's point, ẋ = −(V + Ω × X) and
  /// ẍ = Ω × (Ω × X) + 2 Ω × V in the tool's frame.
  Plane plane(const V3& w, const V3& n) const {
    const V3 m = cross(n, b_.spin), c = cross(m, b_.spin);
    const V drift = dot(m, b_.way);
    return {zero(),
            n.z,
            hn::Neg(hn::Add(dot(n, b_.way), dot(m, w))),
            hn::Neg(m.z),
            hn::Add(dot(c, w), hn::Add(drift, drift)),
            c.z};
  }

  /// Joins a hit to what was found where both overlap. Returns the lanes in which they lie apart.
  M merge(const Sample& s, M mask) {
    const M hit = both(mask, hn::Lt(s.hit.near, s.hit.far)), fresh = hn::Gt(found_.near, found_.far);
    const M overlap = both(hn::Le(s.hit.near, found_.far), hn::Ge(s.hit.far, found_.near));
    const M join = both(hit, either(fresh, overlap));
    const M lower = both(join, hn::Lt(s.hit.near, found_.near)), higher = both(join, hn::Gt(s.hit.far, found_.far));
    found_.near = pick(lower, s.hit.near, found_.near), t_near_ = pick(lower, s.t, t_near_);
    found_.far = pick(higher, s.hit.far, found_.far), t_far_ = pick(higher, s.t, t_far_);
    return without(hit, join);
  }

  /// Makes sure of the lanes of `mask` between the poses of a, which is merged already, and b.
  void refine(int depth, const Sample& a, const Sample& b, M mask) {
    M apart = merge(b, mask);
    const bool last = depth >= b_.deepest + kGuided;
    if (!none(apart)) {
      // A new stretch: what was found before is complete if the body was off the ray in between.
      const M done = last ? apart : without(apart, hn::Lt(a.hit.near, a.hit.far));
      if (!none(done)) restart(b, done), apart = without(apart, done);
    }
    if (last) return;
    const V span = hn::Sub(b.t, a.t);
    V split = hn::Mul(set(0.5), span);
    const M open = without(mask, without(certain(a, b, span, split), apart));
    if (none(open)) return;
    // First where the planes say that the end is; later in the middle, which surely comes to an end.
    if (depth >= kGuided) split = hn::Mul(set(0.5), span);
    const Sample c = sample(hn::Add(a.t, split), open);
    merge(c, open);
    refine(depth + 1, a, c, open);
    refine(depth + 1, c, b, open);
  }

  void restart(const Sample& s, M mask) {
    take(mask);
    found_.near = pick(mask, s.hit.near, found_.near), found_.far = pick(mask, s.hit.far, found_.far);
    t_near_ = pick(mask, s.t, t_near_), t_far_ = pick(mask, s.t, t_far_);
    emitted_ = true;
  }

  void take(M mask) {
    if (none(mask)) return;
    const V origin = set(b_.origin);
    Group& g = *group_;
    if (emitted_) g.near = hn::LoadU(kD, w_.near + g.ray), g.far = hn::LoadU(kD, w_.far + g.ray);
    const Stretch cut{hn::Add(found_.near, origin), hn::Add(found_.far, origin)};
    subtract(w_, u_, g, mask, cut, t_near_, t_far_);
  }

  /// Lanes in which the first pose's planes alone keep the body from all material outside of what was found.
  M certain_alone(const Sample& a) const {
    const V along = set(b_.along), span = set(b_.t1 - b_.t0);
    const auto keeps = [&](const Plane& p, V s0, V s1) {
      const Height at0 = height(p, s0, third(a, s0, span), false), at1 = height(p, s1, third(a, s1, span), false);
      const V least = min(min(at0.h, at1.h), min(at0.after(span), at1.after(span)));
      return hn::Ge(least, set(-b_.aside));
    };
    const M good =
        either(hn::Le(found_.near, low_), keeps(a.near, low_, max(min(hn::Sub(found_.near, along), high_), low_)));
    const M need_far = both(hn::Lt(found_.near, found_.far), hn::Lt(found_.far, high_));
    if (none(need_far)) return good;
    return both(good,
                either(hn::Not(need_far), keeps(a.far, high_, min(max(hn::Add(found_.far, along), low_), high_))));
  }

  /// Lanes in which the body surely reaches no material outside of what was found, up to the tolerance, between the
  /// poses of a and b. `split`: for the others, the time after a to look at next.
  M certain(const Sample& a, const Sample& b, V span, V& split) const {
    const V along = set(b_.along);
    const V near = max(min(hn::Sub(found_.near, along), high_), low_);
    const V far = min(max(hn::Add(found_.far, along), low_), high_);
    const M need_near = hn::Gt(found_.near, low_);
    const M need_far = both(hn::Lt(found_.near, found_.far), hn::Lt(found_.far, high_));
    V until;
    const M near_good = either(hn::Not(need_near), beyond(a, a.near, b.near, low_, near, span, until));
    split = pick(near_good, split, until);
    if (none(need_far)) return near_good;
    const M far_good = either(hn::Not(need_far), beyond(a, a.far, b.far, high_, far, span, until));
    split = pick(both(near_good, hn::Not(far_good)), until, split);
    return both(near_good, far_good);
  }

  /// |n · x‴| ≤ |Ω|³ |X| + 3 |Ω|² |V| at the ray's point s, for all t between the samples.
  V third(const Sample& a, V s, V span) const {
    const V up = abs(hn::Sub(s, a.tip));
    const V high = max(up, a.across), low = min(up, a.across);
    const V distance = hn::Add(hn::Add(high, hn::Mul(low, set(0.4143))), hn::Mul(set(b_.speed), span));  // ≥ |X|
    return hn::Add(hn::Mul(distance, set(b_.pull)), set(b_.drift));
  }

  /// Height of one point over a plane, and a concave bound of it from below after the time tau.
  struct Height {
    V h, g, k, m;
    V after(V tau) const {
      const V bent = hn::Sub(hn::Mul(k, set(0.5)), hn::Mul(hn::Mul(m, set(1.0 / 6)), tau));
      return hn::Add(h, hn::Mul(tau, hn::Add(g, hn::Mul(tau, bent))));
    }
  };
  static Height height(const Plane& p, V s, V m, bool back) {
    const V g = hn::Add(p.g0, hn::Mul(p.g1, s));
    return {hn::Add(p.h0, hn::Mul(p.h1, s)), back ? hn::Neg(g) : g, min(hn::Add(p.k0, hn::Mul(p.k1, s)), zero()), m};
  }

  /// Whether the planes p of sample a and q of the one after it keep the points s0 and s1 of the rays, and so all
  /// between, out of the body for the time between. `until`: where the tangents of both at s1 cross.
  M beyond(const Sample& a, const Plane& p, const Plane& q, V s0, V s1, V span, V& until) const {
    const V m0 = third(a, s0, span), m1 = third(a, s1, span), limit = set(-b_.aside);
    const Height p0 = height(p, s0, m0, false), p1 = height(p, s1, m1, false);
    const Height q0 = height(q, s0, m0, true), q1 = height(q, s1, m1, true);
    const M p_now = hn::Ge(min(p0.h, p1.h), limit), q_now = hn::Ge(min(q0.h, q1.h), limit);
    const M p_all = both(p_now, hn::Ge(min(p0.after(span), p1.after(span)), limit));
    const M q_all = both(q_now, hn::Ge(min(q0.after(span), q1.after(span)), limit));
    // Both: p up to where their tangents cross, q from there on.
    const V rise = hn::Sub(hn::Add(q1.h, hn::Mul(q1.g, span)), p1.h), slope = hn::Add(p1.g, q1.g);
    const M level = hn::Eq(slope, zero());
    const V crossing = pick(level, hn::Mul(set(0.5), span), hn::Div(rise, pick(level, set(1), slope)));
    until = min(max(crossing, hn::Mul(set(0.03), span)), hn::Mul(set(0.97), span));
    const V rest = hn::Sub(span, until);
    const M p_part = hn::Ge(min(p0.after(until), p1.after(until)), limit);
    const M q_part = hn::Ge(min(q0.after(rest), q1.after(rest)), limit);
    return either(either(p_all, q_all), both(both(p_now, q_now), both(p_part, q_part)));
  }

  static constexpr int kGuided = 8;
  const TurningBody& b_;
  RayWindow& w_;
  double u_ = 0;
  Group* group_ = nullptr;
  bool emitted_ = false;
  V low_, high_;  // material, from the origin
  Stretch found_;
  V t_near_, t_far_;
};

inline void cut_turning_lanes(const TurningBody& body, RayWindow& window) {
  TurningLanes lanes(body, window);
  for_groups(window, [&](double u, Group& g) { lanes.cut(u, g); });
}

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
