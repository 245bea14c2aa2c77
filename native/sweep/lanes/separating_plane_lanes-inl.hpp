// Separating planes between a convex group of pieces and rays that miss it.
#if defined(RIFFLER_SWEEP_BESIDE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_BESIDE_LANES_INL_HPP
#undef RIFFLER_SWEEP_BESIDE_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_BESIDE_LANES_INL_HPP
#endif

#include "sweep/lanes/pose_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

class SeparatingPlaneLanes : private AxisView {
 public:
  using AxisView::AxisView;

  /// For rays that miss the group: a direction perpendicular to the ray that separates them, and the ray's height over
  /// the plane. The direction is that of the piece next to the point where the ray passes the axis; for conical flanks,
  /// the best of all pieces.
  V3 find(M missed, V& height) const {
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
    // Rarely, a direction is too inaccurate to show that the ray misses.
    for (int i = 0; i < 3 && !none(both(missed, hn::Le(height, zero()))); ++i)
      steer(both(missed, hn::Le(height, zero())), n, height);
    if (const M lost = both(missed, hn::Le(height, zero())); !none(lost)) search(lost, n, height);
    return n;
  }

 private:
  /// Height of the rays at s = 0 over the supporting plane with unit normal n.
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

  /// Distance to the disc that a Round thickens (for e < 0, to the circle beyond the axis), minus the thickness.
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

  /// Rotates n, perpendicular to the ray, towards the maximum of the height over its plane: one step of Newton's method
  /// on the angle. With p the point where the plane touches the group and r the radius of curvature of the group's
  /// outline there, the height H changes with the angle as H′ = n′ · (ray − p), H″ = −(H + r).
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
    // n′ · p: the thickness is along n; the disc's point is along n minus its part along the axis.
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

  /// Searches for the direction perpendicular to the ray with the greatest height: all around, then by golden section.
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
    V low = set(-0.42), high = set(0.42);  // beyond the directions of the neighbours
    for (int i = 0; i < 40; ++i) {
      const V part = hn::Mul(golden, hn::Sub(high, low)), a = hn::Sub(high, part), b = hn::Add(low, part);
      const M left = hn::Gt(above(at(a)), above(at(b)));
      high = pick(left, b, high), low = pick(left, low, a);
    }
    better(at(hn::Mul(set(0.5), hn::Add(low, high))));
  }

  /// `at` moved to the part of the ray between two heights above the tip.
  V clamped(V at, double low, double high) const {
    const RayIntervals flat = slab(low, high);
    return pick(hn::Gt(flat.near, flat.far), at, max(flat.near, min(flat.far, at)));
  }

  /// The combination of the axis and the radial direction at s that is perpendicular to the ray: the normal of a rim's
  /// outline as seen along the ray.
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
    // A level ray may pass above or below.
    const M high = both(level, hn::Gt(z_, set(s.z1))), low = both(level, hn::Lt(z_, set(s.z0)));
    return choose(high, o_, choose(low, scaled(o_, set(-1)), n));
  }

  /// Direction away from the ball's centre.
  V3 beside_ball(const PieceShape& s) const {
    const V3 c = less(w_, set(s.zc), o_);
    return unit({c.x, c.y, zero()});
  }

  /// The direction of least distance from the disc, made perpendicular to the ray.
  V3 beside_round(const PieceShape& s, V closest, M mask) const {
    if (s.e == 0) return beside_ball(s);
    V at = clamped(closest, std::max(s.z0, s.zc - s.r), std::min(s.z1, s.zc + s.r));
    RayIntervals bracket{set(-kInfinity), set(kInfinity)};
    for (int i = 0; i < kMaxSteps; ++i) {
      // Newton's method on the squared distance, which is convex. Over the disc itself its normal is exact.
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
};

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
