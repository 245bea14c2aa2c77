// A tool pose in every lane, and rays relative to it.
#if defined(RIFFLER_SWEEP_POSE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_POSE_LANES_INL_HPP
#undef RIFFLER_SWEEP_POSE_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_POSE_LANES_INL_HPP
#endif

#include "sweep/lanes/vector_lanes-inl.hpp"
#include "sweep/turning_part.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// The tool's axis, and the vector from its tip to the rays' points at s = 0.
struct Pose {
  V3 axis, from_tip;
};

HWY_INLINE V series(V q, const double (&k)[5]) {
  V sum = set(k[4]);
  for (int i = 3; i >= 0; --i) sum = hn::Add(hn::Mul(sum, q), set(k[i]));
  return sum;
}

/// Angles are at most 1/8, so truncating the series costs less than 1e-16.
HWY_INLINE V cosine(V turn) {
  return series(hn::Mul(turn, turn), {1, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320});
}
HWY_INLINE V sine(V turn) {
  return hn::Mul(turn, series(hn::Mul(turn, turn), {1, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880}));
}

/// The poses at `t`, relative to the rays (u, v).
HWY_INLINE Pose pose_at(const TurningBody& body, V u, V v, V t) {
  const V turn = hn::Mul(set(body.angle), hn::Sub(t, set(body.middle)));
  const V c = cosine(turn), s = sine(turn);  // |turn| ≤ 1/8 (steps.cpp)
  const auto axis = [&](int i) { return hn::Add(hn::Mul(c, set(body.axis[i])), hn::Mul(s, set(body.side[i]))); };
  const auto tip = [&](int i) { return hn::Add(set(body.tip[i]), hn::Mul(t, set(body.way[i]))); };
  return {{axis(0), axis(1), axis(2)}, {hn::Sub(u, tip(0)), hn::Sub(v, tip(1)), hn::Neg(tip(2))}};
}

/// A ray relative to the axis: its height above the tip is z + s oz, its squared distance from the axis a s² + 2 b s +
/// c.
class AxisView {
 public:
  AxisView(const TurningBody& body, const Pose& pose) : b_(body), o_(pose.axis), w_(pose.from_tip) {
    z_ = dot(w_, o_);
    // Avoids cancellation if the axis is parallel to the ray.
    a_ = hn::Add(hn::Mul(o_.x, o_.x), hn::Mul(o_.y, o_.y));
    const V across = hn::Add(hn::Mul(w_.x, o_.x), hn::Mul(w_.y, o_.y));
    b1_ = hn::Sub(hn::Mul(w_.z, a_), hn::Mul(o_.z, across));
    const V3 radial = less(w_, z_, o_);
    c_ = dot(radial, radial);
    per_oz_ = hn::Div(set(1), pick(hn::Gt(abs(o_.z), set(kLevel)), o_.z, set(1)));
  }

 protected:
  static constexpr double kLevel = 1e-12;  // the axis counts as perpendicular to the rays: if a ray meets a piece then,
                                           // it also does shortly before and after
  static constexpr int kMaxSteps = 24;

  V z_at(V s) const { return hn::Add(z_, hn::Mul(s, o_.z)); }
  V3 point(V s) const { return {w_.x, w_.y, hn::Add(w_.z, s)}; }
  /// The vector from the axis, perpendicular to it, to the ray's point at s.
  V3 radial(V s) const { return less(point(s), z_at(s), o_); }

  /// The interval of the ray between two heights above the tip; for a level ray, everything or nothing.
  RayIntervals slab(double low, double high) const {
    const V a = hn::Mul(hn::Sub(set(low), z_), per_oz_), b = hn::Mul(hn::Sub(set(high), z_), per_oz_);
    const RayIntervals out{min(a, b), max(a, b)};
    const M level = hn::Le(abs(o_.z), set(kLevel));
    if (none(level)) return out;
    const RayIntervals all = where(both(hn::Ge(z_, set(low)), hn::Le(z_, set(high))), everything());
    return {pick(level, all.near, out.near), pick(level, all.far, out.far)};
  }

  const TurningBody& b_;
  V3 o_, w_;
  V z_, a_, b1_, c_, per_oz_;
};

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
