// Subtracts intervals from the rays of a window, many rays at a time, and sums up what is removed.
#if defined(RIFFLER_SWEEP_CUT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_CUT_LANES_INL_HPP
#undef RIFFLER_SWEEP_CUT_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_CUT_LANES_INL_HPP
#endif

#include <bit>

#include "sweep/lanes/group_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// Rays in a tool's frame: the point at height s above the tip is (x + s tilt, y, z + s oz).
struct SectionRays {
  V x, y, z;
};

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

/// Adds pieces of removed material, [low, high] in the lanes of `mask`, to the sums. `t`: the motion's t at their
/// middle.
HWY_INLINE void add_removed(RayWindow& w, double u, const Group& g, M mask, V low, V high, V t) {
  const int a = g.ray / dexel::kTileSide, b = g.ray % dexel::kTileSide;
  V length = hn::IfThenElseZero(mask, hn::Sub(high, low));
  if (w.uneven) length = hn::Mul(length, hn::Mul(set(w.share_u[a]), hn::LoadU(kD, w.share_v + b)));
  add_to(w.sums->length, g.slot, length);
  if (!w.with_force) return;
  // Lanes without removed material may hold infinities.
  const V middle = hn::IfThenElseZero(mask, hn::Mul(set(0.5), hn::Add(low, high)));
  const V p[3] = {set(u), g.v, middle};
  V force[3];
  if (w.law->turns) {
    force_at(*w.law, p, length, t, force);
    add_force(w, p, force, g.slot);
  } else {
    force_along(*w.law, length, force);
    add_force(w, p, force, g.slot);
  }
}

/// Origins of new ends (open_tile.hpp) that arise at the motion's time t. On a move as short as rounding, t may lie far
/// outside of 0 … 1.
HWY_INLINE V origin_at(const RayWindow& w, V t) {
  if (!w.with_times) return t;
  const V whole = set(1.5 * (1ULL << 52) * Origins::kUnit);  // adding it rounds to multiples of the unit
  const V during = min(max(t, zero()), set(1));
  return hn::Add(hn::Sub(hn::Add(during, whole), whole), set(w.step));
}

/// What a cut leaves of one span of each ray.
struct Remains {
  Remains(V near, V far, const RayIntervals& cut, V thinnest)
      : below(hn::Gt(hn::Sub(cut.near, near), thinnest)), above(hn::Gt(hn::Sub(far, cut.far), thinnest)) {}
  M split() const { return both(below, above); }
  M none() const { return hn::Not(either(below, above)); }
  /// What is left where the span stays one; nothing left is [∞, −∞].
  RayIntervals one(V near, V far, const RayIntervals& cut) const {
    const M gone = none();
    return {pick(gone, set(kInfinity), pick(above, cut.far, near)),
            pick(gone, set(-kInfinity), pick(below, cut.near, far))};
  }
  M below, above;
};

HWY_INLINE void store_spans(dexel::Span* plane, int ray, V near, V far) {
  hn::StoreInterleaved2(near, far, kD, &plane[ray].near);
}
/// Ends that are new in lanes of `near` and `far` get these origins.
HWY_INLINE void store_origins(Origins* plane, int ray, M near, V near_origin, M far, V far_origin) {
  if (!plane) return;
  static_assert(sizeof(Origins) == 2 * sizeof(double));
  V n, f;
  hn::LoadInterleaved2(kD, &plane[ray].near, n, f);
  hn::StoreInterleaved2(pick(near, near_origin, n), pick(far, far_origin, f), kD, &plane[ray].near);
}

/// The rays of `lanes` lose their first span: the second takes its place.
inline void shift(const RayPlanes& planes, int ray, unsigned lanes) {
  for (; lanes; lanes &= lanes - 1) {
    const int r = ray + std::countr_zero(lanes);
    planes.first[r] = planes.last[r];
    if (!planes.first_origins) continue;
    planes.first_origins[r] = planes.last_origins[r], planes.first_normals[r] = planes.last_normals[r];
  }
}

/// Notes in which lanes of a group a cut has changed something, split the only span, and left nothing of the first or
/// of the last span.
inline void count_spans(const RayPlanes& planes, const Group& g, unsigned changed, unsigned splits, unsigned first_gone,
                        unsigned last_gone) {
  shift(planes, g.ray, first_gone & g.two & ~last_gone);
  const unsigned two = (g.two | splits) & ~(first_gone | last_gone);
  const int row = g.ray / dexel::kTileSide, column = g.ray % dexel::kTileSide;
  const std::uint32_t all = ((1U << lanes()) - 1) << column;
  planes.two[row] = (planes.two[row] & ~all) | ((two << column) & all);
  planes.pending[row] |= changed << column;
}

/// A cut of the rays of a group, with the motion's t at its two ends, and the origins of the ends that it makes.
struct GroupCut {
  RayIntervals at;
  V t_near, t_far;
  V near_origin, far_origin;  // of a new near end, at `at.far`; of a new far end
};

/// Cuts the first spans in the lanes of `mask`; those in `splits` become two.
HWY_INLINE void cut_first(RayWindow& w, double u, const Group& g, M mask, M splits, const Remains& r,
                          const GroupCut& cut) {
  const RayPlanes& planes = *w.planes;
  if (w.measured)
    add_removed(w, u, g, mask, pick(r.below, cut.at.near, g.near), pick(r.above, cut.at.far, g.first_far),
                hn::Mul(set(0.5), hn::Add(cut.t_near, cut.t_far)));
  if (!none(splits)) {
    V near, far;
    load_spans(planes.last, g.ray, near, far);
    store_spans(planes.last, g.ray, pick(splits, cut.at.far, near), pick(splits, g.first_far, far));
    if (planes.first_origins) {
      V n, f;
      hn::LoadInterleaved2(kD, &planes.first_origins[g.ray].near, n, f);
      store_origins(planes.last_origins, g.ray, splits, cut.near_origin, splits, f);
      for (unsigned m = bits(splits); m; m &= m - 1) {
        const int ray = g.ray + std::countr_zero(m);
        planes.last_normals[ray] = planes.first_normals[ray];
      }
    }
  }
  const RayIntervals left = r.one(g.near, g.first_far, cut.at);
  const V near = pick(without(mask, splits), left.near, g.near);
  store_spans(planes.first, g.ray, near, pick(mask, left.far, g.first_far));
  store_origins(planes.first_origins, g.ray, both(without(mask, splits), r.above), cut.near_origin, both(mask, r.below),
                cut.far_origin);
}

/// Cuts the last spans in the lanes of `mask`.
HWY_INLINE void cut_last(RayWindow& w, double u, const Group& g, M mask, const Remains& r, const GroupCut& cut) {
  const RayPlanes& planes = *w.planes;
  if (w.measured)
    add_removed(w, u, g, mask, pick(r.below, cut.at.near, g.last_near), pick(r.above, cut.at.far, g.far),
                hn::Mul(set(0.5), hn::Add(cut.t_near, cut.t_far)));
  const RayIntervals left = r.one(g.last_near, g.far, cut.at);
  V near, far;
  load_spans(planes.last, g.ray, near, far);
  store_spans(planes.last, g.ray, pick(mask, left.near, near), pick(mask, left.far, far));
  store_origins(planes.last_origins, g.ray, both(mask, r.above), cut.near_origin, both(mask, r.below), cut.far_origin);
}

/// Removes `cut` in the lanes of `mask`, which it meets, from rays of which none has two spans.
HWY_INLINE void subtract_from_one(RayWindow& w, double u, const Group& g, M mask, const RayIntervals& cut, V t_near,
                                  V t_far) {
  w.changed += hn::CountTrue(kD, mask);
  if (!w.opened) w.open(w.self);
  const Remains r(g.near, g.first_far, cut, set(w.thinnest));
  const M splits = both(mask, r.split());
  cut_first(w, u, g, mask, splits, r, {cut, t_near, t_far, origin_at(w, t_far), origin_at(w, t_near)});
  const int row = g.ray / dexel::kTileSide, column = g.ray % dexel::kTileSide;
  w.planes->two[row] |= static_cast<std::uint32_t>(bits(splits)) << column;
  w.planes->pending[row] |= static_cast<std::uint32_t>(bits(mask)) << column;
}

/// Removes `cut` in the lanes of `mask`. `t_near` and `t_far`: the motion's t at its two ends.
HWY_INLINE void subtract(RayWindow& w, double u, const Group& g, M mask, RayIntervals cut, V t_near, V t_far) {
  // Ignore a cut thinner than the minimum thickness: it would leave two spans that touch.
  const M thick = both(mask, hn::Gt(hn::Sub(cut.far, cut.near), set(w.thinnest)));
  const M touched = both(thick, both(hn::Lt(cut.near, g.high), hn::Gt(cut.far, g.low)));
  if (none(touched)) return;
  if (!g.two) return subtract_from_one(w, u, g, touched, cut, t_near, t_far);
  const M two = from_bits(g.two);
  const M in_first = both(touched, both(hn::Lt(cut.near, g.first_far), hn::Gt(cut.far, g.near)));
  const M in_last = both(touched, both(two, both(hn::Lt(cut.near, g.far), hn::Gt(cut.far, g.last_near))));
  const Remains first(g.near, g.first_far, cut, set(w.thinnest)), last(g.last_near, g.far, cut, set(w.thinnest));
  // A cut that both spans in the planes survive does not reach any other.
  const M beyond = both(touched, without(from_bits(g.many), both(first.below, last.above)));
  const M changed = either(either(in_first, in_last), beyond);
  if (none(changed)) return;
  // A third span leaves the planes.
  const M third = both(two, either(both(in_first, first.split()), both(in_last, last.split())));
  const unsigned rest = bits(both(changed, either(beyond, third)));
  const M here = from_bits(bits(changed) & ~rest);
  if (!none(here)) {
    w.changed += hn::CountTrue(kD, here);
    if (!w.opened) w.open(w.self);
    const GroupCut made{cut, t_near, t_far, origin_at(w, t_far), origin_at(w, t_near)};
    const M a = both(here, in_first), b = both(here, in_last), splits = both(a, first.split());
    if (!none(a)) cut_first(w, u, g, a, splits, first, made);
    if (!none(b)) cut_last(w, u, g, b, last, made);
    count_spans(*w.planes, g, bits(here), bits(splits), bits(both(a, first.none())), bits(both(b, last.none())));
  }
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
