// Subtracts intervals from the rays of a window, many rays at a time, and sums up what is removed.
#if defined(RIFFLER_SWEEP_CUT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_CUT_LANES_INL_HPP
#undef RIFFLER_SWEEP_CUT_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_CUT_LANES_INL_HPP
#endif

#include <bit>

#include "sweep/lanes/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// A group of neighbouring rays in one row.
struct Group {
  int ray;      // index of the first ray in the tile
  int slot;     // slot in the sums
  V v;          // v of the rays; the row has one u
  V near, far;  // the rays' material
  M active;     // lanes that the step may touch
};

/// Rays in a tool's frame: the point at height s above the tip is (x + s tilt, y, z + s oz).
struct SectionRays {
  V x, y, z;
};

/// Loads the group's material. At the end of a tile, fewer rays than lanes may remain.
HWY_INLINE void load_material(const RayWindow& w, Group& g) {
  static_assert(sizeof(dexel::Span) == 2 * sizeof(double));
  const dexel::Span* rays = w.rays + g.ray;
  dexel::Span last[base::kLanes];
  if (g.ray + lanes() > dexel::kTileRays) {
    for (int k = 0; k < lanes(); ++k)
      last[k] = g.ray + k < dexel::kTileRays ? rays[k] : dexel::Span{kInfinity, -kInfinity};
    rays = last;
  }
  const double* ends = &rays->near;
#if HWY_TARGET == HWY_SCALAR
  hn::LoadInterleaved2(kD, ends, g.near, g.far);
#else
  // needs fewer shuffles than LoadInterleaved2
  const V low = hn::LoadU(kD, ends), high = hn::LoadU(kD, ends + lanes());
  g.near = hn::ConcatEven(kD, high, low), g.far = hn::ConcatOdd(kD, high, low);
#endif
}

HWY_INLINE void store_material(RayWindow& w, int ray, V near, V far) {
  if (!w.opened) w.open(w.self);
  dexel::Span* rays = w.opened + ray;
  if (ray + lanes() <= dexel::kTileRays) return hn::StoreInterleaved2(near, far, kD, &rays->near);
  dexel::Span last[base::kLanes];
  hn::StoreInterleaved2(near, far, kD, &last->near);
  for (int k = 0; ray + k < dexel::kTileRays; ++k) rays[k] = last[k];
}

HWY_INLINE Group group_at(const RayWindow& w, int row, int column) {
  Group g{row * dexel::kTileSide + column,
          (column - w.first[row]) % base::kLanes,
          hn::LoadU(kD, w.v + column),
          zero(),
          zero(),
          no_lane()};
  load_material(w, g);
  return g;
}

/// Lanes for which the quick reject shows that all material is out of reach.
template <bool kFlank>
HWY_INLINE M under_ball(const QuickReject& look, double u, const Group& g) {
  const V x = set(u - look.from[0]), y = hn::Sub(g.v, set(look.from[1])), z = hn::Sub(g.far, set(look.from[2]));
  const auto dot = [](V a, V b, V c, const double* d) {
    return hn::Add(hn::Add(hn::Mul(a, set(d[0])), hn::Mul(b, set(d[1]))), hn::Mul(c, set(d[2])));
  };
  const V t = min(max(hn::Mul(dot(x, y, z, look.way), set(look.per_square)), zero()), set(1));
  const auto off = [&](V p, int i) { return hn::Sub(p, hn::Mul(t, set(look.way[i]))); };
  const V a = off(x, 0), b = off(y, 1), c = off(z, 2);
  const V square = hn::Add(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(c, c));
  const M out = both(hn::Ge(square, set(look.square)), hn::Le(c, zero()));
  if (!kFlank) return out;
  const V rise = dot(a, b, c, look.axis);
  return both(out,
              both(hn::Le(rise, zero()), hn::Ge(hn::Mul(rise, rise), hn::Mul(square, set(look.lean * look.lean)))));
}
HWY_INLINE M under_planes(const QuickReject& look, double u, const Group& g) {
  V most = set(-kInfinity);
  for (int k = 0; k < 2; ++k) {
    const double* foot = look.foot[k];
    const double* n = look.normal[k];
    const V z = hn::Sub(g.far, set(foot[2]));
    const V h = hn::Add(hn::Add(set((u - foot[0]) * n[0]), hn::Mul(hn::Sub(g.v, set(foot[1])), set(n[1]))),
                        hn::Mul(z, set(n[2])));
    most = max(most, hn::Add(h, hn::Mul(abs(z), set(look.per_depth))));
  }
  return hn::Lt(most, set(-look.slack));
}

/// A group that the step may touch: its first ray and its active lanes.
struct Candidate {
  std::uint16_t ray;
  std::uint8_t active;
};

/// The groups of the window that have material at its heights and that `under` does not reject.
template <class Under>
HWY_INLINE int find_groups(RayWindow& w, const Under& under, Candidate* out) {
  const V low = set(w.low), high = set(w.high);
  int n = 0;
  for (int a = w.first_row; a <= w.last_row; ++a)
    for (int b = w.first[a]; b < w.end[a]; b += lanes()) {
      const Group g = group_at(w, a, b);
      const M inside = hn::FirstN(kD, static_cast<std::size_t>(w.end[a] - b));
      const M there = both(inside, both(hn::Lt(g.near, high), hn::Gt(g.far, low)));
      const unsigned active = bits(without(there, under(w.u[a], g)));
      out[n] = {static_cast<std::uint16_t>(g.ray), static_cast<std::uint8_t>(active)};
      n += active != 0;
      w.tested += static_cast<unsigned>(std::popcount(active));
    }
  return n;
}

/// Calls body(u, group) for all groups that the step may touch.
template <class Body>
HWY_INLINE void for_groups(RayWindow& w, const Body& body) {
  Candidate found[dexel::kTileRays];
  int n = 0;
  switch (w.look.kind) {
    case QuickReject::Kind::None:
      n = find_groups(w, [](double, const Group&) { return no_lane(); }, found);
      break;
    case QuickReject::Kind::Ball:
      n = find_groups(w, [&](double u, const Group& g) { return under_ball<false>(w.look, u, g); }, found);
      break;
    case QuickReject::Kind::BallAndFlank:
      n = find_groups(w, [&](double u, const Group& g) { return under_ball<true>(w.look, u, g); }, found);
      break;
    case QuickReject::Kind::Planes:
      n = find_groups(w, [&](double u, const Group& g) { return under_planes(w.look, u, g); }, found);
      break;
  }
  for (int k = 0; k < n; ++k) {
    const int row = found[k].ray / dexel::kTileSide;
    Group g = group_at(w, row, found[k].ray % dexel::kTileSide);
    g.active = from_bits(found[k].active);
    body(w.u[row], g);
  }
}

HWY_INLINE void add_to(double* slots, int slot, V x) {
  hn::StoreU(hn::Add(hn::LoadU(kD, slots + slot), x), kD, slots + slot);
}

/// Equations (3.20)–(3.22) combined: a `force` of size `length`, opposed to the velocity of the tool's material point p
/// at time t.
HWY_INLINE void force_at(const ForceLaw& law, const V (&p)[3], V length, V t, V (&force)[3]) {
  V arm[3], square = zero();
  for (int i = 0; i < 3; ++i) arm[i] = hn::Sub(p[i], hn::Add(set(law.tip[i]), hn::Mul(t, set(law.way[i]))));
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const V turn = hn::Sub(hn::Mul(set(law.spin[k]), arm[j]), hn::Mul(set(law.spin[j]), arm[k]));
    force[i] = hn::Sub(turn, set(law.way[i])), square = hn::Add(square, hn::Mul(force[i], force[i]));
  }
  // along the axis where that point is at rest
  const M moves = hn::Gt(square, zero());
  const V scale = hn::Div(length, sqrt(pick(moves, square, set(1))));
  for (int i = 0; i < 3; ++i) force[i] = pick(moves, hn::Mul(force[i], scale), hn::Mul(length, set(law.axis[i])));
}
/// Same for a tool that does not rotate.
HWY_INLINE void force_along(const ForceLaw& law, V length, V (&force)[3]) {
  const bool moves = law.speed > 0;
  const V scale = moves ? hn::Div(length, set(law.speed)) : length;
  for (int i = 0; i < 3; ++i) force[i] = hn::Mul(scale, set(moves ? -law.way[i] : law.axis[i]));
}

HWY_INLINE void add_force(RayWindow& w, const V (&p)[3], const V (&force)[3], int slot) {
  V arm[3];
  for (int i = 0; i < 3; ++i) arm[i] = hn::Sub(p[i], set(w.law->pivot[i]));
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const V moment = hn::Sub(hn::Mul(arm[j], force[k]), hn::Mul(arm[k], force[j]));
    add_to(w.sums->direction[i], slot, force[i]), add_to(w.sums->moment[i], slot, moment);
  }
}

/// Removes `cut` in the lanes of `mask`. `t_near` and `t_far`: the motion's t at its two ends.
HWY_INLINE void subtract(RayWindow& w, double u, const Group& g, M mask, RayIntervals cut, V t_near, V t_far) {
  // Ignore a cut thinner than the minimum thickness: it would leave two spans that touch.
  const M touched = both(both(mask, hn::Gt(hn::Sub(cut.far, cut.near), set(w.thinnest))),
                         both(hn::Lt(cut.near, g.far), hn::Gt(cut.far, g.near)));
  if (none(touched)) return;
  w.changed += hn::CountTrue(kD, touched);
  const V thinnest = set(w.thinnest);
  const M below = hn::Gt(hn::Sub(cut.near, g.near), thinnest), above = hn::Gt(hn::Sub(g.far, cut.far), thinnest);
  const int a = g.ray / dexel::kTileSide, b = g.ray % dexel::kTileSide;
  const M many = from_bits((w.many[a] >> b) & ((1U << lanes()) - 1));
  const M simple = w.in_place ? without(without(touched, many), both(below, above)) : no_lane();
  const V low = pick(below, cut.near, g.near), high = pick(above, cut.far, g.far);
  if (!none(simple)) {
    const M gone = without(without(simple, below), above);
    const V near = pick(gone, set(kInfinity), pick(above, cut.far, g.near));
    const V far = pick(gone, set(-kInfinity), pick(below, cut.near, g.far));
    store_material(w, g.ray, pick(simple, near, g.near), pick(simple, far, g.far));
    w.emptied = w.emptied || !none(gone);
    if (w.measured) {
      V length = hn::IfThenElseZero(simple, hn::Sub(high, low));
      if (w.uneven) length = hn::Mul(length, hn::Mul(set(w.share_u[a]), hn::LoadU(kD, w.share_v + b)));
      add_to(w.sums->length, g.slot, length);
      // Lanes without removed material may hold infinities.
      const V middle = hn::IfThenElseZero(simple, hn::Mul(set(0.5), hn::Add(low, high)));
      if (w.with_force) {
        const V p[3] = {set(u), g.v, middle};
        V force[3];
        if (w.law->turns) {
          force_at(*w.law, p, length, hn::Mul(set(0.5), hn::Add(t_near, t_far)), force);
          add_force(w, p, force, g.slot);
        } else {
          force_along(*w.law, length, force);
          add_force(w, p, force, g.slot);
        }
      }
    }
  }
  const unsigned rest = bits(without(touched, simple));
  if (!rest) return;
  double near[base::kLanes], far[base::kLanes], tn[base::kLanes], tf[base::kLanes];
  hn::StoreU(cut.near, kD, near), hn::StoreU(cut.far, kD, far), hn::StoreU(t_near, kD, tn), hn::StoreU(t_far, kD, tf);
  for (unsigned m = rest; m; m &= m - 1) {
    const int k = std::countr_zero(m);
    w.cut(w.self, g.ray + k, {near[k], far[k], tn[k], tf[k]});
  }
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
