// Tests of quick_reject.hpp, many rays at a time.
#if defined(RIFFLER_SWEEP_REJECT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_REJECT_LANES_INL_HPP
#undef RIFFLER_SWEEP_REJECT_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_REJECT_LANES_INL_HPP
#endif

#include "sweep/lanes/group_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// Distance of points at height s on the rays from a swept line or centre: its square, and its sign along the rays.
struct Aside {
  V square, along;
  V a, b;  // with `along`, the vector from the nearest position of the line or centre
};
HWY_INLINE Aside aside(const SweptLine& line, double u, V v, V s) {
  const V x = set(u - line.from[0]), y = hn::Sub(v, set(line.from[1])), z = hn::Sub(s, set(line.from[2]));
  const auto dot = [](V a, V b, V c, const double* d) {
    return hn::Add(hn::Add(hn::Mul(a, set(d[0])), hn::Mul(b, set(d[1]))), hn::Mul(c, set(d[2])));
  };
  const V t = min(max(hn::Mul(dot(x, y, z, line.way), set(line.per_square)), zero()), set(1));
  V rise = zero();
  if (line.endless) rise = dot(x, y, z, line.axis);
  const auto off = [&](V p, int i) {
    const V moved = hn::Sub(p, hn::Mul(t, set(line.way[i])));
    return line.endless ? hn::Sub(moved, hn::Mul(rise, set(line.axis[i]))) : moved;
  };
  const V a = off(x, 0), b = off(y, 1), c = off(z, 2);
  return {hn::Add(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(c, c)), c, a, b};
}

/// Lanes for which the quick reject shows that everything below s (kSide −1) or above it (1) is out of reach.
template <int kSide>
HWY_INLINE M outward(V along) {
  return kSide < 0 ? hn::Le(along, zero()) : hn::Ge(along, zero());
}
template <int kSide, bool kFlank>
HWY_INLINE M off_ball(const QuickReject& look, double u, V v, V s) {
  const Aside p = aside(look.centre, u, v, s);
  const M out = both(hn::Ge(p.square, set(look.centre.square)), outward<kSide>(p.along));
  if (!kFlank) return out;
  const double* axis = look.centre.axis;
  const V rise =
      hn::Add(hn::Add(hn::Mul(p.a, set(axis[0])), hn::Mul(p.b, set(axis[1]))), hn::Mul(p.along, set(axis[2])));
  return both(out,
              both(hn::Le(rise, zero()), hn::Ge(hn::Mul(rise, rise), hn::Mul(p.square, set(look.lean * look.lean)))));
}
template <int kSide>
HWY_INLINE M off_tube(const QuickReject& look, double u, V v, V s) {
  const Aside p = aside(look.tube, u, v, s);
  return both(hn::Ge(p.square, set(look.tube.square)), outward<kSide>(p.along));
}
HWY_INLINE M under_planes(const QuickReject& look, double u, V v, V s) {
  V most = set(-kInfinity);
  for (int k = 0; k < 2; ++k) {
    const double* foot = look.foot[k];
    const double* n = look.normal[k];
    const V z = hn::Sub(s, set(foot[2]));
    const V h = hn::Add(hn::Add(set((u - foot[0]) * n[0]), hn::Mul(hn::Sub(v, set(foot[1])), set(n[1]))),
                        hn::Mul(z, set(n[2])));
    most = max(most, hn::Add(h, hn::Mul(abs(z), set(look.per_depth))));
  }
  return hn::Lt(most, set(-look.slack));
}

/// Both tests of one kind of quick reject, and the tube where there is one.
template <QuickReject::Kind kKind>
struct Look {
  const QuickReject& look;

  /// Lanes of `mask` whose material on one side of s is out of reach.
  template <int kSide>
  HWY_INLINE M out(double u, V v, V s, M mask) const {
    M m = no_lane();
    if constexpr (kKind == QuickReject::Kind::Ball)
      m = kSide < 0 || look.alone ? off_ball<kSide, false>(look, u, v, s) : off_ball<kSide, true>(look, u, v, s);
    if constexpr (kKind == QuickReject::Kind::BallAndFlank) m = off_ball<kSide, true>(look, u, v, s);
    if constexpr (kKind == QuickReject::Kind::Planes && kSide < 0) m = under_planes(look, u, v, s);
    return look.has_tube && !none(without(mask, m)) ? either(m, off_tube<kSide>(look, u, v, s)) : m;
  }

  /// Lanes of `there` whose material is out of reach.
  HWY_INLINE M rejected(const RayWindow& w, double u, const Group& g, M there) const {
    const M m = g.two ? rejected_two(w, u, g, there) : rejected_one(w, u, g, there);
    if (!look.has_planes) return m;
    // The highest and the lowest point of the material at the step's heights are below the tool's lower end.
    const V low = max(g.low, set(w.low)), high = min(g.high, set(w.high));
    M rest = without(there, m);
    if (kKind == QuickReject::Kind::Planes) rest = both(rest, hn::Lt(high, g.high));
    if (none(rest)) return m;
    const M below = under_planes(look, u, g.v, high);
    if (none(both(rest, below))) return m;
    return either(m, both(rest, both(below, under_planes(look, u, g.v, low))));
  }

 private:
  HWY_INLINE M rejected_one(const RayWindow& w, double u, const Group& g, M there) const {
    M m = no_lane();
    if (ends_before(g.first_far, set(w.high), there)) m = out<-1>(u, g.v, g.first_far, there);
    const M rest = without(there, m);
    return look.has_tube && ends_before(set(w.low), g.near, rest) ? either(m, out<1>(u, g.v, g.near, rest)) : m;
  }

  HWY_INLINE M rejected_two(const RayWindow& w, double u, const Group& g, M there) const {
    const V low = set(w.low), high = set(w.high);
    const M two = from_bits(g.two);
    const M first_free = hn::Le(g.first_far, low), last_free = both(two, hn::Ge(g.last_near, high));
    const M under = out<-1>(u, g.v, g.first_far, without(there, first_free));
    const M over = out<1>(u, g.v, g.last_near, without(there, last_free));
    M m =
        either(both(two, both(either(under, first_free), either(over, last_free))), without(either(under, over), two));
    // Or both spans are on the same side of the tool.
    const M rest = without(both(there, two), m);
    if (ends_before(g.high, high, rest)) m = either(m, both(two, out<-1>(u, g.v, g.high, rest)));
    if (ends_before(low, g.low, rest)) m = either(m, both(two, out<1>(u, g.v, g.low, rest)));
    return m;
  }

  /// Whether a < b in a lane of the mask. Spans that reach beyond the step's heights are hardly ever out of reach.
  static bool ends_before(V a, V b, M mask) { return !none(both(mask, hn::Lt(a, b))); }
};

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
