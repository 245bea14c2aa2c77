// A convex group of pieces at one pose: where rays meet it, the normals there, and planes between it and rays it misses.
#if defined(RIFFLER_SWEEP_POSE_HITS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_POSE_HITS_INL_HPP
#undef RIFFLER_SWEEP_POSE_HITS_INL_HPP
#else
#define RIFFLER_SWEEP_POSE_HITS_INL_HPP
#endif

#include "sweep/cut_lanes-inl.hpp"
#include "sweep/turning_part.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

/// A direction in the tool's frame (e1, e2, axis), of unit length.
struct Normal {
  V a, b, c;
};

HWY_INLINE Normal choose(M m, const Normal& yes, const Normal& no) {
  return {pick(m, yes.a, no.a), pick(m, yes.b, no.b), pick(m, yes.c, no.c)};
}

/// (a, b, c) made one long; (1, 0, 0) where it is zero.
HWY_INLINE Normal unit(V a, V b, V c) {
  const V square = hn::Add(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(c, c));
  const M good = hn::Gt(square, set(1e-300));
  const V scale = hn::Div(set(1), sqrt(pick(good, square, set(1))));
  return {pick(good, hn::Mul(a, scale), set(1)), pick(good, hn::Mul(b, scale), zero()),
          pick(good, hn::Mul(c, scale), zero())};
}

class PoseHits {
 public:
  PoseHits(const TurningPoses& group, const PoseFrame& pose, double du, V dv) : group_(group), p_(pose) {
    const auto along = [&](const double* e) { return hn::Add(set(du * e[0]), hn::Mul(dv, set(e[1]))); };
    rays_ = {along(pose.e1), along(pose.e2), along(pose.axis)};
  }

  const SectionRays& rays() const { return rays_; }
  /// Heights over the tip.
  Stretch stretch() const { return out_; }
  const Normal& near() const { return near_; }
  const Normal& far() const { return far_; }

  /// Returns the lanes that meet the group. A far end above `high` need not be exact.
  M find(M active, V high) {
    out_ = nothing();
    near_ = far_ = {set(1), zero(), zero()};
    for (std::size_t k = group_.count(); k-- > 0;) {  // the upper pieces are simple and often make `far` known
      const PieceShape& s = group_.piece(k);
      if (!s.round)
        frustum(s);
      else if (s.ball)
        ball(s);
      else
        round(s, active, high);
    }
    return hn::Lt(out_.near, out_.far);
  }

  /// The group's extent in direction n.
  V support(const Normal& n) const {
    const V across = sqrt(hn::Add(hn::Mul(n.a, n.a), hn::Mul(n.b, n.b)));
    V most = set(-kInfinity);
    for (std::size_t k = 0; k < group_.count(); ++k) {
      const PieceShape& s = group_.piece(k);
      const V low = hn::Add(hn::Mul(n.c, set(s.z0)), hn::Mul(across, set(s.r0)));
      const V high = hn::Add(hn::Mul(n.c, set(s.z1)), hn::Mul(across, set(s.r1)));
      V reach = max(low, high);
      if (s.round) {
        const V at = hn::Mul(n.c, set(s.r));
        const V arc = hn::Add(hn::Add(hn::Mul(n.c, set(s.zc)), hn::Mul(across, set(s.e))), set(s.r));
        reach = pick(hn::Gt(at, set(s.z1 - s.zc)), high, pick(hn::Lt(at, set(s.z0 - s.zc)), low, arc));
      }
      most = max(most, reach);
    }
    return most;
  }

  /// Where rays miss the group: a direction square to the ray in which they do. Of the pieces' own, the best.
  Normal between(M missed) const {
    Normal best{set(1), zero(), zero()};
    V most = set(-kInfinity);
    for (std::size_t k = 0; k < group_.count(); ++k) {
      const PieceShape& s = group_.piece(k);
      const Normal n = s.round ? beside_round(s) : beside_frustum(s);
      if (group_.count() == 1) return n;
      const V reach = hn::Add(hn::Add(hn::Mul(n.a, rays_.x), hn::Mul(n.b, rays_.y)), hn::Mul(n.c, rays_.z));
      const V height = hn::Sub(reach, support(n));
      const M better = both(missed, hn::Gt(height, most));
      best = choose(better, n, best), most = pick(better, height, most);
    }
    return best;
  }

 private:
  V x_at(V s) const { return hn::Add(rays_.x, hn::Mul(s, set(p_.tilt))); }
  V z_at(V s) const { return hn::Add(rays_.z, hn::Mul(s, set(p_.oz))); }
  Normal face(bool up) const { return {zero(), zero(), set(up ? 1.0 : -1.0)}; }

  void add(M hit, Stretch s, const Normal& near, const Normal& far) {
    const M lower = both(hit, hn::Lt(s.near, out_.near)), higher = both(hit, hn::Gt(s.far, out_.far));
    out_.near = pick(lower, s.near, out_.near), out_.far = pick(higher, s.far, out_.far);
    near_ = choose(lower, near, near_), far_ = choose(higher, far, far_);
  }

  void frustum(const PieceShape& s) {
    const SectionRays& r = rays_;
    const V k = hn::Add(set(s.r0), hn::Mul(set(s.slope), hn::Sub(r.z, set(s.z0))));
    const double grow = s.slope * p_.oz, q2 = p_.tilt * p_.tilt - grow * grow;
    const V q1 = hn::Sub(hn::Mul(r.x, set(p_.tilt)), hn::Mul(k, set(grow)));
    const V q0 = hn::Sub(hn::Add(hn::Mul(r.x, r.x), hn::Mul(r.y, r.y)), hn::Mul(k, k));
    const Stretch side = q2 >= 0 ? at_most_zero(q2, q1, q0) : nappe(q2, q1, q0, grow > 0);
    const Stretch inside = slab(hn::Sub(r.z, set(s.z0)), p_.oz, s.z1 - s.z0);
    const Stretch at = common(side, inside);
    const M hit = both(hn::Lt(at.near, at.far), both(hn::Gt(at.near, set(-kInfinity)), hn::Lt(at.far, set(kInfinity))));
    if (none(hit)) return;
    const Normal near = choose(hn::Gt(side.near, inside.near), flank(s, at.near), face(p_.oz < 0));
    const Normal far = choose(hn::Lt(side.far, inside.far), flank(s, at.far), face(p_.oz > 0));
    add(hit, at, near, far);
  }

  /// Steeper than the flank, a ray stays inside of one nappe beyond a root.
  static Stretch nappe(double q2, V q1, V q0, bool grows) {
    const V root = sqrt(max(zero(), hn::Sub(hn::Mul(q1, q1), hn::Mul(set(q2), q0))));
    const V q = hn::Neg(hn::Add(q1, with_sign(root, q1)));
    const M flat = hn::Eq(q, zero());
    const V a = hn::Mul(q, set(1 / q2)), b = pick(flat, zero(), hn::Div(q0, pick(flat, set(1), q)));
    return grows ? Stretch{max(a, b), set(kInfinity)} : Stretch{set(-kInfinity), min(a, b)};
  }

  Normal flank(const PieceShape& s, V at) const {
    const V x = x_at(at), y = rays_.y;
    if (s.slope == 0) return {hn::Mul(x, set(1 / s.r0)), hn::Mul(y, set(1 / s.r0)), zero()};
    const V rho = sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
    const M good = hn::Gt(rho, set(1e-150));
    const V scale = hn::Div(set(s.cosine), pick(good, rho, set(1)));
    return {pick(good, hn::Mul(x, scale), set(s.cosine)), pick(good, hn::Mul(y, scale), zero()),
            set(-s.slope * s.cosine)};
  }

  void ball(const PieceShape& s) {
    const V c = hn::Sub(rays_.z, set(s.zc));
    const V q1 = hn::Add(hn::Mul(rays_.x, set(p_.tilt)), hn::Mul(c, set(p_.oz)));
    const V q0 = hn::Sub(
        hn::Add(hn::Add(hn::Mul(rays_.x, rays_.x), hn::Mul(rays_.y, rays_.y)), hn::Mul(c, c)), set(s.r * s.r));
    const Stretch at = at_most_zero(1, q1, q0);
    const M hit = hn::Lt(at.near, at.far);
    if (none(hit)) return;
    const V scale = set(1 / s.r), y = hn::Mul(rays_.y, scale);
    const auto normal = [&](V t) {
      return Normal{hn::Mul(x_at(t), scale), y, hn::Mul(hn::Sub(z_at(t), set(s.zc)), scale)};
    };
    add(hit, at, normal(at.near), normal(at.far));
  }

  /// Distance to the disc (or, for e < 0, to the circle beyond the axis) that a Round thickens, less its thickness.
  struct Gap {
    V out, rho, z, d, gap, rate;
  };
  Gap gap(const PieceShape& s, V at) const {
    Gap g;
    const V x = x_at(at);
    g.z = hn::Sub(z_at(at), set(s.zc));
    g.rho = sqrt(hn::Add(hn::Mul(x, x), hn::Mul(rays_.y, rays_.y)));
    g.out = max(hn::Sub(g.rho, set(s.e)), zero());
    g.d = sqrt(hn::Add(hn::Mul(g.out, g.out), hn::Mul(g.z, g.z)));
    const V rho = max(g.rho, set(1e-150)), d = max(g.d, set(1e-150));
    const V along = hn::Add(hn::Div(hn::Mul(g.out, hn::Mul(x, set(p_.tilt))), rho), hn::Mul(g.z, set(p_.oz)));
    g.gap = hn::Sub(g.d, set(s.r)), g.rate = hn::Div(along, d);
    return g;
  }
  Normal normal(const Gap& g, V at) const {
    const V rho = max(g.rho, set(1e-150)), d = max(g.d, set(1e-150));
    const V scale = hn::Div(g.out, hn::Mul(rho, d));
    return {hn::Mul(x_at(at), scale), hn::Mul(rays_.y, scale), hn::Div(g.z, d)};
  }

  /// The distance is convex along the ray, so Newton's method from outside walks to the root without passing it. Starts
  /// where the ray enters the cylinder and slab about the piece. `sign` 1: near end, −1: far end.
  M walk(const PieceShape& s, M mask, double sign, V& at, V until, Normal& n) const {
    M hit = no_lane(), open = mask;
    n = {set(1), zero(), zero()};
    const V tiny = set(1e-14 * (std::abs(s.e) + s.r));
    for (int i = 0; i < kMostSteps && !none(open); ++i) {
      const Gap g = gap(s, at);
      const M arrived = both(open, hn::Le(g.gap, tiny));
      if (!none(arrived)) {
        // Deep inside at once: the slab's own plane is what the ray entered through.
        const M flat = hn::Lt(g.gap, set(-1e-9 * s.r));
        n = choose(arrived, choose(flat, face(sign * p_.oz < 0), normal(g, at)), n);
        hit = either(hit, arrived), open = without(open, arrived);
      }
      const V rate = hn::Mul(g.rate, set(sign));
      open = both(open, hn::Lt(rate, zero()));
      at = pick(open, hn::Sub(at, hn::Div(g.gap, pick(open, g.rate, set(1)))), at);
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
    Normal near, far;
    const M hit = walk(s, mask, 1, at.near, box.far, near);
    if (none(hit)) return;
    const M rest = both(hit, hn::Lt(out_.far, min(high, box.far)));
    at.far = pick(rest, box.far, at.near);
    far = near;
    if (!none(rest)) {
      Normal n;
      const M found = walk(s, rest, -1, at.far, at.near, n);
      far = choose(found, n, far), at.far = pick(found, at.far, at.near);
    }
    const M lower = both(hit, hn::Lt(at.near, out_.near)), higher = both(rest, hn::Gt(at.far, out_.far));
    out_.near = pick(lower, at.near, out_.near), near_ = choose(lower, near, near_);
    out_.far = pick(higher, at.far, out_.far), far_ = choose(higher, far, far_);
  }

  /// The ray inside of the slab and the cylinder about a Round.
  Stretch box_of(const PieceShape& s) const {
    const double low = std::max(s.z0, s.zc - s.r), high = std::min(s.z1, s.zc + s.r), most = s.e + s.r;
    const V q0 = hn::Sub(hn::Add(hn::Mul(rays_.x, rays_.x), hn::Mul(rays_.y, rays_.y)), set(most * most));
    const Stretch side = at_most_zero(p_.tilt * p_.tilt, hn::Mul(rays_.x, set(p_.tilt)), q0);
    return common(side, slab(hn::Sub(rays_.z, set(low)), p_.oz, high - low));
  }

  /// Height within [low, high] over the tool's tip at which the ray comes closest to the axis; s along the ray.
  V closest(V at, double low, double high) const {
    if (std::abs(p_.oz) < 1e-200) return at;
    const V a = hn::Mul(hn::Sub(set(low), rays_.z), set(1 / p_.oz)), b = hn::Mul(hn::Sub(set(high), rays_.z), set(1 / p_.oz));
    return max(min(a, b), min(max(a, b), at));
  }

  /// The combination of the radial direction at (x, y) and the axis that is square to the ray: the normal of a rim's
  /// outline as the ray sees it.
  Normal rim(V x) const {
    const V y = rays_.y, rho = max(sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y))), set(1e-150));
    const V a = hn::Div(x, rho), b = hn::Div(y, rho);
    if (std::abs(p_.oz) < 1e-12) return {zero(), pick(hn::Lt(y, zero()), set(-1), set(1)), zero()};
    const double oz = std::abs(p_.oz);
    const V c = hn::Mul(a, set(-p_.tilt * (p_.oz < 0 ? -1.0 : 1.0)));
    return unit(hn::Mul(a, set(oz)), hn::Mul(b, set(oz)), c);
  }

  Normal beside_frustum(const PieceShape& s) const {
    const double grow = s.slope * p_.oz;
    if (p_.tilt < 1e-12) return rim(rays_.x);
    const double ratio = grow / p_.tilt;
    V best;
    if (std::abs(ratio) < 1) {
      const V off = hn::Mul(abs(rays_.y), set(ratio / std::sqrt(1 - ratio * ratio)));
      best = hn::Mul(hn::Sub(off, rays_.x), set(1 / p_.tilt));
    } else {
      best = set(grow > 0 ? 1e300 : -1e300);
    }
    const V at = closest(best, s.z0, s.z1);
    if (std::abs(p_.oz) < 1e-12) {
      // The ray runs level: it may pass above or below.
      const M above = hn::Gt(rays_.z, set(s.z1)), under = hn::Lt(rays_.z, set(s.z0));
      return choose(above, face(true), choose(under, face(false), flank(s, best)));
    }
    return choose(hn::Eq(at, best), flank(s, at), rim(x_at(at)));
  }

  /// The direction of least distance from the disc, made square to the ray.
  Normal beside_round(const PieceShape& s) const {
    const double low = std::max(s.z0, s.zc - s.r), high = std::min(s.z1, s.zc + s.r);
    V at = p_.tilt > 1e-12 ? closest(hn::Mul(rays_.x, set(-1 / p_.tilt)), low, high) : closest(zero(), s.zc, s.zc);
    if (s.e <= 0) at = hn::Neg(hn::Add(hn::Mul(rays_.x, set(p_.tilt)), hn::Mul(hn::Sub(rays_.z, set(s.zc)), set(p_.oz))));
    for (int i = 0; i < 2 && s.e != 0; ++i) {
      // One step of Newton's method on the squared distance; a step too far only makes the plane worse.
      const Gap g = gap(s, at);
      const M bent = hn::Gt(g.out, zero());
      const V pull = hn::Mul(g.d, g.rate);
      const V bend = hn::Add(set(p_.oz * p_.oz), hn::IfThenElseZero(bent, set(p_.tilt * p_.tilt)));
      at = hn::Sub(at, hn::Div(pull, max(bend, set(1e-12))));
    }
    const Gap g = gap(s, at);
    const Normal n = normal(g, at);
    const V along = hn::Add(hn::Mul(n.a, set(p_.tilt)), hn::Mul(n.c, set(p_.oz)));
    return unit(hn::Sub(n.a, hn::Mul(along, set(p_.tilt))), n.b, hn::Sub(n.c, hn::Mul(along, set(p_.oz))));
  }

  static constexpr int kMostSteps = 24;
  const TurningPoses& group_;
  const PoseFrame& p_;
  SectionRays rays_;
  Stretch out_;
  Normal near_, far_;
};

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
