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
#include "sweep/pose_hits-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

/// A supporting plane seen along the rays: height over it h0 + h1 s of the ray's point s, and its rate g0 + g1 s.
struct Plane {
  V h0, h1, g0, g1;
};

/// One pose: where the rays meet the body, and a supporting plane for each end. Where a ray misses, both planes are
/// the one between ray and body.
struct Sample {
  double t;
  Stretch hit;
  Plane near, far;
  V from_tip;  ///< distance of the ray's foot from the tip, across the ray
  double tip;  ///< height of the tip
};

class TurningLanes {
 public:
  TurningLanes(TurningPoses& poses, RayWindow& window) : poses_(poses), w_(window) {}

  void cut(double u, Group& g) {
    u_ = u, group_ = &g, emitted_ = false;
    const V origin = set(poses_.origin());
    low_ = hn::Sub(g.near, origin), high_ = hn::Sub(g.far, origin);
    found_ = nothing(), t_near_ = t_far_ = zero();
    const Sample first = sample(0, g.active), last = sample(TurningPoses::kEnd, g.active);
    merge(first, g.active);
    refine(0, 0, TurningPoses::kEnd, first, last, g.active);
    take(both(g.active, hn::Lt(found_.near, found_.far)));
  }

 private:
  Sample sample(std::uint32_t place, M active) {
    PoseFrame spare;
    const PoseFrame& pose = poses_.at(place, spare);
    w_.hits += hn::CountTrue(kD, active);
    const double du = u_ - pose.tip[0], base = pose.tip[2] - poses_.origin();
    const V dv = hn::Sub(group_->v, set(pose.tip[1])), up = set(base);
    PoseHits hits(poses_, pose, du, dv);
    const M hit = hits.find(active, hn::Sub(high_, up));
    Sample s{pose.t, nothing(), {}, {}, sqrt(hn::Add(set(du * du), hn::Mul(dv, dv))), base};
    s.hit = where(hit, {hn::Add(hits.stretch().near, up), hn::Add(hits.stretch().far, up)});
    s.near = plane(hits, pose, hits.near(), up);
    s.far = plane(hits, pose, hits.far(), up);
    const M missed = without(active, hit);
    if (!none(missed)) {
      const Plane between = plane(hits, pose, hits.between(missed), up);
      s.near = choose(hit, s.near, between), s.far = choose(hit, s.far, between);
    }
    return s;
  }

  static Plane choose(M m, const Plane& a, const Plane& b) {
    return {pick(m, a.h0, b.h0), pick(m, a.h1, b.h1), pick(m, a.g0, b.g0), pick(m, a.g1, b.g1)};
  }

  /// The plane with outward normal n that touches the body: valid for any n.
  static Plane plane(const PoseHits& hits, const PoseFrame& pose, const Normal& n, V up) {
    const SectionRays& r = hits.rays();
    Plane p;
    p.h1 = hn::Add(hn::Mul(n.a, set(pose.tilt)), hn::Mul(n.c, set(pose.oz)));
    const V reach = hn::Add(hn::Add(hn::Mul(n.a, r.x), hn::Mul(n.b, r.y)), hn::Mul(n.c, r.z));
    p.h0 = hn::Sub(hn::Sub(reach, hits.support(n)), hn::Mul(p.h1, up));
    // −n · (V + Ω × X) at X = (x + s tilt, y, z + s oz), with Ω across the axis.
    const V turn = hn::Sub(hn::Mul(n.a, set(pose.spin[1])), hn::Mul(n.b, set(pose.spin[0])));
    const V slide = hn::Add(hn::Add(hn::Mul(n.a, set(pose.way[0])), hn::Mul(n.b, set(pose.way[1]))),
                            hn::Mul(n.c, set(pose.way[2])));
    const V cross = hn::Sub(hn::Mul(r.y, set(pose.spin[0])), hn::Mul(r.x, set(pose.spin[1])));
    p.g1 = hn::Sub(hn::Mul(n.c, set(pose.spin[1] * pose.tilt)), hn::Mul(turn, set(pose.oz)));
    p.g0 = hn::Neg(hn::Add(hn::Add(slide, hn::Mul(turn, r.z)), hn::Mul(n.c, cross)));
    p.g0 = hn::Sub(p.g0, hn::Mul(p.g1, up));
    return p;
  }

  /// Joins a hit to what was found where both overlap. Returns the lanes in which they lie apart.
  M merge(const Sample& s, M mask) {
    const M hit = both(mask, hn::Lt(s.hit.near, s.hit.far)), fresh = hn::Gt(found_.near, found_.far);
    const M overlap = both(hn::Le(s.hit.near, found_.far), hn::Ge(s.hit.far, found_.near));
    const M join = both(hit, either(fresh, overlap));
    const M lower = both(join, hn::Lt(s.hit.near, found_.near)), higher = both(join, hn::Gt(s.hit.far, found_.far));
    found_.near = pick(lower, s.hit.near, found_.near), t_near_ = pick(lower, set(s.t), t_near_);
    found_.far = pick(higher, s.hit.far, found_.far), t_far_ = pick(higher, set(s.t), t_far_);
    return without(hit, join);
  }

  void refine(int depth, std::uint32_t from, std::uint32_t to, const Sample& a, const Sample& b, M mask) {
    M apart = merge(b, mask);
    const bool last = depth == poses_.deepest();
    if (!none(apart)) {
      // A new stretch: what was found before is complete if the body was off the ray in between.
      const M done = last ? apart : without(apart, hn::Lt(a.hit.near, a.hit.far));
      if (!none(done)) restart(b, done), apart = without(apart, done);
    }
    if (last) return;
    const M open = without(mask, without(certain(a, b), apart));
    if (none(open)) return;
    const std::uint32_t middle = from + (to - from) / 2;
    const Sample c = sample(middle, open);
    merge(c, open);
    refine(depth + 1, from, middle, a, c, open);
    refine(depth + 1, middle, to, c, b, open);
  }

  void restart(const Sample& s, M mask) {
    take(mask);
    found_.near = pick(mask, s.hit.near, found_.near), found_.far = pick(mask, s.hit.far, found_.far);
    t_near_ = pick(mask, set(s.t), t_near_), t_far_ = pick(mask, set(s.t), t_far_);
    emitted_ = true;
  }

  void take(M mask) {
    if (none(mask)) return;
    const V origin = set(poses_.origin());
    Group& g = *group_;
    if (emitted_) g.near = hn::LoadU(kD, w_.near + g.ray), g.far = hn::LoadU(kD, w_.far + g.ray);
    const Stretch cut{hn::Add(found_.near, origin), hn::Add(found_.far, origin)};
    subtract(w_, g, mask, cut, t_near_, t_far_, [&](V length, V middle, V t) { add(length, middle, t); });
  }

  /// Lanes in which the body surely reaches no material outside of what was found, up to the tolerance, between the
  /// poses of a and b.
  M certain(const Sample& a, const Sample& b) const {
    const V along = set(poses_.along());
    const V near = min(hn::Sub(found_.near, along), high_), far = max(hn::Add(found_.far, along), low_);
    const M found = hn::Lt(found_.near, found_.far);
    const M need_near = hn::Gt(near, low_), need_far = both(found, hn::Lt(far, high_));
    const double span = b.t - a.t;
    M good = either(hn::Not(need_near), beyond(a, a.near, b.near, low_, near, span));
    if (!none(need_far)) good = both(good, either(hn::Not(need_far), beyond(a, a.far, b.far, high_, far, span)));
    return good;
  }

  /// How far a plane may bend away from its tangent in the time 1: |n · ẍ| ≤ |Ω|² |x| + 2 |Ω × V|.
  V bend(const Sample& a, V s, double span) const {
    const V up = abs(hn::Sub(s, set(a.tip)));
    const V high = max(up, a.from_tip), low = min(up, a.from_tip);
    const V distance = hn::Add(high, hn::Mul(low, set(0.4143)));  // ≥ √(high² + low²)
    return hn::Add(hn::Mul(hn::Add(distance, set(poses_.way() * span)), set(poses_.spin2())), set(poses_.coriolis()));
  }

  /// Whether plane p keeps the points s0 and s1, and so all between, out of the body for the time tau from its pose.
  struct Height {
    V h, g, m;
    V after(V tau) const {
      return hn::Sub(hn::Add(h, hn::Mul(g, tau)), hn::Mul(hn::Mul(m, set(0.5)), hn::Mul(tau, tau)));
    }
  };
  static Height height(const Plane& p, V s, V m, bool back) {
    const V g = hn::Add(p.g0, hn::Mul(p.g1, s));
    return {hn::Add(p.h0, hn::Mul(p.h1, s)), back ? hn::Neg(g) : g, m};
  }

  M beyond(const Sample& a, const Plane& p, const Plane& q, V s0, V s1, double span) const {
    const V m0 = bend(a, s0, span), m1 = bend(a, s1, span), whole = set(span), limit = set(-poses_.aside());
    const Height p0 = height(p, s0, m0, false), p1 = height(p, s1, m1, false);
    const Height q0 = height(q, s0, m0, true), q1 = height(q, s1, m1, true);
    const M p_now = hn::Ge(min(p0.h, p1.h), limit), q_now = hn::Ge(min(q0.h, q1.h), limit);
    const M p_all = both(p_now, hn::Ge(min(p0.after(whole), p1.after(whole)), limit));
    const M q_all = both(q_now, hn::Ge(min(q0.after(whole), q1.after(whole)), limit));
    // Both: p up to where their tangents cross at s1, q from there on.
    const V rise = hn::Sub(hn::Add(q1.h, hn::Mul(q1.g, whole)), p1.h), slope = hn::Add(p1.g, q1.g);
    const M level = hn::Eq(slope, zero());
    const V cross = hn::Div(rise, pick(level, set(1), slope));
    const V until = pick(level, set(0.5 * span), min(max(cross, zero()), whole)), rest = hn::Sub(whole, until);
    const M p_part = hn::Ge(min(p0.after(until), p1.after(until)), limit);
    const M q_part = hn::Ge(min(q0.after(rest), q1.after(rest)), limit);
    return either(either(p_all, q_all), both(both(p_now, q_now), both(p_part, q_part)));
  }

  /// (3.20)–(3.22) in one: against the velocity of the tool's material point.
  void add(V length, V middle, V t);

  TurningPoses& poses_;
  RayWindow& w_;
  double u_ = 0;
  Group* group_ = nullptr;
  bool emitted_ = false;
  V low_, high_;  // material, from the origin
  Stretch found_;
  V t_near_, t_far_;
};

inline void TurningLanes::add(V length, V middle, V t) {
  const double* from = poses_.tip_from();
  const double* way = poses_.tip_way();
  const double* spin = poses_.rotation();
  const V p[3] = {set(u_), group_->v, middle};
  V arm[3], direction[3];
  for (int i = 0; i < 3; ++i) arm[i] = hn::Sub(p[i], hn::Add(set(from[i]), hn::Mul(t, set(way[i]))));
  V square = zero();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    direction[i] = hn::Sub(hn::Sub(hn::Mul(set(spin[k]), arm[j]), hn::Mul(set(spin[j]), arm[k])), set(way[i]));
    square = hn::Add(square, hn::Mul(direction[i], direction[i]));
  }
  const M moves = hn::Gt(square, zero());
  const V scale = hn::Div(length, pick(moves, sqrt(square), set(1)));
  for (int i = 0; i < 3; ++i) {
    // Along the axis where that point stands still: it lies on the axis of rotation, which crosses the tip.
    direction[i] = pick(moves, hn::Mul(direction[i], scale), hn::Mul(length, set(poses_.axis()[i])));
    add_to(w_.sums->direction[i], group_->slot, direction[i]);
  }
  V r[3];
  for (int i = 0; i < 3; ++i) r[i] = hn::Sub(p[i], set(w_.pivot[i]));
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    add_to(w_.sums->moment[i], group_->slot,
           hn::Sub(hn::Mul(r[j], direction[k]), hn::Mul(r[k], direction[j])));
  }
}

inline void cut_turning_lanes(TurningPoses& poses, RayWindow& window) {
  TurningLanes lanes(poses, window);
  for_groups(window, [&](double u, Group& g) { lanes.cut(u, g); });
}

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
