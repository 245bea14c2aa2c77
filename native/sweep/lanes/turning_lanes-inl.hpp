// Cuts the rays of a tile with a turning part, many rays at a time. docs/methods.md, "Carving", has the proof.
//
// At every pose a convex body lies behind each of its supporting planes, because the plane moves with it. Hits at exact
// poses show what the body certainly removes; planes at the same poses show what it certainly does not reach between
// them. A ray is finished when both agree within the tolerance; otherwise the time between two poses is halved for that
// ray. Most rays need only one plane or one pose. The others are queued, so that no lane waits for another.
#if defined(RIFFLER_SWEEP_TURNING_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_TURNING_LANES_INL_HPP
#undef RIFFLER_SWEEP_TURNING_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_TURNING_LANES_INL_HPP
#endif

#include <algorithm>

#include "riffler/base/block_pool.hpp"
#include "sweep/lanes/certificate_lanes-inl.hpp"
#include "sweep/lanes/cut_lanes-inl.hpp"
#include "sweep/lanes/hit_lanes-inl.hpp"
#include "sweep/lanes/lane_queue-inl.hpp"
#include "sweep/lanes/packed_rays-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// One ray per lane.
struct Ray {
  V place;  // index in the tile
  V u, v;
  V low, high;       // its material, heights from the body's origin
  RayIntervals gap;  // in the material; near > far if there is none
  V direction;       // of time: 1, or −1 if traversed from the end
};

/// The interval found so far, and the times of its ends.
struct Found {
  RayIntervals at;
  V t_near, t_far;
};

/// A ray that one pose has not settled.
struct Open {
  Ray ray;
  Found found;
  Sample first;  // at that pose
};

template <class F>
HWY_INLINE void each(RayIntervals& s, const F& f) {
  f(s.near), f(s.far);
}
template <class F>
HWY_INLINE void each(Plane& p, const F& f) {
  f(p.h0), f(p.h1), f(p.g0), f(p.g1), f(p.k0), f(p.k1);
}
template <class F>
HWY_INLINE void each(Sample& s, const F& f) {
  f(s.t), each(s.hit, f), each(s.below, f), each(s.above, f), f(s.depth);
}
template <class F>
HWY_INLINE void each(Ray& r, const F& f) {
  f(r.place), f(r.u), f(r.v), f(r.low), f(r.high), each(r.gap, f), f(r.direction);
}
template <class F>
HWY_INLINE void each(Open& o, const F& f) {
  each(o.ray, f), each(o.found.at, f), f(o.found.t_near), f(o.found.t_far), each(o.first, f);
}

class TurningLanes {
 public:
  TurningLanes(const TurningBody& body, RayWindow& window) : b_(body), w_(window), certificate_(body, window) {}

  void cut() {
    const PackedRays rays(w_);
    const V origin = set(b_.origin);
    for (int k = 0; k < rays.count(); k += lanes()) {
      const RayIntervals gap = rays.gap(k);
      Ray ray{rays.place(k),
              rays.u(k),
              rays.v(k),
              hn::Sub(rays.low(k), origin),
              hn::Sub(rays.high(k), origin),
              {hn::Sub(gap.near, origin), hn::Sub(gap.far, origin)},
              set(1)};
      look(ray, rays.present(k));
    }
    while (reached_.count() > 0) settle();
    refine();
    take();
  }

 private:
  /// Rejects most rays without a hit: those behind the tool, where the last move's cut ends where this one begins, and
  /// those next to or below it.
  void look(Ray& ray, M active) {
    const V3 axis{set(b_.start.axis[0]), set(b_.start.axis[1]), set(b_.start.axis[2])};
    const V3 from_tip{hn::Sub(ray.u, set(b_.start.tip[0])), hn::Sub(ray.v, set(b_.start.tip[1])),
                      set(-b_.start.tip[2])};
    const Pose pose{axis, from_tip};
    const Kept all{ray.high, ray.low, ray.direction};
    const Plane p = certificate_.towards(pose, all);
    const M open = without(active, certificate_.stays_away(p, all));
    if (none(open)) return;
    // For an approaching tool it is best to start at the end of its path.
    ray.direction = pick(hn::Lt(hn::Add(p.g0, hn::Mul(p.g1, ray.high)), zero()), set(-1), set(1));
    // The rays added last may not have reached memory yet.
    if (reached_.count() >= lanes()) settle();
    reached_.add(open, ray);
  }

  /// Evaluates the pose at one end of the part. If the tool only moves away from there, or arrives there, this settles
  /// the ray.
  void settle() {
    Ray ray{};
    const M active = reached_.take(hn::FirstN(kD, lanes()), ray);
    const V t = pick(hn::Lt(ray.direction, zero()), set(b_.t1), set(b_.t0));
    const Pose pose = pose_at(b_, ray.u, ray.v, t);
    Open open{ray, {nothing(), zero(), zero()}, {}};
    Sample& s = open.first;
    s.t = t, s.hit = hits(ray, pose, active), s.depth = zero();
    merge(open.found, t, s.hit, active);
    set_planes(s, pose, open, active);
    const M rest = without(active, certain(open));
    finish(open.ray, open.found, without(active, rest));
    open_.add(rest, open);
    if (open_.full()) refine();
  }

  /// Halves the time for the open rays, each at its own pace.
  void refine() {
    Open now{};
    Sample last{}, next{};  // others wait on the stack
    M busy = no_lane();
    V split = zero();
    for (;;) {
      const M fresh = open_.take(hn::Not(busy), now);
      busy = either(busy, fresh);
      if (none(busy)) return;
      const V end = pick(hn::Lt(now.ray.direction, zero()), set(b_.t0), set(b_.t1));
      const V t = pick(fresh, end, hn::Add(last.t, hn::Mul(now.ray.direction, split)));
      next.depth = hn::Add(next.depth, set(1));  // both halves are one level deeper
      pending_.push(without(busy, fresh), next);
      const Pose pose = pose_at(b_, now.ray.u, now.ray.v, t);
      next.t = t, next.hit = hits(now.ray, pose, busy), next.depth = pick(fresh, zero(), next.depth);
      merge(now.found, t, next.hit, busy);
      set_planes(next, pose, now, busy);
      last = choose(fresh, now.first, last);
      // Advance to the first pose after which the ray is still open.
      for (M good = advance(now, last, next, busy, split); !none(good); good = advance(now, last, next, good, split)) {
        last = choose(good, next, last);
        const M done = both(good, pending_.empty());
        finish(now.ray, now.found, done), busy = without(busy, done), good = without(good, done);
        if (none(good)) break;
        pending_.pop(good, next);
      }
    }
  }

  /// Lanes that are settled from the last sample to the next. `split`: for the other lanes, the time after the last
  /// sample at which to evaluate the next pose.
  M advance(Open& now, const Sample& last, const Sample& next, M mask, V& split) {
    M apart = merge(now.found, next.t, next.hit, mask);
    const V span = abs(hn::Sub(next.t, last.t)), half = hn::Mul(set(0.5), span);
    const M deepest = both(mask, hn::Ge(next.depth, set(b_.deepest + kGuided)));
    if (!none(apart)) {
      // A separate interval: the previous one is complete if the body was off the ray in between.
      const M done = both(apart, either(deepest, hn::Ge(last.hit.near, last.hit.far)));
      if (!none(done)) restart(now, next, done), apart = without(apart, done);
    }
    V guess = half;
    const M good = both(mask, either(deepest, without(certain(now, last, next, span, guess), apart)));
    // First split where the planes place the end; later in the middle, which is sure to terminate.
    split = pick(without(mask, good), pick(hn::Ge(next.depth, set(kGuided)), half, guess), split);
    return good;
  }

  RayIntervals hits(const Ray& ray, const Pose& pose, M active) {
    w_.hits += hn::CountTrue(kD, active);
    return HitLanes(b_, pose).find(active, ray.high);
  }

  void set_planes(Sample& s, const Pose& pose, const Open& o, M mask) const {
    const M missed = both(mask, hn::Ge(s.hit.near, s.hit.far));
    s.below = s.above = certificate_.between(pose, below(o), missed);
    const M high = both(mask, has_above(o));
    if (!none(high)) s.above = choose(high, certificate_.between(pose, above(o), missed), s.below);
  }

  /// Merges a hit into the interval found so far. Returns the lanes in which the two are farther apart than the
  /// tolerance of an end. (If a tool moving along the ray only grazes it, hits may be shorter than the steps between
  /// them.)
  M merge(Found& found, V t, RayIntervals s, M mask) const {
    const M hit = both(mask, hn::Lt(s.near, s.far)), fresh = hn::Gt(found.at.near, found.at.far);
    const V gap = max(hn::Sub(s.near, found.at.far), hn::Sub(found.at.near, s.far));
    const M overlap = hn::Le(gap, set(b_.along));
    const M join = both(hit, either(fresh, overlap));
    const M lower = both(join, hn::Lt(s.near, found.at.near)), higher = both(join, hn::Gt(s.far, found.at.far));
    found.at.near = pick(lower, s.near, found.at.near), found.t_near = pick(lower, t, found.t_near);
    found.at.far = pick(higher, s.far, found.at.far), found.t_far = pick(higher, t, found.t_far);
    return without(hit, join);
  }

  /// The material below and above the interval found, minus the tolerance of an end. An end in a gap need not be exact:
  /// only the material beyond the gap is kept. (An end a little outside of the gap would leave a sliver at its border.)
  Kept below(const Open& o) const {
    const Ray& ray = o.ray;
    const V end = o.found.at.near, exact = hn::Sub(end, set(b_.along));
    const V at = pick(hn::Le(end, ray.gap.far), min(exact, ray.gap.near), exact);
    return {max(min(at, ray.high), ray.low), ray.low, ray.direction};
  }
  Kept above(const Open& o) const {
    const Ray& ray = o.ray;
    const V end = o.found.at.far, exact = hn::Add(end, set(b_.along));
    const V at = pick(hn::Ge(end, ray.gap.near), max(exact, ray.gap.far), exact);
    return {min(max(at, ray.low), ray.high), ray.high, ray.direction};
  }
  static M has_below(const Open& o) { return hn::Gt(o.found.at.near, o.ray.low); }
  static M has_above(const Open& o) {
    return both(hn::Lt(o.found.at.near, o.found.at.far), hn::Lt(o.found.at.far, o.ray.high));
  }

  /// Lanes in which the planes at the first pose alone keep the body away from all material outside the interval found.
  M certain(const Open& o) const {
    const M good = either(hn::Not(has_below(o)), certificate_.stays_away(o.first.below, below(o))), more = has_above(o);
    if (none(more)) return good;
    return both(good, either(hn::Not(more), certificate_.stays_away(o.first.above, above(o))));
  }

  /// Lanes in which the body certainly reaches no material outside the interval found, up to the tolerance, during the
  /// time `span` from a to b. `split`: for the other lanes, the time after a at which to evaluate the next pose.
  M certain(const Open& o, const Sample& a, const Sample& b, V span, V& split) const {
    V until;
    const M low_good = either(hn::Not(has_below(o)), certificate_.stays_away(a.below, b.below, below(o), span, until));
    split = pick(low_good, split, until);
    const M high = has_above(o);
    if (none(high)) return low_good;
    const M high_good = either(hn::Not(high), certificate_.stays_away(a.above, b.above, above(o), span, until));
    split = pick(both(low_good, hn::Not(high_good)), until, split);
    return both(low_good, high_good);
  }

  /// Stores the result of the rays of `mask`.
  void finish(const Ray& ray, const Found& found, M mask) {
    each_cut(ray, found, mask, [&](int place, const RayCut& cut) {
      near_[place] = cut.near, far_[place] = cut.far, t_near_[place] = cut.near_t, t_far_[place] = cut.far_t;
      taken_[place / dexel::kTileSide] |= 1U << (place % dexel::kTileSide);
    });
  }

  /// Completes the interval found so far in the lanes of `mask` and starts another one.
  void restart(Open& o, const Sample& s, M mask) {
    each_cut(o.ray, o.found, mask,
             [&](int place, const RayCut& cut) { earlier_.push_back({place, earlier_.size(), cut}); });
    o.found.at = {pick(mask, s.hit.near, o.found.at.near), pick(mask, s.hit.far, o.found.at.far)};
    o.found.t_near = pick(mask, s.t, o.found.t_near), o.found.t_far = pick(mask, s.t, o.found.t_far);
  }

  template <class F>
  void each_cut(const Ray& ray, const Found& found, M mask, const F& f) const {
    unsigned m = bits(both(mask, hn::Lt(found.at.near, found.at.far)));
    if (!m) return;
    double place[base::kLanes], near[base::kLanes], far[base::kLanes], t_near[base::kLanes], t_far[base::kLanes];
    hn::StoreU(ray.place, kD, place);
    hn::StoreU(hn::Add(found.at.near, set(b_.origin)), kD, near), hn::StoreU(found.t_near, kD, t_near);
    hn::StoreU(hn::Add(found.at.far, set(b_.origin)), kD, far), hn::StoreU(found.t_far, kD, t_far);
    for (; m; m &= m - 1) {
      const int k = std::countr_zero(m);
      f(static_cast<int>(place[k]), RayCut{near[k], far[k], t_near[k], t_far[k]});
    }
  }

  /// Subtracts the intervals in the order of the rays, so that sums do not depend on the order in which rays finish.
  void take() {
    // std::stable_sort would allocate memory.
    std::sort(earlier_.begin(), earlier_.end(),
              [](const Cut& a, const Cut& b) { return a.ray != b.ray ? a.ray < b.ray : a.number < b.number; });
    for (const Cut& c : earlier_)
      if (c.cut.far - c.cut.near > w_.thinnest) w_.cut(w_.self, c.ray, c.cut);
    for (int a = w_.first_row; a <= w_.last_row; ++a)
      for (int b = w_.first[a]; b < w_.end[a]; b += lanes()) {
        const unsigned taken = (taken_[a] >> b) & ((1U << lanes()) - 1);
        if (!taken) continue;
        const int ray = a * dexel::kTileSide + b;
        const M mask = from_bits(taken);
        const Group g = group_at(w_, a, b);
        // The other lanes' entries were never written, and zero times an arbitrary value need not be zero.
        const auto load = [&](const double* from) { return hn::IfThenElseZero(mask, hn::LoadU(kD, from + ray)); };
        subtract(w_, w_.u[a], g, mask, {load(near_), load(far_)}, load(t_near_), load(t_far_));
      }
  }

  static constexpr int kGuided = 8;
  static constexpr int kMaxPending = 50;  // kGuided, plus the maximum number of halvings (turning_part.cpp), plus one
  const TurningBody& b_;
  RayWindow& w_;
  Certificate certificate_;
  LaneQueue<Ray, 2 * base::kLanes> reached_;
  LaneQueue<Open, 16 * base::kLanes> open_;
  LaneStack<Sample, kMaxPending> pending_;
  // Which rays of the tile lose an interval, and which interval.
  std::uint32_t taken_[dexel::kTileSide] = {};
  double near_[dexel::kTileRays + base::kLanes], far_[dexel::kTileRays + base::kLanes],
      t_near_[dexel::kTileRays + base::kLanes], t_far_[dexel::kTileRays + base::kLanes];
  struct Cut {
    int ray;
    std::size_t number;
    RayCut cut;
  };
  base::BlockVector<Cut> earlier_;  // earlier intervals of rays that are cut more than once
};

inline void cut_turning_lanes(const TurningBody& body, RayWindow& window) {
  TurningLanes lanes(body, window);
  lanes.cut();
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
