// A convex group of pieces at poses of its motion, a pose of its own for every lane: where the rays meet it, the
// normals there, and planes between it and rays that it misses.
#if defined(RIFFLER_SWEEP_POSE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_POSE_LANES_INL_HPP
#undef RIFFLER_SWEEP_POSE_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_POSE_LANES_INL_HPP
#endif

#include "sweep/cut_lanes-inl.hpp"
#include "sweep/turning_part.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

struct V3 {
  V x, y, z;
};

HWY_INLINE V dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V dot(const V3& a, const double* b) {
  return hn::Add(hn::Add(hn::Mul(a.x, set(b[0])), hn::Mul(a.y, set(b[1]))), hn::Mul(a.z, set(b[2])));
}
/// a × b
HWY_INLINE V3 cross(const V3& a, const double* b) {
  const V x = set(b[0]), y = set(b[1]), z = set(b[2]);
  return {hn::Sub(hn::Mul(a.y, z), hn::Mul(a.z, y)), hn::Sub(hn::Mul(a.z, x), hn::Mul(a.x, z)),
          hn::Sub(hn::Mul(a.x, y), hn::Mul(a.y, x))};
}
HWY_INLINE V3 scaled(const V3& a, V f) {
  return {hn::Mul(a.x, f), hn::Mul(a.y, f), hn::Mul(a.z, f)};
}
/// a − f b
HWY_INLINE V3 less(const V3& a, V f, const V3& b) {
  return {hn::Sub(a.x, hn::Mul(f, b.x)), hn::Sub(a.y, hn::Mul(f, b.y)), hn::Sub(a.z, hn::Mul(f, b.z))};
}
HWY_INLINE V3 choose(M m, const V3& yes, const V3& no) {
  return {pick(m, yes.x, no.x), pick(m, yes.y, no.y), pick(m, yes.z, no.z)};
}
/// One long; (1, 0, 0) where `a` is zero.
HWY_INLINE V3 unit(const V3& a) {
  const V square = dot(a, a);
  const M good = hn::Gt(square, set(1e-300));
  const V scale = hn::Div(set(1), sqrt(pick(good, square, set(1))));
  return choose(good, scaled(a, scale), {set(1), zero(), zero()});
}

class PoseLanes {
 public:
  /// The rays (u, v) and the poses at `t`.
  PoseLanes(const TurningBody& body, V u, V v, V t) : b_(body) {
    const V turn = hn::Mul(set(body.angle), hn::Sub(t, set(body.middle)));
    // |turn| ≤ 1/8 (steps.cpp): the series end below 1e-16.
    const V q = hn::Mul(turn, turn);
    const V c = series(q, {1, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320});
    const V s = hn::Mul(turn, series(q, {1, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880}));
    const auto axis = [&](int i) { return hn::Add(hn::Mul(c, set(body.axis[i])), hn::Mul(s, set(body.side[i]))); };
    const auto tip = [&](int i) { return hn::Add(set(body.tip[i]), hn::Mul(t, set(body.way[i]))); };
    o_ = {axis(0), axis(1), axis(2)};
    w_ = {hn::Sub(u, tip(0)), hn::Sub(v, tip(1)), hn::Neg(tip(2))};
    // Height over the tip z + s oz; squared distance from the axis a s² + 2 b s + c. `a` and `b` without cancellation
    // where the axis is along the ray.
    z_ = dot(w_, o_);
    a_ = hn::Add(hn::Mul(o_.x, o_.x), hn::Mul(o_.y, o_.y));
    const V across = hn::Add(hn::Mul(w_.x, o_.x), hn::Mul(w_.y, o_.y));
    b1_ = hn::Sub(hn::Mul(w_.z, a_), hn::Mul(o_.z, across));
    const V3 radial = less(w_, z_, o_);
    c_ = dot(radial, radial);
  }

  /// From the tip to the rays' points at s = 0.
  const V3& from_tip() const { return w_; }
  const Stretch& stretch() const { return out_; }

  /// Returns the lanes that meet the group. A far end above `high` need not be exact.
  M find(M active, V high) {
    out_ = nothing();
    near_from_ = far_from_ = zero();
    per_oz_ = hn::Div(set(1), pick(hn::Gt(abs(o_.z), set(kLevel)), o_.z, set(1)));
    for (std::size_t k = b_.count; k-- > 0;) {  // the upper pieces are simple and often make `far` known
      const PieceShape& s = b_.pieces[k];
      if (!s.round)
        frustum(s, k);
      else if (s.ball)
        ball(s, k);
      else
        round(s, k, active, high);
    }
    return both(active, hn::Lt(out_.near, out_.far));
  }

  /// Normals where the rays enter and leave.
  V3 near(M hit) const { return normal(hit, out_.near, near_from_, set(-1)); }
  V3 far(M hit) const { return normal(hit, out_.far, far_from_, set(1)); }

  /// Height of the rays' points at s = 0 over the plane with unit normal n that touches the group.
  V above(const V3& n) const {
    const V rise = dot(n, o_), across = sqrt(max(hn::Sub(set(1), hn::Mul(rise, rise)), zero()));
    V most = set(-kInfinity);
    for (std::size_t k = 0; k < b_.count; ++k) {
      const PieceShape& s = b_.pieces[k];
      const V low = hn::Add(hn::Mul(rise, set(s.z0)), hn::Mul(across, set(s.r0)));
      const V high = hn::Add(hn::Mul(rise, set(s.z1)), hn::Mul(across, set(s.r1)));
      V reach = max(low, high);
      if (s.ball) {
        reach = hn::Add(hn::Mul(rise, set(s.zc)), set(s.r));
      } else if (s.round) {
        const V at = hn::Mul(rise, set(s.r));
        const V arc = hn::Add(hn::Add(hn::Mul(rise, set(s.zc)), hn::Mul(across, set(s.e))), set(s.r));
        reach = pick(hn::Gt(at, set(s.z1 - s.zc)), high, pick(hn::Lt(at, set(s.z0 - s.zc)), low, arc));
      }
      most = max(most, reach);
    }
    return hn::Sub(dot(n, w_), most);
  }

  /// Where rays miss the group: a direction in which they do, square to the ray, and how far out they are in it. It is
  /// that of the piece beside which the ray passes the axis; on flanks that lean, the best of all pieces.
  V3 between(M missed, V& height) const {
    const M along = hn::Lt(a_, set(1e-24));
    const V at = pick(along, zero(), hn::Neg(hn::Div(b1_, pick(along, set(1), a_))));
    const V passes = z_at(at);
    V3 n{set(1), zero(), zero()};
    for (std::size_t k = 0; k < b_.count; ++k) {
      const PieceShape& s = b_.pieces[k];
      const M mine = k == 0 ? missed : both(missed, hn::Ge(passes, set(s.z0)));
      if (none(mine) && !b_.leans) break;
      const V3 own = s.ball    ? beside_ball(s)
                     : s.round ? beside_round(s, at, mine)
                               : beside_frustum(s, at, along, missed);
      if (!b_.leans) {
        n = choose(mine, own, n);
        continue;
      }
      const V out = above(own);
      const M better = k == 0 ? missed : both(missed, hn::Gt(out, height));
      n = choose(better, own, n), height = k == 0 ? out : pick(better, out, height);
    }
    if (!b_.leans) height = above(n);
    // Rarely, a direction is not good enough to tell that the ray misses.
    for (int i = 0; i < 3 && !none(both(missed, hn::Le(height, zero()))); ++i)
      steer(both(missed, hn::Le(height, zero())), n, height);
    if (const M lost = both(missed, hn::Le(height, zero())); !none(lost)) search(lost, n, height);
    return n;
  }

 private:
  static constexpr double kFace = 64;      // in place of a piece's number: the flat end through which the ray comes
  static constexpr double kLevel = 1e-12;  // the axis counts as square to the rays: a piece that a ray meets there is
                                           // met a moment before and after as well
  static constexpr int kMostSteps = 24;
  static constexpr double kArrived = 1e-13;  // of the size: where Newton's method has arrived

  static V series(V q, const double (&k)[5]) {
    V sum = set(k[4]);
    for (int i = 3; i >= 0; --i) sum = hn::Add(hn::Mul(sum, q), set(k[i]));
    return sum;
  }
  V z_at(V s) const { return hn::Add(z_, hn::Mul(s, o_.z)); }
  V3 point(V s) const { return {w_.x, w_.y, hn::Add(w_.z, s)}; }
  /// From the axis, square to it, to the point at s.
  V3 radial(V s) const { return less(point(s), z_at(s), o_); }

  void add(M hit, Stretch s, V near_from, V far_from) {
    const M lower = both(hit, hn::Lt(s.near, out_.near)), higher = both(hit, hn::Gt(s.far, out_.far));
    out_.near = pick(lower, s.near, out_.near), near_from_ = pick(lower, near_from, near_from_);
    out_.far = pick(higher, s.far, out_.far), far_from_ = pick(higher, far_from, far_from_);
  }

  /// `sign`: −1 where rays enter, 1 where they leave.
  V3 normal(M hit, V at, V from, V sign) const {
    V3 n = scaled(o_, with_sign(set(1), hn::Mul(sign, o_.z)));
    for (std::size_t k = 0; k < b_.count; ++k) {
      const M mine = both(hit, hn::Eq(from, set(static_cast<double>(k))));
      if (none(mine)) continue;
      const PieceShape& s = b_.pieces[k];
      n = choose(mine, s.ball ? from_centre(s, at) : s.round ? from_disc(s, gap(s, at), at) : flank(s, at), n);
    }
    return n;
  }

  /// The ray between two heights over the tip; where it is level, all or nothing.
  Stretch slab(double low, double high) const {
    const V a = hn::Mul(hn::Sub(set(low), z_), per_oz_), b = hn::Mul(hn::Sub(set(high), z_), per_oz_);
    const Stretch out{min(a, b), max(a, b)};
    const M level = hn::Le(abs(o_.z), set(kLevel));
    if (none(level)) return out;
    const Stretch all = where(both(hn::Ge(z_, set(low)), hn::Le(z_, set(high))), everything());
    return {pick(level, all.near, out.near), pick(level, all.far, out.far)};
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

  void frustum(const PieceShape& s, std::size_t k) {
    V radius = set(s.r0), q1 = b1_, q2 = a_, grow = zero();
    if (s.slope != 0) {
      grow = hn::Mul(set(s.slope), o_.z);
      radius = hn::Add(radius, hn::Mul(set(s.slope), hn::Sub(z_, set(s.z0))));
      q1 = hn::Sub(q1, hn::Mul(radius, grow)), q2 = hn::Sub(q2, hn::Mul(grow, grow));
    }
    const Stretch round = inside(q2, q1, hn::Sub(c_, hn::Mul(radius, radius)), grow, s.slope != 0);
    const Stretch flat = slab(s.z0, s.z1);
    const Stretch at = common(round, flat);
    const M hit = both(hn::Lt(at.near, at.far), both(hn::Gt(at.near, set(-kInfinity)), hn::Lt(at.far, set(kInfinity))));
    if (none(hit)) return;
    // A flat end within the group is no surface of it: where a ray comes through its edge, the flank counts.
    const V own = set(static_cast<double>(k)), face = set(kFace);
    const M up = hn::Gt(o_.z, zero());
    const M near_inner = s.inner0 ? (s.inner1 ? either(up, hn::Not(up)) : up) : (s.inner1 ? hn::Not(up) : no_lane());
    const M far_inner = s.inner1 ? (s.inner0 ? either(up, hn::Not(up)) : up) : (s.inner0 ? hn::Not(up) : no_lane());
    add(hit, at, pick(either(near_inner, hn::Gt(round.near, flat.near)), own, face),
        pick(either(far_inner, hn::Lt(round.far, flat.far)), own, face));
  }

  V3 flank(const PieceShape& s, V at) const {
    const V3 out = radial(at);
    if (s.slope == 0) return scaled(out, set(s.inverse));
    const V3 n = unit(out);
    const V lean = set(s.slope * s.cosine), cosine = set(s.cosine);
    return less(scaled(n, cosine), lean, o_);
  }

  V3 from_centre(const PieceShape& s, V at) const { return scaled(less(point(at), set(s.zc), o_), set(s.inverse)); }

  void ball(const PieceShape& s, std::size_t k) {
    const V3 c = less(w_, set(s.zc), o_);
    const V square = hn::Add(hn::Mul(c.x, c.x), hn::Mul(c.y, c.y)), disc = hn::Sub(set(s.r * s.r), square);
    const M hit = hn::Gt(disc, zero());
    if (none(hit)) return;
    const V root = sqrt(max(disc, zero())), own = set(static_cast<double>(k));
    add(hit, {hn::Neg(hn::Add(c.z, root)), hn::Sub(root, c.z)}, own, own);
  }

  /// Distance to the disc (or, for e < 0, to the circle beyond the axis) that a Round thickens, less its thickness.
  struct Gap {
    V out, rho, z, d, gap, rate;
  };
  Gap gap(const PieceShape& s, V at) const {
    Gap g;
    const V3 r = radial(at);
    g.z = hn::Sub(z_at(at), set(s.zc));
    g.rho = sqrt(dot(r, r));
    g.out = max(hn::Sub(g.rho, set(s.e)), zero());
    g.d = sqrt(hn::Add(hn::Mul(g.out, g.out), hn::Mul(g.z, g.z)));
    const V rho = max(g.rho, set(1e-150)), d = max(g.d, set(1e-150));
    g.gap = hn::Sub(g.d, set(s.r));
    g.rate = hn::Div(hn::Add(hn::Div(hn::Mul(g.out, r.z), rho), hn::Mul(g.z, o_.z)), d);
    return g;
  }
  V3 from_disc(const PieceShape&, const Gap& g, V at) const {
    const V rho = max(g.rho, set(1e-150)), d = max(g.d, set(1e-150));
    return less(scaled(radial(at), hn::Div(g.out, hn::Mul(rho, d))), hn::Neg(hn::Div(g.z, d)), o_);
  }

  /// The squared distance from the disc is convex along the ray, so Newton's method from outside walks to the root
  /// without passing it. Starts where the ray enters the cylinder and slab about the piece. `sign` 1: near end, −1: far
  /// end. `flat`: lanes that are deep inside at once, so that it is the slab's own plane through which they come.
  M walk(const PieceShape& s, M mask, double sign, V& at, V until, M& flat) const {
    M hit = no_lane(), open = mask;
    flat = no_lane();
    const double size = std::abs(s.e) + s.r;
    const V arrives = set(kArrived * size * s.r), deep = set(-2e-9 * s.r * s.r);
    for (int i = 0; i < kMostSteps && !none(open); ++i) {
      const V3 r = radial(at);
      const V z = hn::Sub(z_at(at), set(s.zc)), rho = max(sqrt(dot(r, r)), set(1e-150));
      const V out = max(hn::Sub(rho, set(s.e)), zero());
      const V over = hn::Sub(hn::Add(hn::Mul(out, out), hn::Mul(z, z)), set(s.r * s.r));
      const V slope = hn::Add(hn::Div(hn::Mul(out, r.z), rho), hn::Mul(z, o_.z));  // half the derivative
      const M arrived = both(open, hn::Le(over, arrives));
      if (i == 0) flat = both(arrived, hn::Lt(over, deep));
      hit = either(hit, arrived);
      open = both(without(open, arrived), hn::Lt(hn::Mul(slope, set(sign)), zero()));
      at = pick(open, hn::Sub(at, hn::Div(hn::Mul(set(0.5), over), pick(open, slope, set(1)))), at);
      open = both(open, hn::Le(hn::Mul(set(sign), hn::Sub(at, until)), zero()));
    }
    return hit;
  }

  void round(const PieceShape& s, std::size_t k, M active, V high) {
    const Stretch box = box_of(s);
    M mask = both(active, hn::Le(box.near, box.far));
    // What the pieces above cover already need not be found.
    mask = without(mask, both(hn::Le(out_.near, box.near), hn::Ge(out_.far, box.far)));
    if (none(mask)) return;
    Stretch at = box;
    M flat;
    const M hit = walk(s, mask, 1, at.near, box.far, flat);
    if (none(hit)) return;
    const V own = set(static_cast<double>(k)), face = set(kFace);
    const M up = hn::Gt(o_.z, zero());
    const M low_end = s.inner0 ? no_lane() : up, high_end = s.inner1 ? no_lane() : hn::Not(up);
    const V near_from = pick(both(flat, either(low_end, high_end)), face, own);
    V far_from = near_from;
    const M rest = both(hit, hn::Lt(out_.far, min(high, box.far)));
    at.far = pick(rest, box.far, at.near);
    if (!none(rest)) {
      const M found = walk(s, rest, -1, at.far, at.near, flat);
      at.far = pick(found, at.far, at.near);
      const M top = s.inner1 ? no_lane() : up, under = s.inner0 ? no_lane() : hn::Not(up);
      far_from = pick(both(flat, either(top, under)), face, own);
    }
    add(hit, at, near_from, far_from);
  }

  /// The ray inside of the slab and the cylinder about a Round.
  Stretch box_of(const PieceShape& s) const {
    const double most = s.e + s.r;
    const Stretch side = inside(a_, b1_, hn::Sub(c_, set(most * most)), zero(), false);
    return common(side, slab(std::max(s.z0, s.zc - s.r), std::min(s.z1, s.zc + s.r)));
  }

  /// Turns n, square to the ray, towards where the height over its plane is greatest: one step of Newton's method on
  /// the angle. With p the point of the group that the plane touches and r the radius of its outline's curvature there,
  /// the height H changes with the angle as H′ = n′ · (ray − p), H″ = −(H + r).
  void steer(M mask, V3& n, V& height) const {
    const V rise = dot(n, o_), across = sqrt(max(hn::Sub(set(1), hn::Mul(rise, rise)), set(1e-12)));
    V most = set(-kInfinity), z = zero(), rho = zero(), thick = zero();
    const auto offer = [&](V reach, V height_of, V radius, V round) {
      const M more = hn::Gt(reach, most);
      most = pick(more, reach, most), z = pick(more, height_of, z);
      rho = pick(more, radius, rho), thick = pick(more, round, thick);
    };
    for (std::size_t k = 0; k < b_.count; ++k) {
      const PieceShape& s = b_.pieces[k];
      const auto disc = [&](V at, V radius, V round) {
        offer(hn::Add(hn::Add(hn::Mul(rise, at), hn::Mul(across, radius)), round), at, radius, round);
      };
      if (!s.round) {
        disc(set(s.z0), set(s.r0), zero()), disc(set(s.z1), set(s.r1), zero());
        continue;
      }
      const V at = hn::Mul(rise, set(s.r));
      const M high = hn::Gt(at, set(s.z1 - s.zc)), low = hn::Lt(at, set(s.z0 - s.zc)), end = either(high, low);
      disc(pick(high, set(s.z1), pick(low, set(s.z0), set(s.zc))),
           pick(high, set(s.r1), pick(low, set(s.r0), set(s.e))), pick(end, zero(), set(s.r)));
    }
    const V3 tangent{hn::Neg(n.y), n.x, zero()};
    // n′ · p: the thickness is along n, the disc's point along n less its part along the axis.
    const V lean = dot(tangent, o_);
    const V point = hn::Sub(hn::Mul(z, lean), hn::Div(hn::Mul(hn::Mul(rho, rise), lean), across));
    const V bend = hn::Add(hn::Div(hn::Mul(rho, hn::Mul(o_.z, o_.z)), hn::Mul(hn::Mul(across, across), across)), thick);
    const V down = max(hn::Add(height, bend), hn::Mul(set(1e-3), hn::Add(rho, thick)));
    const V turn = hn::Div(hn::Sub(dot(tangent, w_), point), max(down, set(1e-12)));
    const V step = max(min(turn, set(0.5)), set(-0.5));
    const V3 next = unit({hn::Add(n.x, hn::Mul(step, tangent.x)), hn::Add(n.y, hn::Mul(step, tangent.y)), zero()});
    const V there = above(next);
    const M better = both(mask, hn::Gt(there, height));
    n = choose(better, next, n), height = pick(better, there, height);
  }

  /// Looks for the direction square to the ray in which its height is greatest: all round, then by golden section.
  void search(M mask, V3& n, V& height) const {
    const auto better = [&](const V3& other) {
      const V there = above(other);
      const M more = both(mask, hn::Gt(there, height));
      n = choose(more, other, n), height = pick(more, there, height);
    };
    constexpr double kDiagonal = 0.7071067811865476, kLong = 0.9238795325112867, kShort = 0.3826834323650898;
    for (const auto& [x, y] : {std::pair{1.0, 0.0}, {kLong, kShort}, {kDiagonal, kDiagonal}, {kShort, kLong}})
      for (const double sign : {-1.0, 1.0})
        better({set(sign * x), set(sign * y), zero()}), better({set(-sign * y), set(sign * x), zero()});
    const V3 middle = n, aside{hn::Neg(n.y), n.x, zero()};
    const auto at = [&](V x) {
      return unit({hn::Add(middle.x, hn::Mul(x, aside.x)), hn::Add(middle.y, hn::Mul(x, aside.y)), zero()});
    };
    const V golden = set(0.6180339887498949);
    V low = set(-0.42), high = set(0.42);  // beyond the neighbours' directions
    for (int i = 0; i < 40; ++i) {
      const V part = hn::Mul(golden, hn::Sub(high, low)), a = hn::Sub(high, part), b = hn::Add(low, part);
      const M left = hn::Gt(above(at(a)), above(at(b)));
      high = pick(left, b, high), low = pick(left, low, a);
    }
    better(at(hn::Mul(set(0.5), hn::Add(low, high))));
  }

  /// `at` moved to where the ray is between two heights over the tip.
  V clamped(V at, double low, double high) const {
    const Stretch flat = slab(low, high);
    return pick(hn::Gt(flat.near, flat.far), at, max(flat.near, min(flat.far, at)));
  }

  /// The combination of the radial direction at s and the axis that is square to the ray: the normal of a rim's outline
  /// as the ray sees it.
  V3 rim(V at) const {
    const V3 r = radial(at);
    return unit(scaled(less(scaled(r, o_.z), r.z, o_), o_.z));
  }

  V3 beside_frustum(const PieceShape& s, V closest, M along, M mask) const {
    V best = closest;
    if (s.slope != 0) {
      const V tilt = sqrt(pick(along, set(1), a_)), ratio = hn::Div(hn::Mul(set(s.slope), o_.z), tilt);
      const M gentle = hn::Lt(abs(ratio), set(1));
      const V rest = sqrt(max(hn::Sub(set(1), hn::Mul(ratio, ratio)), set(1e-30)));
      const V3 r = radial(closest);
      const V aside = sqrt(dot(r, r));
      best = pick(gentle, hn::Add(closest, hn::Div(hn::Mul(aside, ratio), hn::Mul(rest, tilt))),
                  with_sign(set(1e200), ratio));
    }
    const V at = pick(along, zero(), clamped(best, s.z0, s.z1));
    const M beside = without(hn::Eq(at, best), along);
    V3 n = rim(at);
    if (!none(both(mask, beside)))
      n = choose(beside, less(scaled(unit(radial(at)), set(s.cosine)), set(s.slope * s.cosine), o_), n);
    const M level = hn::Le(abs(o_.z), set(kLevel));
    if (none(level)) return n;
    // The ray runs level: it may pass above or below.
    const M high = both(level, hn::Gt(z_, set(s.z1))), low = both(level, hn::Lt(z_, set(s.z0)));
    return choose(high, o_, choose(low, scaled(o_, set(-1)), n));
  }

  /// Away from the centre.
  V3 beside_ball(const PieceShape& s) const {
    const V3 c = less(w_, set(s.zc), o_);
    return unit({c.x, c.y, zero()});
  }

  /// The direction of least distance from the disc, made square to the ray.
  V3 beside_round(const PieceShape& s, V closest, M mask) const {
    if (s.e == 0) return beside_ball(s);
    V at = clamped(closest, std::max(s.z0, s.zc - s.r), std::min(s.z1, s.zc + s.r));
    Stretch bracket{set(-kInfinity), set(kInfinity)};
    for (int i = 0; i < kMostSteps; ++i) {
      // Newton's method on the squared distance, which is convex; over the disc itself its normal is right.
      const Gap g = gap(s, at);
      const M open = both(mask, both(hn::Gt(g.out, zero()), hn::Gt(abs(g.rate), set(1e-7))));
      if (none(open)) break;
      const M past = hn::Gt(g.rate, zero());
      bracket.far = pick(past, at, bracket.far), bracket.near = pick(past, bracket.near, at);
      const V rho = max(g.rho, set(1e-150)), slope = hn::Div(radial(at).z, rho), square = hn::Mul(slope, slope);
      const V bend = hn::Add(hn::Add(square, hn::Mul(o_.z, o_.z)), hn::Mul(g.out, hn::Div(hn::Sub(a_, square), rho)));
      const V next = hn::Sub(at, hn::Div(hn::Mul(g.d, g.rate), max(bend, set(1e-12))));
      const M within = both(hn::Gt(next, bracket.near), hn::Lt(next, bracket.far));
      at = pick(open, pick(within, next, hn::Mul(set(0.5), hn::Add(bracket.near, bracket.far))), at);
    }
    V3 n = from_disc(s, gap(s, at), at);
    n.z = zero();
    return unit(n);
  }

  const TurningBody& b_;
  V3 o_, w_;
  V z_, a_, b1_, c_, per_oz_;
  Stretch out_;
  V near_from_, far_from_;  // which piece's side it is, or kFace
};

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
