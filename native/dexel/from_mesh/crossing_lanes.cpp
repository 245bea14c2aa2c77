#include "dexel/from_mesh/crossing_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dexel/from_mesh/crossing_lanes.cpp"
// Keep clang-format from sorting foreach_target.h to another place.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "base/lanes-inl.hpp"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace riffler::dexel::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

namespace {

using Whole = hn::RebindToSigned<Lanes>;
using I = hn::Vec<Whole>;
constexpr Whole kI;

struct Corner {
  V u, v, z;
  I index;
};

HWY_INLINE Corner corner(const Projection& projection, const std::int64_t* index) {
  static_assert(sizeof(Projection::Vertex) == 4 * sizeof(double));
  const double* base = &projection.vertices().data()->u;
  const I at = hn::LoadU(kI, index), place = hn::ShiftLeft<2>(at);
  return {hn::GatherIndex(kD, base, place), hn::GatherIndex(kD, base + 1, place), hn::GatherIndex(kD, base + 2, place),
          at};
}

/// Swaps lanes in which the second corner has the lower u, and flips `odd` there.
HWY_INLINE void order(Corner& low, Corner& high, M& odd) {
  const M swap = hn::Lt(high.u, low.u);
  const auto exchange = [](auto m, auto& a, auto& b) HWY_ATTR {
    const auto lower = hn::IfThenElse(m, b, a);
    b = hn::IfThenElse(m, a, b), a = lower;
  };
  exchange(swap, low.u, high.u), exchange(swap, low.v, high.v), exchange(swap, low.z, high.z);
  exchange(hn::RebindMask(kI, swap), low.index, high.index);
  odd = hn::Xor(odd, swap);
}

/// Edges from lower to higher u, with the two quotients that give points on them.
struct Edge {
  V u, v, z, inverse, slope, rise;

  HWY_INLINE Edge(const Corner& low, const Corner& high) : u(low.u), v(low.v), z(low.z) {
    inverse = hn::Div(set(1), sub(high.u, low.u)), slope = mul(sub(high.v, low.v), inverse);
    rise = sub(high.z, low.z);
  }
  HWY_INLINE Edge(M m, const Edge& yes, const Edge& no)
      : u(hn::IfThenElse(m, yes.u, no.u)),
        v(hn::IfThenElse(m, yes.v, no.v)),
        z(hn::IfThenElse(m, yes.z, no.z)),
        inverse(hn::IfThenElse(m, yes.inverse, no.inverse)),
        slope(hn::IfThenElse(m, yes.slope, no.slope)),
        rise(hn::IfThenElse(m, yes.rise, no.rise)) {}
  HWY_INLINE V v_at(V row) const { return add(v, mul(sub(row, u), slope)); }
  HWY_INLINE V z_at(V row) const { return add(z, mul(mul(sub(row, u), inverse), rise)); }
};

/// A group of triangles, one per lane.
class Group {
 public:
  HWY_INLINE Group(const Projection& projection, const Vec3i* corners, const std::uint32_t* triangles,
                   std::size_t count)
      : projection_(projection), nv_(set(projection.nv())) {
    std::int64_t index[3][kMax], name[kMax];
    for (std::size_t k = 0; k < hn::Lanes(kD); ++k) {
      const std::uint32_t triangle = triangles[std::min(k, count - 1)];
      for (int q = 0; q < 3; ++q) index[q][k] = corners[triangle][q];
      name[k] = triangle;
    }
    names_ = hn::LoadU(kI, name);
    low_ = corner(projection, index[0]), middle_ = corner(projection, index[1]);
    high_ = corner(projection, index[2]);
    odd_ = hn::FirstN(kD, 0);
    order(low_, middle_, odd_), order(middle_, high_, odd_), order(low_, middle_, odd_);
    valid_ = hn::FirstN(kD, count);
  }

  HWY_INLINE void find(int first, int last, BandCrossings& out) const {
    // Intersect the long edge with the lower short one, then with the upper one. The rule is half-open: a row belongs
    // to an edge if u(low) ≤ row < u(high), so an edge of constant u never counts.
    const Edge whole(low_, high_), lower(low_, middle_), upper(middle_, high_);
    const V end = hn::Min(set(last), hn::Ceil(high_.u)), turn = hn::Ceil(middle_.u);
    for (V row = hn::Max(set(first), hn::Ceil(low_.u));; row = add(row, set(1))) {
      const M reached = hn::And(valid_, hn::Lt(row, end));
      if (hn::AllFalse(kD, reached)) return;
      const M below = hn::Lt(row, turn);
      const Edge part(below, lower, upper);
      const V v_whole = whole.v_at(row), v_part = part.v_at(row);
      V c_whole, c_part;
      const M unsure = hn::Or(columns(v_whole, c_whole), columns(v_part, c_part));
      if (HWY_UNLIKELY(!hn::AllFalse(kD, hn::And(unsure, reached))))
        decide(hn::And(unsure, reached), below, row, v_whole, v_part, c_whole, c_part);
      const V least = hn::Min(c_whole, c_part);
      const V most = hn::IfThenElse(reached, hn::Max(c_whole, c_part), least);
      if (hn::AllFalse(kD, hn::Lt(least, most))) continue;
      const M leaves = hn::Xor(odd_, hn::Lt(c_part, c_whole));
      const V z_whole = whole.z_at(row);
      emit(least, most, v_whole, sub(v_part, v_whole), z_whole, sub(part.z_at(row), z_whole),
           mul(sub(row, set(first)), nv_), leaves, out);
    }
  }

 private:
  static constexpr std::size_t kMax = 8;

  /// ⌈v⌉ clamped to [0, nv]. Returns the lanes in which rounding may have made it wrong.
  HWY_INLINE M columns(V v, V& ceiling) const {
    const V above = add(hn::Min(hn::Max(v, set(-0.5)), add(nv_, set(0.5))), set(1)), floor = hn::Floor(above);
    const V past = sub(above, floor), slack = set(projection_.slack());
    ceiling = hn::Min(floor, nv_);
    return hn::Or(hn::Lt(past, slack), hn::Gt(past, sub(set(1), slack)));
  }

  /// Decides exactly the lanes in which rounding leaves a doubt.
  HWY_NOINLINE void decide(M unsure, M below, V row, V v_whole, V v_part, V& c_whole, V& c_part) const {
    double rows[kMax], v[2][kMax], c[2][kMax], which[kMax], lower[kMax];
    std::int64_t low[kMax], middle[kMax], high[kMax];
    hn::StoreU(row, kD, rows);
    hn::StoreU(v_whole, kD, v[0]), hn::StoreU(v_part, kD, v[1]);
    hn::StoreU(c_whole, kD, c[0]), hn::StoreU(c_part, kD, c[1]);
    hn::StoreU(hn::IfThenElseZero(unsure, set(1)), kD, which), hn::StoreU(hn::IfThenElseZero(below, set(1)), kD, lower);
    hn::StoreU(low_.index, kI, low), hn::StoreU(middle_.index, kI, middle), hn::StoreU(high_.index, kI, high);
    const auto vertex = [this](std::int64_t k) { return projection_.vertex(static_cast<int>(k)); };
    for (std::size_t k = 0; k < hn::Lanes(kD); ++k) {
      if (which[k] == 0) continue;
      const int at = static_cast<int>(rows[k]);
      c[0][k] = projection_.column(vertex(low[k]), vertex(high[k]), at, v[0][k]);
      c[1][k] = lower[k] != 0 ? projection_.column(vertex(low[k]), vertex(middle[k]), at, v[1][k])
                              : projection_.column(vertex(middle[k]), vertex(high[k]), at, v[1][k]);
    }
    c_whole = hn::LoadU(kD, c[0]), c_part = hn::LoadU(kD, c[1]);
  }

  /// Emits the columns from `least` up to, but not including, `most`.
  HWY_INLINE void emit(V least, V most, V v, V width, V z, V rise, V offset, M leaves, BandCrossings& out) const {
    const M level = hn::Eq(width, zero());
    const V divisor = hn::IfThenElse(level, set(1), width);
    const I name = hn::Or(names_, hn::IfThenElseZero(hn::RebindMask(kI, leaves), hn::Set(kI, BandCrossings::kLeaves)));
    V column = least;
    M some = hn::Lt(column, most);
    do {
      const V part = hn::Min(hn::Max(hn::Div(sub(column, v), divisor), zero()), set(1));
      const V t = hn::IfThenZeroElse(level, part);
      const I place = hn::ConvertTo(kI, add(offset, column));
      double heights[kMax];
      std::int64_t names[kMax];
      std::uint8_t bits[kMax];
      hn::StoreU(add(z, mul(t, rise)), kD, heights);
      hn::StoreU(hn::Or(hn::ShiftLeft<BandCrossings::kColumnShift>(place), name), kI, names);
      hn::StoreMaskBits(kD, some, bits);
      // Writes all lanes and advances past the valid ones: no unpredictable branch.
      const auto [to_z, to_name] = out.room(kMax);
      std::size_t count = 0;
      for (std::size_t k = 0; k < hn::Lanes(kD); ++k) {
        to_z[count] = heights[k], to_name[count] = names[k];
        count += bits[0] >> k & 1;
      }
      out.added(count);
      column = add(column, set(1)), some = hn::Lt(column, most);
    } while (!hn::AllFalse(kD, some));
  }

  const Projection& projection_;
  V nv_;
  Corner low_, middle_, high_;
  M odd_, valid_;  // odd: the corners are a mirror image of the triangle
  I names_;
};

}  // namespace

void FindCrossings(std::span<const Vec3i> corners, std::span<const std::uint32_t> triangles,
                   const Projection& projection, int first, int last, BandCrossings& out) {
  // Prefetch: triangles in random order would cause a cache miss for each corner.
  constexpr std::size_t kAhead = 16;
  const std::size_t n = triangles.size(), lanes = hn::Lanes(kD);
  for (std::size_t at = 0; at < n; at += lanes) {
    for (std::size_t k = at; k < at + lanes; ++k) {
      if (k + 2 * kAhead < n) __builtin_prefetch(&corners[triangles[k + 2 * kAhead]]);
      if (k + kAhead < n) projection.prefetch(corners[triangles[k + kAhead]]);
    }
    Group(projection, corners.data(), triangles.data() + at, std::min(lanes, n - at)).find(first, last, out);
  }
}

}  // namespace riffler::dexel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::dexel {

HWY_EXPORT(FindCrossings);

void find_crossings(std::span<const Vec3i> corners, std::span<const std::uint32_t> triangles,
                    const Projection& projection, int first, int last, BandCrossings& out) {
  HWY_DYNAMIC_DISPATCH(FindCrossings)(corners, triangles, projection, first, last, out);
}

}  // namespace riffler::dexel

#endif
