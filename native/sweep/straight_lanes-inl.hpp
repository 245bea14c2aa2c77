// SweptPiece::hit (swept_piece.cpp, where the geometry is explained) for many rays at a time.
#if defined(RIFFLER_SWEEP_STRAIGHT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_STRAIGHT_LANES_INL_HPP
#undef RIFFLER_SWEEP_STRAIGHT_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_STRAIGHT_LANES_INL_HPP
#endif

#include "sweep/cut_lanes-inl.hpp"
#include "sweep/straight_round-inl.hpp"
#include "sweep/swept_piece.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

class StraightLanes {
 public:
  explicit StraightLanes(const SweptShape& shape) : p_(shape) {}

  SectionRays rays(double u, V v) const {
    const double du = u - p_.tip[0];
    const V dv = hn::Sub(v, set(p_.tip[1]));
    const auto along = [&](const double* e) { return hn::Add(set(du * e[0]), hn::Mul(dv, set(e[1]))); };
    return {along(p_.e1), along(p_.e2), along(p_.axis)};
  }

  /// s counts from the height of the tip.
  Stretch frustum(const SectionRays& r) const {
    Stretch out = at_pose(r, 0);
    if (p_.way == 0) return out;
    include(out, at_pose(r, p_.way));
    face(r, p_.z0, p_.r0, out), face(r, p_.z1, p_.r1, out);
    silhouette(r, out);
    return out;
  }

  Stretch ball(const SectionRays& r) const {
    const V zc = hn::Sub(r.z, set(p_.zc));
    Stretch out = ball_at(r, zc, 0);
    if (p_.way == 0) return out;
    include(out, ball_at(r, zc, p_.way));
    if (p_.cut_bottom) face(r, p_.z0, p_.r0, out);
    if (p_.cut_top) face(r, p_.z1, p_.r1, out);
    const double p1 = p_.tilt * p_.m1 + p_.oz * p_.mo;
    const V p0 = dot(r.x, p_.m1, r.y, p_.m2, zc, p_.mo);
    const V a = less(r.x, p0, p_.m1), b = less(r.y, p0, p_.m2), c = less(zc, p0, p_.mo);
    const double da = p_.tilt - p1 * p_.m1, db = -p1 * p_.m2, dc = p_.oz - p1 * p_.mo;
    const Stretch side = at_most_zero(da * da + db * db + dc * dc, dot(a, da, b, db, c, dc), norm2(a, b, c, p_.r));
    for (const V s : {side.near, side.far}) {
      const V t = hn::Add(p0, hn::Mul(s, set(p1)));
      M good = on_way(t);
      if (p_.cut_bottom || p_.cut_top) good = both(good, on_side(less(hn::Add(r.z, hn::Mul(s, set(p_.oz))), t, p_.mo)));
      add(out, good, s);
    }
    return out;
  }

 private:
  static V dot(V a, double x, V b, double y, V c, double z) {
    return hn::Add(hn::Add(hn::Mul(a, set(x)), hn::Mul(b, set(y))), hn::Mul(c, set(z)));
  }
  static V less(V a, V b, double x) { return hn::Sub(a, hn::Mul(b, set(x))); }
  static V norm2(V a, V b, V c, double r) {
    return hn::Sub(hn::Add(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(c, c)), set(r * r));
  }
  static void add(Stretch& out, M good, V s) {
    out.near = pick(good, min(out.near, s), out.near), out.far = pick(good, max(out.far, s), out.far);
  }
  /// Stretches that are not empty and finite.
  static void include(Stretch& out, Stretch s) {
    const M good = both(hn::Le(s.near, s.far), both(hn::Gt(s.near, set(-kInfinity)), hn::Lt(s.far, set(kInfinity))));
    add(out, good, s.near), add(out, good, s.far);
  }
  M on_way(V t) const { return both(hn::Ge(t, zero()), hn::Le(t, set(p_.way))); }
  M on_side(V z) const { return both(hn::Ge(z, set(p_.low)), hn::Le(z, set(p_.high))); }

  Stretch slab_at(const SectionRays& r, double way) const {
    return slab(hn::Sub(r.z, set(way * p_.mo + p_.z0)), p_.oz, p_.z1 - p_.z0);
  }

  Stretch at_pose(const SectionRays& r, double way) const {
    const V a = hn::Sub(r.x, set(way * p_.m1)), b = hn::Sub(r.y, set(way * p_.m2));
    const V k = hn::Add(set(p_.r0), hn::Mul(set(p_.slope), hn::Sub(r.z, set(way * p_.mo + p_.z0))));
    const double grow = p_.slope * p_.oz, q2 = p_.tilt * p_.tilt - grow * grow;
    const V q1 = hn::Sub(hn::Mul(a, set(p_.tilt)), hn::Mul(k, set(grow)));
    const V q0 = hn::Sub(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(k, k));
    Stretch side;
    if (q2 >= 0) {
      side = at_most_zero(q2, q1, q0);
    } else {
      const V root = sqrt(max(zero(), hn::Sub(hn::Mul(q1, q1), hn::Mul(set(q2), q0))));
      const V q = hn::Neg(hn::Add(q1, with_sign(root, q1)));
      const M flat = hn::Eq(q, zero());
      const V s1 = hn::Mul(q, set(1 / q2)), s2 = pick(flat, zero(), hn::Div(q0, pick(flat, set(1), q)));
      side = grow > 0 ? Stretch{max(s1, s2), set(kInfinity)} : Stretch{set(-kInfinity), min(s1, s2)};
    }
    const Stretch at = common(side, slab_at(r, way));
    return where(both(hn::Le(at.near, at.far), both(hn::Gt(at.near, set(-kInfinity)), hn::Lt(at.far, set(kInfinity)))),
                 at);
  }

  Stretch ball_at(const SectionRays& r, V zc, double way) const {
    const V a = hn::Sub(r.x, set(way * p_.m1)), b = hn::Sub(r.y, set(way * p_.m2)), c = hn::Sub(zc, set(way * p_.mo));
    Stretch at = at_most_zero(1, hn::Add(hn::Mul(a, set(p_.tilt)), hn::Mul(c, set(p_.oz))), norm2(a, b, c, p_.r));
    if (p_.cut_bottom || p_.cut_top) at = common(at, slab_at(r, way));
    return where(hn::Le(at.near, at.far), at);
  }

  void face(const SectionRays& r, double z, double radius, Stretch& out) const {
    const double norm = std::hypot(p_.oz, p_.mo);
    if (norm < 1e-12) return;
    const double ds = p_.mo / norm, dt = p_.oz / norm;
    const V at = hn::Mul(hn::Sub(set(z), r.z), set(1 / norm));
    const V s0 = hn::Mul(at, set(dt)), t0 = hn::Mul(at, set(-ds));
    const V a = hn::Add(r.x, hn::Sub(hn::Mul(s0, set(p_.tilt)), hn::Mul(t0, set(p_.m1))));
    const V b = less(r.y, t0, p_.m2);
    const double da = ds * p_.tilt - dt * p_.m1, db = -dt * p_.m2;
    const V q0 = hn::Sub(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), set(radius * radius));
    const Stretch disc = at_most_zero(da * da + db * db, hn::Add(hn::Mul(a, set(da)), hn::Mul(b, set(db))), q0);
    const Stretch line = common(disc, slab(t0, dt, p_.way));
    const M good =
        both(hn::Le(line.near, line.far), both(hn::Gt(line.near, set(-kInfinity)), hn::Lt(line.far, set(kInfinity))));
    for (const V l : {line.near, line.far}) add(out, good, hn::Add(s0, hn::Mul(l, set(ds))));
  }

  void silhouette(const SectionRays& r, Stretch& out) const {
    const V k0 = hn::Add(set(p_.r0), hn::Mul(set(p_.slope), hn::Sub(r.z, set(p_.z0))));
    const double alpha = p_.slope * p_.slope * p_.oz * p_.mo - p_.tilt * p_.m1;
    const double beta = p_.m1 * p_.m1 + p_.m2 * p_.m2 - p_.slope * p_.slope * p_.mo * p_.mo;
    const double norm = std::hypot(alpha, beta);
    if (norm < 1e-14) return;
    const V gamma = dot(k0, p_.slope * p_.mo, r.x, -p_.m1, r.y, -p_.m2);
    const double ds = beta / norm, dt = -alpha / norm;
    const V s0 = hn::Mul(gamma, set(-alpha / (norm * norm))), t0 = hn::Mul(gamma, set(-beta / (norm * norm)));
    const V a = hn::Add(r.x, hn::Sub(hn::Mul(s0, set(p_.tilt)), hn::Mul(t0, set(p_.m1))));
    const V b = less(r.y, t0, p_.m2);
    const V k = hn::Add(k0, hn::Mul(set(p_.slope), hn::Sub(hn::Mul(s0, set(p_.oz)), hn::Mul(t0, set(p_.mo)))));
    const double da = ds * p_.tilt - dt * p_.m1, db = -dt * p_.m2, dk = p_.slope * (p_.oz * ds - p_.mo * dt);
    double q2 = da * da + db * db - dk * dk;
    V q1 = dot(a, da, b, db, k, -dk);
    V q0 = hn::Sub(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(k, k));
    if (q2 < 0) q2 = -q2, q1 = hn::Neg(q1), q0 = hn::Neg(q0);
    const Stretch roots = at_most_zero(q2, 1 / q2, q1, q0, SweptShape::kTangent);
    const M real = hn::Le(roots.near, roots.far);
    for (const V l : {roots.near, roots.far}) {
      const V s = hn::Add(s0, hn::Mul(l, set(ds))), t = hn::Add(t0, hn::Mul(l, set(dt)));
      const V z = less(hn::Add(r.z, hn::Mul(s, set(p_.oz))), t, p_.mo);
      add(out, both(real, both(on_way(t), on_side(z))), s);
    }
  }

  const SweptShape& p_;
};

/// One ray after the other, for bodies or rays that the lanes do not solve.
inline Stretch scalar_lanes(RayWindow& w, double u, const Group& g) {
  double v[kLanes], near[kLanes], far[kLanes];
  hn::StoreU(g.v, kD, v);
  const unsigned active = bits(g.active);
  for (int k = 0; k < lanes(); ++k) {
    near[k] = kInfinity, far[k] = -kInfinity;
    if (active >> k & 1U && !w.exact(w.self, u, v[k], near[k], far[k])) near[k] = kInfinity, far[k] = -kInfinity;
  }
  return {hn::LoadU(kD, near), hn::LoadU(kD, far)};
}

/// Torus or barrel, whole: from the box about it, itself swept. Ends above the material need not be exact.
inline Stretch round_lanes(RayWindow& w, double u, Group g, const SweptShape& shape, const StraightLanes& box) {
  const SectionRays rays = box.rays(u, g.v);
  const StraightRound round(shape, rays);
  const V tip = set(shape.tip[2]);
  Stretch at = box.frustum(rays);
  const M mask = both(g.active, hn::Lt(at.near, at.far));
  if (none(mask)) return nothing();
  M lost_near, lost_far = no_lane();
  M hit = round.end(mask, 1, at.near, lost_near);
  // Where the top of the material lies in the body, its far end does not matter.
  const V top = hn::Sub(g.far, tip);
  const M rest = without(hit, both(hn::Lt(top, at.far), round.holds(top)));
  if (!none(rest)) hit = either(without(hit, rest), round.end(rest, -1, at.far, lost_far));
  w.hits += hn::CountTrue(kD, mask);
  Stretch out = where(hit, {hn::Add(at.near, tip), hn::Add(at.far, tip)});
  g.active = either(lost_near, lost_far);
  if (none(g.active)) return out;
  const Stretch exact = scalar_lanes(w, u, g);
  return {pick(g.active, exact.near, out.near), pick(g.active, exact.far, out.far)};
}

/// The cylinder about a whole Round.
inline SweptShape box_of(const SweptShape& round) {
  SweptShape box = round;
  box.kind = SweptShape::Kind::Frustum;
  box.z0 = round.zc - round.r, box.z1 = round.zc + round.r, box.r0 = box.r1 = round.e + round.r, box.slope = 0;
  return box;
}

inline void cut_straight_lanes(const SweptShape& shape, RayWindow& w) {
  const StraightLanes body(shape);
  const SweptShape around = box_of(shape);
  const StraightLanes box(around);
  const bool whole = !shape.cut_bottom && !shape.cut_top;
  const V tip = set(shape.tip[2]), time = set(w.time);
  for_groups(w, [&](double u, Group& g) {
    Stretch cut;
    if (shape.kind == SweptShape::Kind::Torus) {
      cut = whole ? round_lanes(w, u, g, shape, box) : scalar_lanes(w, u, g);
    } else {
      w.hits += hn::CountTrue(kD, g.active);
      const SectionRays rays = body.rays(u, g.v);
      cut = shape.kind == SweptShape::Kind::Ball ? body.ball(rays) : body.frustum(rays);
      cut = {hn::Add(cut.near, tip), hn::Add(cut.far, tip)};
    }
    subtract(w, u, g, g.active, cut, time, time);
  });
}

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
