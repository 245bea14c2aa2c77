// The rays of a tile that a step may touch, gathered from all rows, so that kernels have few idle lanes.
#if defined(RIFFLER_SWEEP_PACKED_RAYS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_PACKED_RAYS_INL_HPP
#undef RIFFLER_SWEEP_PACKED_RAYS_INL_HPP
#else
#define RIFFLER_SWEEP_PACKED_RAYS_INL_HPP
#endif

#include <bit>
#include <cstdint>

#include "sweep/lane_order.hpp"
#include "sweep/lanes/reject_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// Rays are numbered in the order of the tile. A kernel handles those from k on for each multiple k of lanes(), and may
/// store up to four results of each ray in the place of its arguments. A ray's result does not depend on the others in
/// its vector.
class PackedRays {
 public:
  /// The rays of the window that have material at its heights and that its quick reject does not exclude.
  explicit PackedRays(RayWindow& w) {
    using Kind = QuickReject::Kind;
    switch (w.look.kind) {
      case Kind::None:
        find(w, Look<Kind::None>{w.look});
        break;
      case Kind::Ball:
        find(w, Look<Kind::Ball>{w.look});
        break;
      case Kind::BallAndFlank:
        find(w, Look<Kind::BallAndFlank>{w.look});
        break;
      case Kind::Planes:
        find(w, Look<Kind::Planes>{w.look});
        break;
    }
    // The last vector must not contain arbitrary bytes.
    if (count_ > 0)
      for (auto& field : fields_) hn::StoreU(set(field[count_ - 1]), kD, field + count_);
    w.tested += static_cast<unsigned>(count_);
  }

  int count() const { return count_; }
  M present(int k) const { return hn::FirstN(kD, static_cast<std::size_t>(count_ - k)); }
  V u(int k) const { return hn::LoadU(kD, fields_[0] + k); }
  V v(int k) const { return hn::LoadU(kD, fields_[1] + k); }
  /// Hull of the material at the window's heights.
  V low(int k) const { return hn::LoadU(kD, fields_[2] + k); }
  V high(int k) const { return hn::LoadU(kD, fields_[3] + k); }
  /// The gap between the two spans of a ray; in rays with one or more than two, near > far.
  RayIntervals gap(int k) const { return {hn::LoadU(kD, fields_[5] + k), hn::LoadU(kD, fields_[6] + k)}; }
  /// Indices in the tile.
  V place(int k) const { return hn::LoadU(kD, fields_[4] + k); }
  void store(int k, int result, V value) { hn::StoreU(value, kD, fields_[result] + k); }

  /// Calls body(u, group, result) for the groups of these rays; result(i) is the i-th result, in the active lanes.
  template <class Body>
  HWY_INLINE void each_group(RayWindow& w, const Body& body) const {
    int first = 0;
    for (int k = 0; k < groups_; ++k) {
      const unsigned active = found_[k].active;
      const int row = found_[k].ray / dexel::kTileSide;
      Group g = group_at(w, row, found_[k].ray % dexel::kTileSide);
      g.active = from_bits(active);
      const auto order = hn::SetTableIndices(kD, kSpread[active].data());
      body(w.u[row], g,
           [&](int result) { return hn::TableLookupLanes(hn::LoadU(kD, fields_[result] + first), order); });
      first += std::popcount(active);
    }
  }

 private:
  static constexpr int kFields = 7;
  /// A group's first ray, and which of its rays are here.
  struct Found {
    std::uint16_t ray;
    std::uint8_t active;
  };

  template <class Look>
  HWY_INLINE void find(const RayWindow& w, const Look& look) {
    const V low = set(w.low), high = set(w.high), index = hn::Iota(kD, 0);
    int count = 0, groups = 0;
    for (int a = w.first_row; a <= w.last_row; ++a)
      for (int b = w.first[a]; b < w.end[a]; b += lanes()) {
        const Group g = group_at(w, a, b);
        const M inside = hn::FirstN(kD, static_cast<std::size_t>(w.end[a] - b));
        const M there = both(inside, both(hn::Lt(g.low, high), hn::Gt(g.high, low)));
        if (none(there)) continue;
        const unsigned active = bits(without(there, look.rejected(w, w.u[a], g, there)));
        if (!active) continue;
        found_[groups++] = {static_cast<std::uint16_t>(g.ray), static_cast<std::uint8_t>(active)};
        const auto order = hn::SetTableIndices(kD, kGathered[active].data());
        const auto put = [&](int field, V x) {
          hn::StoreU(hn::TableLookupLanes(x, order), kD, fields_[field] + count);
        };
        hn::StoreU(set(w.u[a]), kD, fields_[0] + count);
        put(1, g.v), put(2, max(g.low, low)), put(3, min(g.high, high)), put(4, hn::Add(set(g.ray), index));
        // Which gap of more spans the planes have depends on earlier cuts; no cut may depend on that.
        const M two = from_bits(g.two & ~g.many);
        put(5, pick(two, g.first_far, set(kInfinity))), put(6, pick(two, g.last_near, set(-kInfinity)));
        count += std::popcount(active);
      }
    count_ = count, groups_ = groups;
  }

  int count_ = 0, groups_ = 0;
  Found found_[dexel::kTileRays];
  double fields_[kFields][dexel::kTileRays + base::kLanes];
};

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
