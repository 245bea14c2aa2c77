// Bounds, from supporting planes, on where the body can be between two poses. docs/methods.md, "Carving", has the
// proof.
#if defined(RIFFLER_SWEEP_CERTIFICATE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_CERTIFICATE_LANES_INL_HPP
#undef RIFFLER_SWEEP_CERTIFICATE_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_CERTIFICATE_LANES_INL_HPP
#endif

#include <algorithm>
#include <cmath>

#include "sweep/lanes/facing_lanes-inl.hpp"
#include "sweep/lanes/pose_lanes-inl.hpp"
#include "sweep/lanes/separating_plane_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// A supporting plane evaluated along the rays. The height of the ray's point s over it is h0 + h1 s; the rate of that
/// height is g0 + g1 s, and half its acceleration is k0 + k1 s.
struct Plane {
  V h0, h1, g0, g1, k0, k1;
};

HWY_INLINE Plane choose(M m, const Plane& a, const Plane& b) {
  return {pick(m, a.h0, b.h0), pick(m, a.h1, b.h1), pick(m, a.g0, b.g0),
          pick(m, a.g1, b.g1), pick(m, a.k0, b.k0), pick(m, a.k1, b.k1)};
}

/// One pose per lane: where the rays meet the body, and planes that keep the body away from the material below and
/// above the interval found so far.
struct Sample {
  V t;
  RayIntervals hit;
  Plane below, above;
  V depth;  ///< number of times the part's time was halved
};

HWY_INLINE Sample choose(M m, const Sample& a, const Sample& b) {
  return {pick(m, a.t, b.t),
          {pick(m, a.hit.near, b.hit.near), pick(m, a.hit.far, b.hit.far)},
          choose(m, a.below, b.below),
          choose(m, a.above, b.above),
          pick(m, a.depth, b.depth)};
}

/// The ray points from `at` to `other` that the body must not reach; `at` is the end that it may come near. `direction`
/// of time is 1, or −1 in lanes that are traversed backwards.
struct Kept {
  V at, other, direction;
};

class Certificate {
 public:
  Certificate(const TurningBody& body, const RayWindow& w) : b_(body) {
    // |n · x‴| ≤ |Ω|³ |X| + 3 |Ω|² |V|. |X| is at most the distance from the first tip to the farthest point of the
    // window, plus the distance the tip moves.
    const auto farthest = [](double low, double high, double from) { return std::max(high - from, from - low); };
    const double x = farthest(w.u[w.first_row], w.u[w.last_row], b_.start.tip[0]);
    const double y = farthest(w.v[0], w.v[dexel::kTileSide - 1], b_.start.tip[1]);
    const double z = farthest(w.low - b_.origin, w.high - b_.origin, b_.start.tip[2]);
    const double away = std::sqrt(x * x + y * y + z * z) + b_.speed * (b_.t1 - b_.t0);
    bend_ = (b_.pull * away + b_.drift) / 6;
  }

  /// The supporting plane that faces `at`.
  Plane towards(const Pose& pose, const Kept& kept) const {
    const Facing f = facing(b_, pose, kept.at);
    Plane p = plane(pose.from_tip, f.n, kept.direction);
    p.h0 = hn::Sub(f.height, hn::Mul(p.h1, kept.at));
    return p;
  }

  /// Same, but in lanes of `missed` in which the body may come nearer to the ray on the part up to `other`: a plane
  /// parallel to the ray.
  Plane between(const Pose& pose, const Kept& kept, M missed) const {
    const Plane p = towards(pose, kept);
    const M nearer = both(missed, hn::Lt(hn::Add(p.h0, hn::Mul(p.h1, kept.other)), set(-b_.aside)));
    if (none(nearer)) return p;
    V height = zero();
    Plane along = plane(pose.from_tip, SeparatingPlaneLanes(b_, pose).find(nearer, height), kept.direction);
    along.h0 = height;
    return choose(nearer, along, p);
  }

  /// Whether a plane at one end of the part keeps the body away during the whole part.
  M stays_away(const Plane& p, const Kept& kept) const {
    return Bound(*this, p, kept, false).least(set(-b_.aside), set(b_.t1 - b_.t0));
  }

  /// Whether plane p and, a time `span` later, plane q keep the body away during the time between. `split`: in lanes in
  /// which they do not, the time after p's pose at which the body probably comes nearest.
  M stays_away(const Plane& p, const Plane& q, const Kept& kept, V span, V& split) const {
    const V limit = set(-b_.aside);
    const Bound from(*this, p, kept, false), to(*this, q, kept, true);
    const M p_all = from.least(limit, span), q_all = to.least(limit, span);
    // Combined: p until the split, q after it.
    split = crossing(from, to, span);
    return either(either(p_all, q_all), both(from.least(limit, split), to.least(limit, hn::Sub(span, split))));
  }

 private:
  /// The plane with outward normal n, without its height offset. `w`: vector from the tip to the rays' points at s = 0.
  /// Rates refer to the `direction` of time in which a lane is traversed. With X the vector from the tip to the ray's
  /// point, in the tool's frame ẋ = −(V + Ω × X) and ẍ = Ω × (Ω × X) + 2 Ω × V.
  Plane plane(const V3& w, const V3& n, V direction) const {
    const V3 m = cross(n, b_.spin), c = scaled(cross(m, b_.spin), set(0.5));
    const V back = hn::Neg(direction);
    return {zero(),
            n.z,
            hn::Mul(back, hn::Add(dot(n, b_.way), dot(m, w))),
            hn::Mul(back, m.z),
            hn::Add(dot(c, w), dot(m, b_.way)),
            c.z};
  }

  /// Height of one point over a plane, with a concave lower bound on it after the time tau.
  struct Height {
    V h, g, k;
    V after(V tau, V bent) const { return hn::Add(h, hn::Mul(tau, hn::Add(g, hn::Mul(tau, hn::Sub(k, bent))))); }
  };
  /// `back`: evaluate against the direction of time of the plane's lane.
  static Height height(const Plane& p, V s, bool back) {
    const V g = hn::Add(p.g0, hn::Mul(p.g1, s));
    return {hn::Add(p.h0, hn::Mul(p.h1, s)), back ? hn::Neg(g) : g, min(hn::Add(p.k0, hn::Mul(p.k1, s)), zero())};
  }

  /// A plane's heights over both ends of a Kept interval.
  struct Bound {
    Height at, other;
    V slope;      ///< of the height along the ray
    double bend;  ///< a sixth of the bound on the third derivative
    Bound(const Certificate& c, const Plane& p, const Kept& kept, bool back)
        : at(height(p, kept.at, back)), other(height(p, kept.other, back)), slope(p.h1), bend(c.bend_) {}
    /// Whether both heights stay above `limit` for the time tau.
    M least(V limit, V tau) const {
      const V bent = hn::Mul(set(bend), tau);
      return hn::Ge(min(min(at.h, other.h), min(at.after(tau, bent), other.after(tau, bent))), limit);
    }
  };

  /// The time after p's pose at which, to first order, a point of the ray lies on both planes: where an edge passes the
  /// ray, or near the point where the ray touches the envelope.
  static V crossing(const Bound& p, const Bound& q, V span) {
    // Near `at`, the height over p is h + slope x + g τ + k τ², and so is that over q with span − τ. Setting both to
    // zero and eliminating x gives a quadratic equation c0 + c1 τ + c2 τ² = 0. Planes parallel to the ray have no such
    // point; for them only heights are compared.
    const V a = max(abs(p.slope), set(0.1)), b = max(abs(q.slope), set(0.1)), two = set(2);
    const V c0 =
        hn::Sub(hn::Mul(b, p.at.h), hn::Mul(a, hn::Add(q.at.h, hn::Mul(span, hn::Add(q.at.g, hn::Mul(q.at.k, span))))));
    const V c1 = hn::Add(hn::Mul(b, p.at.g), hn::Mul(a, hn::Add(q.at.g, hn::Mul(two, hn::Mul(q.at.k, span)))));
    const V c2 = hn::Sub(hn::Mul(b, p.at.k), hn::Mul(a, q.at.k));
    const V disc = hn::Sub(hn::Mul(c1, c1), hn::Mul(set(4), hn::Mul(c0, c2)));
    const V root = sqrt(max(disc, zero())), per = hn::Sub(with_sign(root, c0), c1);
    const M good = both(hn::Gt(disc, zero()), hn::Not(hn::Eq(per, zero())));
    const V tau = pick(good, hn::Div(hn::Mul(two, c0), pick(good, per, set(1))), hn::Mul(set(0.5), span));
    return min(max(tau, hn::Mul(set(0.03), span)), hn::Mul(set(0.97), span));
  }

  const TurningBody& b_;
  double bend_;
};

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
