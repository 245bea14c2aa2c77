// Ends of a torus or a barrel on a straight way, for many rays at a time.
//
// The distance D(s, τ) from a point of the section to the disc (for a barrel, to a circle beyond the axis) is convex in
// both, and so is its square F. A point with F = r², ∂F/∂τ = 0 (or at an end of the way, with the slope outwards) and
// ∂F/∂s < 0 *is* the near end, however it was found (the conditions of Karush, Kuhn and Tucker); and where a tangent
// plane of F stays above r² for all heights and ways, there is none. Both are tested at every step of a search that
// puts a quadratic in place of F: exact for a ball, and for any round whose axis is along the ray.
#if defined(RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#undef RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#else
#define RIFFLER_SWEEP_STRAIGHT_ROUND_INL_HPP
#endif

#include "sweep/cut_lanes-inl.hpp"
#include "sweep/straight_part.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::HWY_NAMESPACE {

class StraightRound {
 public:
  StraightRound(const StraightBody& body, const SweptShape& piece, const SectionRays& rays)
      : b_(body), p_(piece), r_(rays), size_(std::abs(piece.e) + piece.r) {}

  /// Finds the near (sign 1) or far (−1) end at `s` and `way` in lanes of `mask`; returns those that have one. Lanes
  /// that do not meet the round between the heights `low` and `high` may count as having none.
  M end(M mask, double sign, V low, V high, V& s, V& way) const {
    start(sign, s, way);
    M open = mask, hit = no_lane();
    for (int i = 0; i < kSteps && !none(open); ++i) {
      const Gap g = gap(s, way);
      const M arrived = both(open, settled(g, way, sign));
      hit = either(hit, arrived), open = without(open, arrived);
      if (none(open)) return hit;
      open = without(open, misses(g, s, way, low, high));
      step(g, open, sign, s, way);
    }
    if (!none(open)) hit = either(hit, search(open, sign, s, way));
    return hit;
  }

  /// Lanes whose point at s lies in the piece when the tool is at `way`.
  M holds(V s, V way) const {
    const Point p = point(s, way);
    const V out = max(hn::Sub(p.rho, set(p_.e)), zero());
    const M in = hn::Le(hn::Add(hn::Mul(out, out), hn::Mul(p.z, p.z)), set(p_.r * p_.r));
    return p_.cut0 || p_.cut1 ? both(in, on_side(s, way)) : in;
  }

  /// Lanes whose point is at heights that the piece has.
  M on_side(V s, V way) const {
    const V z = hn::Sub(hn::Add(r_.z, hn::Mul(s, set(b_.oz))), hn::Mul(way, set(b_.mo)));
    return both(hn::Ge(z, set(p_.low)), hn::Le(z, set(p_.high)));
  }

 private:
  static constexpr int kSteps = 16;
  struct Point {
    V a, b, z, rho;  // from the centre
  };
  struct Gap {
    V f;                               // F − r²
    V along, across;                   // ½ ∂F/∂s, ½ ∂F/∂τ
    V along_bend, across_bend, mixed;  // ½ ∂²F/∂s², ½ ∂²F/∂τ², ½ ∂²F/∂s∂τ
  };

  Point point(V s, V way) const {
    Point p;
    p.a = hn::Sub(hn::Add(r_.x, hn::Mul(s, set(b_.tilt))), hn::Mul(way, set(b_.m1)));
    p.b = hn::Sub(r_.y, hn::Mul(way, set(b_.m2)));
    p.z = hn::Sub(hn::Add(hn::Sub(r_.z, set(p_.zc)), hn::Mul(s, set(b_.oz))), hn::Mul(way, set(b_.mo)));
    p.rho = sqrt(hn::Add(hn::Mul(p.a, p.a), hn::Mul(p.b, p.b)));
    return p;
  }

  Gap gap(V s, V way) const {
    const Point p = point(s, way);
    const V per_rho = hn::Div(set(1), max(p.rho, set(1e-150)));
    const V out = max(hn::Sub(p.rho, set(p_.e)), zero());
    const V rho_s = hn::Mul(hn::Mul(p.a, set(b_.tilt)), per_rho);
    const V rho_t = hn::Neg(hn::Mul(hn::Add(hn::Mul(p.a, set(b_.m1)), hn::Mul(p.b, set(b_.m2))), per_rho));
    const V share = hn::Mul(out, per_rho);
    const M beside = hn::Gt(out, zero());
    // ρ_i ρ_j + out ρ_ij beside the disc, and what the height adds.
    const auto bend = [&](V i, V j, double plane, double height) {
      const V product = hn::Mul(i, j);
      const V aside = hn::Add(product, hn::Mul(share, hn::Sub(set(plane), product)));
      return hn::Add(set(height), hn::IfThenElseZero(beside, aside));
    };
    Gap g;
    g.f = hn::Sub(hn::Add(hn::Mul(out, out), hn::Mul(p.z, p.z)), set(p_.r * p_.r));
    g.along = hn::Add(hn::Mul(out, rho_s), hn::Mul(p.z, set(b_.oz)));
    g.across = hn::Sub(hn::Mul(out, rho_t), hn::Mul(p.z, set(b_.mo)));
    g.along_bend = bend(rho_s, rho_s, b_.tilt * b_.tilt, b_.oz * b_.oz);
    g.across_bend = bend(rho_t, rho_t, b_.m1 * b_.m1 + b_.m2 * b_.m2, b_.mo * b_.mo);
    g.mixed = bend(rho_s, rho_t, -b_.tilt * b_.m1, -b_.oz * b_.mo);
    return g;
  }

  V on_way(V way) const { return min(max(way, zero()), set(b_.way)); }

  /// Over the disc, its flat face; elsewhere a point at the height of that face.
  void start(double sign, V& s, V& way) const {
    const double steep = 0.3;
    way = set(0.5 * b_.way);
    if (sign * b_.oz > steep || sign * b_.oz < -steep) {
      const bool below = sign * b_.oz > 0;
      const double level = below ? std::max(p_.z0, p_.zc - p_.r) : std::min(p_.z1, p_.zc + p_.r);
      // The end of the way at which the face is furthest out.
      const double first = (below ? b_.mo < 0 : b_.mo > 0) ? b_.way : 0;
      const auto crossing = [&](V t) {
        return hn::Mul(hn::Add(hn::Sub(set(level), r_.z), hn::Mul(t, set(b_.mo))), set(1 / b_.oz));
      };
      const auto aside = [&](V at, V t, V& a, V& b) {
        a = hn::Sub(hn::Add(r_.x, hn::Mul(at, set(b_.tilt))), hn::Mul(t, set(b_.m1)));
        b = hn::Sub(r_.y, hn::Mul(t, set(b_.m2)));
      };
      const V t = set(first), at = crossing(t);
      V a, b;
      aside(at, t, a, b);
      const double level_way = b_.m1 * b_.m1 + b_.m2 * b_.m2;
      const V ahead = hn::Add(hn::Mul(a, set(b_.m1)), hn::Mul(b, set(b_.m2)));
      const V beside = on_way(hn::Add(t, hn::Mul(ahead, set(level_way > 1e-12 ? 1 / level_way : 0))));
      const M over = hn::Le(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), set(p_.e > 0 ? p_.e * p_.e : 0));
      way = pick(over, t, beside);
      s = pick(over, at, crossing(way));
      return;
    }
    // Nearest to the centre.
    const V x = hn::Sub(r_.x, hn::Mul(way, set(b_.m1)));
    const V z = hn::Sub(hn::Sub(r_.z, set(p_.zc)), hn::Mul(way, set(b_.mo)));
    s = hn::Neg(hn::Add(hn::Mul(x, set(b_.tilt)), hn::Mul(z, set(b_.oz))));
  }

  /// On the surface, and there the first or the last point of the section.
  M settled(const Gap& g, V way, double sign) const {
    const double exact = 1e-12 * size_ + 1e-15 * b_.way;
    const V small = set(1e-7 * size_ * p_.r);
    const M first = both(hn::Le(way, zero()), hn::Ge(g.across, hn::Neg(small)));
    const M last = both(hn::Ge(way, set(b_.way)), hn::Le(g.across, small));
    const M still = either(hn::Le(abs(g.across), small), either(first, last));
    return both(both(hn::Le(abs(g.f), set(2 * p_.r * exact)), still), hn::Lt(hn::Mul(set(sign), g.along), zero()));
  }

  /// The tangent plane of F says that the round is nowhere on the way at these heights.
  M misses(const Gap& g, V s, V way, V low, V high) const {
    const V up = min(hn::Mul(g.along, hn::Sub(low, s)), hn::Mul(g.along, hn::Sub(high, s)));
    const V on = min(hn::Neg(hn::Mul(g.across, way)), hn::Mul(g.across, hn::Sub(set(b_.way), way)));
    return hn::Ge(hn::Add(hn::Mul(set(0.5), g.f), hn::Add(up, on)), zero());
  }

  /// To the end of the quadratic with the same derivatives, or to its lowest point where it has none.
  void step(const Gap& g, M open, double sign, V& s, V& way) const {
    // Free along the way, unless it ends there and the slope is outwards.
    const M stuck = either(both(hn::Le(way, zero()), hn::Ge(g.across, zero())),
                           both(hn::Ge(way, set(b_.way)), hn::Le(g.across, zero())));
    const V per_bend = hn::Div(set(1), max(g.across_bend, set(1e-12)));
    const V lean = hn::IfThenZeroElse(stuck, hn::Mul(g.mixed, per_bend));
    const V pull = hn::IfThenZeroElse(stuck, hn::Mul(g.across, per_bend));
    const V a = max(hn::Sub(g.along_bend, hn::Mul(lean, g.mixed)), set(1e-12));
    const V b = hn::Mul(set(sign), hn::Sub(g.along, hn::Mul(pull, g.mixed)));
    const V c = hn::Sub(g.f, hn::Mul(pull, g.across));
    const V disc = max(hn::Sub(hn::Mul(b, b), hn::Mul(a, c)), zero());
    const V root = sqrt(disc);
    const M falls = both(hn::Lt(b, zero()), hn::Gt(disc, zero()));
    const V top = pick(falls, c, hn::Neg(hn::Add(b, root))), bottom = pick(falls, hn::Sub(root, b), a);
    const V reach = set(2 * size_);
    const V move = hn::Mul(set(sign), min(max(hn::Div(top, bottom), hn::Neg(reach)), reach));
    s = pick(open, hn::Add(s, move), s);
    way = pick(without(open, stuck), on_way(hn::Sub(way, hn::Add(pull, hn::Mul(lean, move)))), way);
  }

  // ---- where that fails: slow and sure

  /// The way at which the piece comes nearest to the point at s: a root of a slope that never falls.
  V nearest(V s) const {
    V low = zero(), high = set(b_.way);
    for (int i = 0; i < 64; ++i) {
      const V middle = hn::Mul(set(0.5), hn::Add(low, high));
      const M past = hn::Gt(gap(s, middle).across, zero());
      high = pick(past, middle, high), low = pick(past, low, middle);
    }
    return low;
  }
  V least(V s) const { return gap(s, nearest(s)).f; }

  /// Narrows down the lowest point of the least F over the way, then halves towards the end.
  M search(M mask, double sign, V& s, V& way) const {
    const double reach = std::max(p_.e, 0.0) + p_.r, slack = 1e-9 * size_, golden = 0.6180339887498949;
    const double c0 = p_.zc * b_.oz, c1 = c0 + b_.way * (b_.m1 * b_.tilt + b_.mo * b_.oz);
    const double first = std::min(c0, c1) - reach - slack, last = std::max(c0, c1) + reach + slack;
    V low = set(first), high = set(last);
    for (int i = 0; i < 90; ++i) {
      const V part = hn::Mul(set(golden), hn::Sub(high, low)), a = hn::Sub(high, part), b = hn::Add(low, part);
      const M left = hn::Lt(least(a), least(b));
      high = pick(left, b, high), low = pick(left, low, a);
    }
    V in = hn::Mul(set(0.5), hn::Add(low, high)), out = set(sign > 0 ? first : last);
    const M hit = both(mask, hn::Lt(least(in), zero()));
    for (int i = 0; i < 64; ++i) {
      const V middle = hn::Mul(set(0.5), hn::Add(in, out));
      const M inside = hn::Le(least(middle), zero());
      in = pick(inside, middle, in), out = pick(inside, out, middle);
    }
    s = pick(mask, in, s), way = pick(mask, nearest(in), way);
    return hit;
  }

  const StraightBody& b_;
  const SweptShape& p_;
  const SectionRays& r_;
  double size_;
};

}  // namespace riffler::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
