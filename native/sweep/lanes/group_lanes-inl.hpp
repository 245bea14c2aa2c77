// The material of neighbouring rays of a tile, as many rays at a time as there are lanes.
#if defined(RIFFLER_SWEEP_GROUP_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_GROUP_LANES_INL_HPP
#undef RIFFLER_SWEEP_GROUP_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_GROUP_LANES_INL_HPP
#endif

#include "sweep/lanes/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// A group of neighbouring rays in one row.
struct Group {
  int ray;            // index of the first ray in the tile
  int slot;           // slot in the sums
  V v;                // v of the rays; the row has one u
  V low, high;        // hull of the rays' material
  V near, first_far;  // the first span in the planes
  V last_near, far;   // the second one; the first again in lanes without
  unsigned two = 0;   // lanes with a second one
  unsigned many = 0;  // lanes with others that are not in the planes
  M active;           // lanes that the step may touch
};

/// Loads the spans of a plane. At the end of a tile that is read in place, fewer rays than lanes may remain.
HWY_INLINE void load_spans(const dexel::Span* plane, int ray, V& near, V& far) {
  static_assert(sizeof(dexel::Span) == 2 * sizeof(double));
  const dexel::Span* rays = plane + ray;
  dexel::Span last[base::kLanes];
  if (ray + lanes() > dexel::kTileRays) {
    for (int k = 0; k < lanes(); ++k)
      last[k] = ray + k < dexel::kTileRays ? rays[k] : dexel::Span{kInfinity, -kInfinity};
    rays = last;
  }
  const double* ends = &rays->near;
#if HWY_TARGET == HWY_SCALAR
  hn::LoadInterleaved2(kD, ends, near, far);
#else
  // needs fewer shuffles than LoadInterleaved2
  const V low = hn::LoadU(kD, ends), high = hn::LoadU(kD, ends + lanes());
  near = hn::ConcatEven(kD, high, low), far = hn::ConcatOdd(kD, high, low);
#endif
}

HWY_INLINE void load_material(const RayWindow& w, Group& g) {
  const int row = g.ray / dexel::kTileSide, column = g.ray % dexel::kTileSide;
  const unsigned all = (1U << lanes()) - 1;
  g.two = (w.planes->two[row] >> column) & all, g.many = (w.planes->many[row] >> column) & all;
  load_spans(w.rays, g.ray, g.near, g.first_far);
  g.low = g.last_near = g.near, g.high = g.far = g.first_far;
  if (!g.two) return;
  V near, far;
  load_spans(w.planes->last, g.ray, near, far);
  const M two = from_bits(g.two);
  g.last_near = pick(two, near, g.last_near), g.high = g.far = pick(two, far, g.far);
  if (!g.many) return;
  const M many = from_bits(g.many);
  load_spans(w.planes->hull, g.ray, near, far);
  g.low = pick(many, near, g.low), g.high = pick(many, far, g.high);
}

HWY_INLINE Group group_at(const RayWindow& w, int row, int column) {
  Group g;
  g.ray = row * dexel::kTileSide + column, g.slot = (column - w.first[row]) % base::kLanes;
  g.v = hn::LoadU(kD, w.v + column), g.active = no_lane();
  load_material(w, g);
  return g;
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
