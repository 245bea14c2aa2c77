// Cuts with a convex group on a straight path, many rays at a time. straight_part.hpp explains the geometry.
#if defined(RIFFLER_SWEEP_STRAIGHT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_STRAIGHT_LANES_INL_HPP
#undef RIFFLER_SWEEP_STRAIGHT_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_STRAIGHT_LANES_INL_HPP
#endif

#include "sweep/lanes/cut_lanes-inl.hpp"
#include "sweep/lanes/packed_rays-inl.hpp"
#include "sweep/lanes/straight_round-inl.hpp"
#include "sweep/straight_part.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// A vector of rays, and the section of the body with each of them. kWays: whether to record the path length at which
/// each end arises.
template <bool kWays>
class StraightLanes {
 public:
  StraightLanes(const StraightBody& body, V u, V v) : b_(body) {
    const V du = hn::Sub(u, set(b_.tip[0])), dv = hn::Sub(v, set(b_.tip[1]));
    const auto along = [&](const double* e) { return hn::Add(hn::Mul(du, set(e[0])), hn::Mul(dv, set(e[1]))); };
    r_ = {along(b_.e1), along(b_.e2), along(b_.axis)};
  }

  /// Finds both ends in the lanes of `mask`, between the heights `low` and `high` of the material. An end outside them
  /// need not be exact.
  void find(M mask, V low, V high) {
    M met[ConvexGroup::kMax], open = mask;
    for (std::size_t k = 0; k < b_.count; ++k) {
      const SweptShape& p = b_.pieces[k];
      met[k] = both(open, both(hn::Lt(low, set(p.ceiling)), hn::Gt(high, set(p.floor))));
      if (!p.round || p.e == 0 || none(met[k])) continue;
      met[k] = both(met[k], beside(p, low, high));
      if (!none(met[k])) met[k] = near_of_round(k, met[k], low, high, open);
    }
    if (none(open)) return;
    for (std::size_t k = b_.count; k-- > 0;) {  // upper pieces are simple and often determine `far`
      const SweptShape& p = b_.pieces[k];
      mask_ = met[k] = both(met[k], open);
      if (none(mask_)) continue;
      if (!p.round)
        frustum(p);
      else if (p.e == 0)
        ball(p);
      else
        far_of_round(p, low, high);
    }
    // If a piece's neighbour is not met, the face between them is a bound.
    for (std::size_t k = 0; k + 1 < b_.count; ++k) {
      const SweptShape &lower = b_.pieces[k], &upper = b_.pieces[k + 1];
      if (lower.cut1 && !lower.face1) hidden_face(without(met[k], met[k + 1]), lower.z1, lower.r1);
      if (upper.cut0 && !upper.face0) hidden_face(without(met[k + 1], met[k]), upper.z0, upper.r0);
    }
  }

  const RayIntervals& ends() const { return out_; }
  V near_time() const { return time(near_way_); }
  V far_time() const { return time(far_way_); }

 private:
  V time(V way) const { return hn::Add(set(b_.t0), hn::Mul(way, set(b_.per_way))); }

  static V dot(V a, double x, V b, double y, V c, double z) {
    return hn::Add(hn::Add(hn::Mul(a, set(x)), hn::Mul(b, set(y))), hn::Mul(c, set(z)));
  }
  static V less(V a, V b, double x) { return hn::Sub(a, hn::Mul(b, set(x))); }
  static V norm2(V a, V b, V c, double r) {
    return hn::Sub(hn::Add(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(c, c)), set(r * r));
  }
  void add_near(M good, V s, V way) {
    const M lower = both(both(good, mask_), hn::Lt(s, out_.near));
    out_.near = pick(lower, s, out_.near);
    if (kWays) near_way_ = pick(lower, way, near_way_);
  }
  void add_far(M good, V s, V way) {
    const M higher = both(both(good, mask_), hn::Gt(s, out_.far));
    out_.far = pick(higher, s, out_.far);
    if (kWays) far_way_ = pick(higher, way, far_way_);
  }
  void add(M good, V s, V way) { add_near(good, s, way), add_far(good, s, way); }
  /// Includes an interval at one pose, unless it is empty or infinite.
  void include(RayIntervals s, double way) {
    const M good = both(hn::Le(s.near, s.far), both(hn::Gt(s.near, set(-kInfinity)), hn::Lt(s.far, set(kInfinity))));
    add_near(good, s.near, set(way)), add_far(good, s.far, set(way));
  }
  M on_way(V t) const { return both(hn::Ge(t, zero()), hn::Le(t, set(b_.way))); }
  static M on_side(const SweptShape& p, V z) { return both(hn::Ge(z, set(p.low)), hn::Le(z, set(p.high))); }

  void frustum(const SweptShape& p) {
    include(frustum_at(p, 0), 0);
    if (b_.way == 0) return;
    include(frustum_at(p, b_.way), b_.way);
    faces(p);
    silhouette(p);
  }

  void ball(const SweptShape& p) {
    const V zc = hn::Sub(r_.z, set(p.zc));
    include(ball_at(p, zc, 0), 0);
    if (b_.way == 0) return;
    include(ball_at(p, zc, b_.way), b_.way);
    faces(p);
    const double p1 = b_.tilt * b_.m1 + b_.oz * b_.mo;
    const V p0 = dot(r_.x, b_.m1, r_.y, b_.m2, zc, b_.mo);
    const V a = less(r_.x, p0, b_.m1), b = less(r_.y, p0, b_.m2), c = less(zc, p0, b_.mo);
    const double da = b_.tilt - p1 * b_.m1, db = -p1 * b_.m2, dc = b_.oz - p1 * b_.mo;
    const RayIntervals side = at_most_zero(da * da + db * db + dc * dc, dot(a, da, b, db, c, dc), norm2(a, b, c, p.r));
    for (const V s : {side.near, side.far}) {
      const V t = hn::Add(p0, hn::Mul(s, set(p1)));
      M good = on_way(t);
      if (p.cut0 || p.cut1) good = both(good, on_side(p, less(hn::Add(r_.z, hn::Mul(s, set(b_.oz))), t, b_.mo)));
      add(good, s, t);
    }
  }

  /// Lanes that, between these heights of the ray, come to the heights on the axis at which the piece's side lies.
  /// Elsewhere its ring may continue, but not its side, and a search for the ring's end is slow where there is none.
  M beside(const SweptShape& p, V low, V high) const {
    const V a = hn::Mul(low, set(b_.oz)), b = hn::Mul(high, set(b_.oz));
    const double back = std::max(0.0, b_.way * b_.mo), on = std::min(0.0, b_.way * b_.mo);
    return both(hn::Le(hn::Add(r_.z, min(a, b)), set(p.high + back)),
                hn::Ge(hn::Add(r_.z, max(a, b)), set(p.low + on)));
  }

  /// Torus or barrel. Returns the lanes of `mask` that meet it below the top of the material. Removes from `open` the
  /// lanes that are complete: their near end is on the group's own surface, and the top of the material lies in the
  /// group at that pose.
  M near_of_round(std::size_t k, M mask, V low, V high, M& open) {
    const SweptShape& p = b_.pieces[k];
    V s, way;
    const M met = StraightRound(b_, p, r_).end(mask, 1, low, high, s, way);
    // The near end may be found above the material. There the search for the far end may find none, so such a Round
    // is not met, and its neighbour ends at the face between them.
    const M near = both(met, hn::Le(s, high));
    mask_ = mask;
    const V z = height(s, way);
    add_near(both(near, on_side(p, z)), s, way);
    M own = near;
    if (p.cut0) own = both(own, hn::Ge(z, set(p.z0)));
    if (p.cut1) own = both(own, hn::Le(z, set(p.z1)));
    if (k + 1 < b_.count) own = both(own, hn::Le(z, set(b_.pieces[k + 1].z0)));
    if (none(own)) return near;
    M held = no_lane();
    for (std::size_t i = k; i < b_.count; ++i) held = either(held, holds(b_.pieces[i], high, way));
    const M done = both(own, held);
    add_far(done, high, way);
    open = without(open, done);
    return near;
  }

  void far_of_round(const SweptShape& p, V low, V high) {
    faces(p);
    const M rest = both(mask_, hn::Lt(out_.far, high));
    if (none(rest)) return;
    V s, way;
    const M far = StraightRound(b_, p, r_).end(rest, -1, low, high, s, way);
    add_far(both(far, on_side(p, height(s, way))), s, way);
  }

  /// Height along the axis of the rays' points at s when the tool has moved this far along its path.
  V height(V s, V way) const { return less(hn::Add(r_.z, hn::Mul(s, set(b_.oz))), way, b_.mo); }

  /// Lanes whose point at s lies in the piece when the tool has moved this far along its path.
  M holds(const SweptShape& p, V s, V way) const {
    const V a = hn::Sub(hn::Add(r_.x, hn::Mul(s, set(b_.tilt))), hn::Mul(way, set(b_.m1)));
    const V b = less(r_.y, way, b_.m2), z = height(s, way);
    const V square = hn::Add(hn::Mul(a, a), hn::Mul(b, b));
    const M on = both(hn::Ge(z, set(p.z0)), hn::Le(z, set(p.z1)));
    if (!p.round) {
      const V radius = hn::Add(set(p.r0), hn::Mul(set(p.slope), hn::Sub(z, set(p.z0))));
      return both(on, hn::Le(square, hn::Mul(radius, radius)));
    }
    const V out = max(hn::Sub(sqrt(square), set(p.e)), zero()), up = hn::Sub(z, set(p.zc));
    return both(on, hn::Le(hn::Add(hn::Mul(out, out), hn::Mul(up, up)), set(p.r * p.r)));
  }

  RayIntervals slab_at(const SweptShape& p, double way) const {
    return slab(hn::Sub(r_.z, set(way * b_.mo + p.z0)), b_.oz, p.z1 - p.z0);
  }

  RayIntervals frustum_at(const SweptShape& p, double way) const {
    const V a = hn::Sub(r_.x, set(way * b_.m1)), b = hn::Sub(r_.y, set(way * b_.m2));
    const V k = hn::Add(set(p.r0), hn::Mul(set(p.slope), hn::Sub(r_.z, set(way * b_.mo + p.z0))));
    const double grow = p.slope * b_.oz, q2 = b_.tilt * b_.tilt - grow * grow;
    const V q1 = hn::Sub(hn::Mul(a, set(b_.tilt)), hn::Mul(k, set(grow)));
    const V q0 = hn::Sub(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(k, k));
    RayIntervals side;
    if (q2 >= 0) {
      side = at_most_zero(q2, q1, q0);
    } else {
      const V root = sqrt(max(zero(), hn::Sub(hn::Mul(q1, q1), hn::Mul(set(q2), q0))));
      const V q = hn::Neg(hn::Add(q1, with_sign(root, q1)));
      const M flat = hn::Eq(q, zero());
      const V s1 = hn::Mul(q, set(1 / q2)), s2 = pick(flat, zero(), hn::Div(q0, pick(flat, set(1), q)));
      side = grow > 0 ? RayIntervals{max(s1, s2), set(kInfinity)} : RayIntervals{set(-kInfinity), min(s1, s2)};
    }
    const RayIntervals at = common(side, slab_at(p, way));
    return where(both(hn::Le(at.near, at.far), both(hn::Gt(at.near, set(-kInfinity)), hn::Lt(at.far, set(kInfinity)))),
                 at);
  }

  RayIntervals ball_at(const SweptShape& p, V zc, double way) const {
    const V a = hn::Sub(r_.x, set(way * b_.m1)), b = hn::Sub(r_.y, set(way * b_.m2)), c = hn::Sub(zc, set(way * b_.mo));
    RayIntervals at = at_most_zero(1, hn::Add(hn::Mul(a, set(b_.tilt)), hn::Mul(c, set(b_.oz))), norm2(a, b, c, p.r));
    if (p.cut0 || p.cut1) at = common(at, slab_at(p, way));
    return where(hn::Le(at.near, at.far), at);
  }

  void faces(const SweptShape& p) {
    if (p.face0) face(p.z0, p.r0);
    if (p.face1) face(p.z1, p.r1);
  }

  void hidden_face(M mask, double z, double radius) {
    if (none(mask)) return;
    mask_ = mask;
    face(z, radius);
  }

  void face(double z, double radius) {
    // If there is no such line, ray and motion lie in the plane, and the side's own hits bound the section.
    if (!b_.face.exists) return;
    const double ds = b_.face.ds, dt = b_.face.dt;
    const V at = hn::Mul(hn::Sub(set(z), r_.z), set(b_.face.per_norm));
    const V s0 = hn::Mul(at, set(dt)), t0 = hn::Mul(at, set(-ds));
    const V a = hn::Add(r_.x, hn::Sub(hn::Mul(s0, set(b_.tilt)), hn::Mul(t0, set(b_.m1))));
    const V b = less(r_.y, t0, b_.m2);
    const double da = ds * b_.tilt - dt * b_.m1, db = -dt * b_.m2;
    const V q0 = hn::Sub(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), set(radius * radius));
    const RayIntervals disc = at_most_zero(da * da + db * db, hn::Add(hn::Mul(a, set(da)), hn::Mul(b, set(db))), q0);
    const RayIntervals line = common(disc, slab(t0, dt, b_.way));
    const M good =
        both(hn::Le(line.near, line.far), both(hn::Gt(line.near, set(-kInfinity)), hn::Lt(line.far, set(kInfinity))));
    for (const V l : {line.near, line.far})
      add(good, hn::Add(s0, hn::Mul(l, set(ds))), hn::Add(t0, hn::Mul(l, set(dt))));
  }

  void silhouette(const SweptShape& p) {
    // If there is no such line, the motion runs along the flank, and both ends and both faces bound the section.
    if (!p.outline.exists) return;
    const double ds = p.outline.ds, dt = p.outline.dt;
    const V k0 = hn::Add(set(p.r0), hn::Mul(set(p.slope), hn::Sub(r_.z, set(p.z0))));
    const V at = hn::Mul(dot(k0, -p.slope * b_.mo, r_.x, b_.m1, r_.y, b_.m2), set(p.outline.per_norm));
    const V s0 = hn::Mul(at, set(dt)), t0 = hn::Mul(at, set(-ds));
    const V a = hn::Add(r_.x, hn::Sub(hn::Mul(s0, set(b_.tilt)), hn::Mul(t0, set(b_.m1))));
    const V b = less(r_.y, t0, b_.m2);
    const V k = hn::Add(k0, hn::Mul(set(p.slope), hn::Sub(hn::Mul(s0, set(b_.oz)), hn::Mul(t0, set(b_.mo)))));
    const double da = ds * b_.tilt - dt * b_.m1, db = -dt * b_.m2, dk = p.slope * (b_.oz * ds - b_.mo * dt);
    const double bend = da * da + db * db - dk * dk, q2 = std::abs(bend);
    V q1 = dot(a, da, b, db, k, -dk);
    V q0 = hn::Sub(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(k, k));
    if (bend < 0) q1 = hn::Neg(q1), q0 = hn::Neg(q0);
    RayIntervals roots = at_most_zero(q2, 1 / q2, q1, q0, SweptShape::kTangent);
    M real = hn::Le(roots.near, roots.far);
    if (p.cut0 && p.r0 == 0 && std::abs(dk) > 1e-6 && q2 > 1e-6) {
      // Next to the apex the two roots coincide and lose half of their digits, unless they are measured from there.
      const V apex = hn::Mul(k, set(-1 / dk)), square = hn::Mul(q1, q1);
      const V x = hn::Add(a, hn::Mul(apex, set(da))), y = hn::Add(b, hn::Mul(apex, set(db)));
      const V p1 = hn::Add(hn::Mul(x, set(da)), hn::Mul(y, set(db))), p0 = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
      const double rounding = 1e-12 * (p.z1 - p.z0);
      const M met = hn::Le(p0, set(rounding * rounding));
      const M tangent = both(real, hn::Le(hn::Sub(square, hn::Mul(set(q2), q0)), hn::Mul(set(1e-10), square)));
      const V root = sqrt(max(hn::Sub(hn::Mul(p1, p1), hn::Mul(set(bend), p0)), zero()));
      const auto from_apex = [&](V l) { return hn::Add(apex, hn::Mul(l, set(1 / bend))); };
      roots.near = pick(either(met, tangent), from_apex(hn::Neg(hn::Add(p1, root))), roots.near);
      roots.far = pick(either(met, tangent), from_apex(hn::Sub(root, p1)), roots.far);
      real = either(real, met);
    }
    for (const V l : {roots.near, roots.far}) {
      const V s = hn::Add(s0, hn::Mul(l, set(ds))), t = hn::Add(t0, hn::Mul(l, set(dt)));
      const V z = less(hn::Add(r_.z, hn::Mul(s, set(b_.oz))), t, b_.mo);
      add(both(real, both(on_way(t), on_side(p, z))), s, t);
    }
  }

  const StraightBody& b_;
  SectionRays r_;
  M mask_;  // lanes with material at heights that the piece reaches
  RayIntervals out_ = nothing();
  V near_way_ = zero(), far_way_ = zero();
};

template <bool kWays>
void cut_straight_with(const StraightBody& body, RayWindow& w) {
  const V tip = set(body.tip[2]);
  PackedRays rays(w);
  w.hits += static_cast<unsigned>(rays.count());
  for (int k = 0; k < rays.count(); k += lanes()) {
    StraightLanes<kWays> section(body, rays.u(k), rays.v(k));
    section.find(rays.present(k), hn::Sub(rays.low(k), tip), hn::Sub(rays.high(k), tip));
    rays.store(k, 0, hn::Add(section.ends().near, tip)), rays.store(k, 1, hn::Add(section.ends().far, tip));
    if (kWays) rays.store(k, 2, section.near_time()), rays.store(k, 3, section.far_time());
  }
  const V middle = set(body.middle);
  rays.each_group(w, [&](double u, const Group& g, const auto& result) {
    subtract(w, u, g, g.active, {result(0), result(1)}, kWays ? result(2) : middle, kWays ? result(3) : middle);
  });
}

inline void cut_straight_lanes(const StraightBody& body, RayWindow& w) {
  if (w.with_times)
    cut_straight_with<true>(body, w);
  else
    cut_straight_with<false>(body, w);
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
