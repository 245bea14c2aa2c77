// Cuts with a convex polytope between two poses, many rays at a time. hull_part.hpp explains the geometry.
#if defined(RIFFLER_SWEEP_HULL_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_HULL_LANES_INL_HPP
#undef RIFFLER_SWEEP_HULL_LANES_INL_HPP
#else
#define RIFFLER_SWEEP_HULL_LANES_INL_HPP
#endif

#include <algorithm>
#include <bit>

#include "sweep/hull_part.hpp"
#include "sweep/lanes/cut_lanes-inl.hpp"
#include "sweep/lanes/packed_rays-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// A vector of rays, heights from the tip at the start, and what the body sweeps of each.
class HullLanes {
 public:
  struct End {
    V s, time;  // time τ of the part, 0 … 1
    M found;
  };

  HullLanes(const HullBody& body, V u, V v)
      : b_(body), x_(hn::Sub(u, set(b_.tip[0]))), y_(hn::Sub(v, set(b_.tip[1]))), slack_(set(body.slack)) {
    V enter[2] = {set(-kInfinity), set(-kInfinity)}, leave[2] = {set(kInfinity), set(kInfinity)};
    V outer_near = enter[0], outer_far = leave[0];
    M off[2] = {no_lane(), no_lane()};
    for (std::size_t k = 0; k < b_.faces.size(); ++k) {
      const HullFace& f = b_.faces[k];
      V crossing[2];
      for (int pose = 0; pose < 2; ++pose) {
        const double* n = f.at[pose];
        const V h = hn::Sub(hn::Add(hn::Mul(x_, set(n[0])), hn::Mul(y_, set(n[1]))), set(f.off[pose]));
        hn::StoreU(h, kD, height(k, pose));
        crossing[pose] = hn::Neg(hn::Mul(h, set(f.inverse[pose])));
        if (f.inverse[pose] > 0)
          leave[pose] = min(leave[pose], crossing[pose]);
        else if (f.inverse[pose] < 0)
          enter[pose] = max(enter[pose], crossing[pose]);
        else
          off[pose] = either(off[pose], hn::Gt(h, slack_));
      }
      if (f.inverse[0] < 0 && f.inverse[1] < 0) outer_near = max(outer_near, min(crossing[0], crossing[1]));
      if (f.inverse[0] > 0 && f.inverse[1] > 0) outer_far = min(outer_far, max(crossing[0], crossing[1]));
    }
    for (int pose = 0; pose < 2; ++pose)
      pose_[pose] = where(without(hn::Le(enter[pose], leave[pose]), off[pose]), {enter[pose], leave[pose]});
    outer_ = {outer_near, outer_far};
  }

  /// Finds both ends in the lanes of `mask`, between the heights of the material.
  void find(M mask, V low, V high) {
    low_ = low, high_ = high;
    const V start = max(outer_.near, low), stop = min(outer_.far, high);
    near = march<1>(both(mask, hn::Le(start, stop)), start, stop);
    far = march<-1>(near.found, stop, near.s);
    // Rounding may let go of a ray that hardly touches the body.
    near.found = far.found;
  }

  /// Lanes in which everything between both ends is swept. For a fixed height the times inside are an interval, and
  /// for a fixed time the heights, so what is swept falls apart only if the body at neither end's time reaches the
  /// other's.
  M joined() const {
    if (b_.narrow) return near.found;
    // Within the material, as faces beyond it may be left out.
    const M common = hn::Ge(min(min(pose_[0].far, pose_[1].far), high_), max(max(pose_[0].near, pose_[1].near), low_));
    if (none(without(near.found, common))) return near.found;
    const RayIntervals first = at(near.time), last = at(far.time);
    V left = first.far, right = last.near;
    M whole = either(either(common, hn::Ge(left, right)), close(first, last));
    constexpr int kMost = 6;
    for (int k = 0; k < kMost && !none(without(near.found, whole)); ++k) {
      V way, time;
      const V middle = hn::Mul(set(0.5), hn::Add(left, right));
      const M inside = both(without(near.found, whole), look<1>(middle, way, time));
      if (none(inside)) break;
      const RayIntervals between = at(time);
      const M to_left = both(inside, hn::Le(between.near, left)), to_right = both(inside, hn::Ge(between.far, right));
      left = pick(to_left, max(left, between.far), left), right = pick(to_right, min(right, between.near), right);
      whole = either(whole, hn::Ge(left, right));
    }
    return both(near.found, whole);
  }

  /// The ray's interval in the body at a time.
  RayIntervals at(V time) const {
    RayIntervals out = everything();
    const V rest = hn::Sub(set(1), time);
    for (std::size_t k = 0; k < b_.faces.size(); ++k) {
      const HullFace& f = b_.faces[k];
      const V h = hn::Add(hn::Mul(rest, load(k, 0)), hn::Mul(time, load(k, 1)));
      const V slope = hn::Add(hn::Mul(rest, set(f.at[0][2])), hn::Mul(time, set(f.at[1][2])));
      const M rises = hn::Gt(slope, zero()), falls = hn::Lt(slope, zero());
      const V crossing = hn::Div(hn::Sub(slack_, h), pick(either(rises, falls), slope, set(1)));
      out.far = pick(rises, min(out.far, crossing), out.far);
      out.near = pick(falls, max(out.near, crossing), out.near);
    }
    return out;
  }

  End near, far;

 private:
  /// Lanes in which the body sweeps what lies between what it has of a ray at two times within a share of the
  /// tolerance. For two of its points P and Q, and all between them, it takes P at the first time straight to Q at the
  /// second but for φ |P − Q| / 4 + φ² ρ / 8, where φ is the turn between and ρ their distance from the tip (methods:
  /// "Hand tools").
  M close(const RayIntervals& first, const RayIntervals& last) const {
    constexpr double kShare = 0.5;
    const V time = hn::Sub(far.time, near.time), turn = hn::Mul(abs(time), set(b_.angle));
    const V along = hn::Mul(time, set(b_.way[2]));
    // The points may lie anywhere in the two intervals: the most and the least difference of their heights in the body.
    const V most = hn::Add(hn::Sub(min(first.far, high_), max(last.near, low_)), along);
    const V least = hn::Add(hn::Sub(max(first.near, low_), min(last.far, high_)), along);
    const V apart = max(max(least, hn::Neg(most)), zero());
    const double across = b_.way[0] * b_.way[0] + b_.way[1] * b_.way[1];
    const V beside = sqrt(hn::Add(hn::Mul(apart, apart), hn::Mul(hn::Mul(time, time), set(across))));
    const V out =
        sqrt(hn::Add(hn::Add(hn::Mul(x_, x_), hn::Mul(y_, y_)), max(hn::Mul(near.s, near.s), hn::Mul(far.s, far.s))));
    const V reach = hn::Mul(turn, hn::Add(out, set(b_.moved)));
    const V error = hn::Mul(turn, hn::Add(hn::Mul(set(0.25), beside), hn::Mul(set(0.375), reach)));
    return hn::Le(error, set(kShare * b_.part.tolerance));
  }

  double* height(std::size_t face, int pose) const { return b_.heights.data() + (2 * face + pose) * base::kLanes; }
  V load(std::size_t face, int pose) const { return hn::LoadU(kD, height(face, pose)); }

  /// Heights over a face at both poses, and their slopes in the direction of a march.
  struct Bound {
    V at0, at1, slope0, slope1;
  };
  static Bound choose(M m, const Bound& yes, const Bound& no) {
    return {pick(m, yes.at0, no.at0), pick(m, yes.at1, no.at1), pick(m, yes.slope0, no.slope0),
            pick(m, yes.slope1, no.slope1)};
  }
  /// How far until a height falls to 0, or infinity.
  static V fall(V height, V slope) {
    const M falls = hn::Lt(slope, zero());
    return pick(falls, hn::Div(height, pick(falls, hn::Neg(slope), set(1))), set(kInfinity));
  }

  /// The first height, from `start` on in direction kDir, at which the ray is inside at some time. Every step passes
  /// over heights that are certainly outside at all times: where one face is outside at both poses, or where the time
  /// at which the body leaves one face is later than that at which it reaches another.
  template <int kDir>
  End march(M mask, V start, V stop) const {
    End out{start, zero(), no_lane()};
    for (int pose = 0; pose < 2; ++pose) {
      const M here =
          both(without(mask, out.found), both(hn::Ge(start, pose_[pose].near), hn::Le(start, pose_[pose].far)));
      out.time = pick(here, set(pose), out.time), out.found = either(out.found, here);
    }
    M open = without(mask, out.found);
    constexpr int kMost = 64;
    for (int k = 0; k < kMost && !none(open); ++k) {
      V way, time;
      const M inside = look<kDir>(out.s, way, time);
      const M there = both(open, either(inside, hn::Le(way, set(b_.nearby))));
      out.time = pick(there, time, out.time), out.found = either(out.found, there);
      open = without(open, there);
      out.s = pick(open, hn::Add(out.s, hn::Mul(way, set(kDir))), out.s);
      open = both(open, kDir > 0 ? hn::Le(out.s, stop) : hn::Ge(out.s, stop));
    }
    out.found = either(out.found, open);
    return out;
  }

  /// Lanes that are inside at some time, which `time` gets; for the others, how far no height is inside.
  template <int kDir>
  M look(V s, V& way, V& time) const {
    V from = zero(), until = set(1), jump = zero();
    Bound last{zero(), set(-1), zero(), zero()}, first{set(-1), zero(), zero(), zero()};  // 0 ≤ τ and τ ≤ 1
    M outside = no_lane();
    for (std::size_t k = 0; k < b_.faces.size(); ++k) {
      const HullFace& f = b_.faces[k];
      const V at0 = hn::Add(load(k, 0), hn::Mul(s, set(f.at[0][2])));
      const V at1 = hn::Add(load(k, 1), hn::Mul(s, set(f.at[1][2])));
      const M out0 = hn::Gt(at0, slack_), out1 = hn::Gt(at1, slack_);
      if (none(either(out0, out1))) continue;
      const M all = both(out0, out1);
      if (!none(all)) {
        const double r0 = -kDir * f.inverse[0], r1 = -kDir * f.inverse[1];
        const V until_in =
            min(r0 > 0 ? hn::Mul(at0, set(r0)) : set(kInfinity), r1 > 0 ? hn::Mul(at1, set(r1)) : set(kInfinity));
        outside = either(outside, all), jump = pick(all, max(jump, until_in), jump);
      }
      const M enters = without(out0, out1), leaves = without(out1, out0);
      const M some = either(enters, leaves);
      if (none(some)) continue;
      const V at = hn::Div(at0, pick(some, hn::Sub(at0, at1), set(1)));
      const Bound bound{at0, at1, set(kDir * f.at[0][2]), set(kDir * f.at[1][2])};
      const M later = both(enters, hn::Gt(at, from)), earlier = both(leaves, hn::Lt(at, until));
      from = pick(later, at, from), last = choose(later, bound, last);
      until = pick(earlier, at, until), first = choose(earlier, bound, first);
    }
    const V q0 = hn::Sub(hn::Mul(first.at0, last.at1), hn::Mul(last.at0, first.at1));
    const V sizes = hn::Add(hn::Add(abs(first.at0), abs(first.at1)), hn::Add(abs(last.at0), abs(last.at1)));
    const M apart = both(hn::Gt(from, until), hn::Lt(q0, hn::Neg(hn::Mul(slack_, sizes))));
    way = pick(outside, jump, pair_root(first, last, q0));
    const V middle = min(max(hn::Mul(set(0.5), hn::Add(from, until)), zero()), set(1));
    time = pick(hn::Le(from, zero()), zero(), pick(hn::Ge(until, set(1)), set(1), middle));
    return hn::Not(either(outside, apart));
  }

  /// How far until the time at which `last` is left is no later than that at which `first` is reached: the first
  /// positive root of f0 l1 − l0 f1, and no farther than l0 > 0 and f1 > 0.
  static V pair_root(const Bound& f, const Bound& l, V q0) {
    const auto cross = [](V a, V b, V c, V d) { return hn::Sub(hn::Mul(a, b), hn::Mul(c, d)); };
    const V q1 = hn::Add(cross(f.at0, l.slope1, l.at0, f.slope1), cross(f.slope0, l.at1, l.slope0, f.at1));
    const V q2 = cross(f.slope0, l.slope1, l.slope0, f.slope1);
    const V square = hn::Sub(hn::Mul(q1, q1), hn::Mul(set(4), hn::Mul(q2, q0)));
    const V below = hn::Add(q1, sqrt(max(square, zero())));
    const M real = both(hn::Ge(square, zero()), hn::Gt(below, zero()));
    const V root = pick(real, hn::Div(hn::Mul(set(-2), q0), pick(real, below, set(1))), set(kInfinity));
    return min(root, min(fall(l.at0, l.slope0), fall(f.at1, f.slope1)));
  }

  const HullBody& b_;
  V x_, y_;
  V slack_, low_ = zero(), high_ = zero();
  RayIntervals pose_[2], outer_;
};

class HullCut {
 public:
  HullCut(const HullBody& body, RayWindow& window) : body_(body), w_(window) {}

  void cut() {
    PackedRays rays(w_);
    w_.hits += static_cast<unsigned>(rays.count());
    for (int k = 0; k < rays.count(); k += lanes()) {
      const Rays here{rays.u(k), rays.v(k), rays.low(k), rays.high(k), rays.place(k)};
      RayIntervals found = nothing();
      V times[2] = {zero(), zero()};
      const M present = rays.present(k);
      if (!beside(here, present)) sweep(body_, 0, here, present, &found, times);
      rays.store(k, 0, found.near), rays.store(k, 1, found.far);
      rays.store(k, 2, times[0]), rays.store(k, 3, times[1]);
    }
    take_others();
    rays.each_group(w_, [&](double u, const Group& g, const auto& result) {
      subtract(w_, u, g, g.active, {result(0), result(1)}, result(2), result(3));
    });
  }

 private:
  struct Rays {
    V u, v, low, high, place;
  };
  struct Other {
    int ray;
    RayCut cut;
  };

  /// Whether one face has all material of the rays in `mask` on its outer side at both poses, hence during the part:
  /// heights are linear in time as well as along a ray. Neighbours mostly need the same face. The margin makes it
  /// certain that the march would find nothing either, so what a ray gets does not depend on its neighbours.
  bool beside(const Rays& rays, M mask) {
    const V x = hn::Sub(rays.u, set(body_.tip[0])), y = hn::Sub(rays.v, set(body_.tip[1])), tip = set(body_.tip[2]);
    const V low = hn::Sub(rays.low, tip), high = hn::Sub(rays.high, tip), margin = set(4 * body_.slack);
    const std::size_t count = body_.faces.size();
    for (std::size_t tried = 0, k = last_; tried < count; ++tried, k = k + 1 < count ? k + 1 : 0) {
      M outside = mask;
      for (int pose = 0; pose < 2 && !none(outside); ++pose) {
        const HullFace& f = body_.faces[k];
        const double* n = f.at[pose];
        const V h = hn::Sub(hn::Add(hn::Mul(x, set(n[0])), hn::Mul(y, set(n[1]))), set(f.off[pose]));
        const V lowest = min(hn::Add(h, hn::Mul(low, set(n[2]))), hn::Add(h, hn::Mul(high, set(n[2]))));
        outside = both(outside, hn::Gt(lowest, margin));
      }
      if (!none(without(mask, outside))) {
        if (tried == 0 && met_) return false;  // the vector before was met: this one probably is
        continue;
      }
      last_ = k;
      return true;
    }
    return false;
  }

  /// What a part sweeps of the rays in `mask`: one interval each in `found`, if that is not null, and others. Where the
  /// two ends are not known to belong together, both halves of the part are swept.
  void sweep(const HullBody& body, int depth, const Rays& rays, M mask, RayIntervals* found, V* times) {
    const V tip = set(body.tip[2]);
    HullLanes hull(body, rays.u, rays.v);
    hull.find(mask, hn::Sub(rays.low, tip), hn::Sub(rays.high, tip));
    const M met = hull.near.found;
    if (depth == 0) met_ = !none(met);
    if (none(met)) return;
    const M whole = hull.joined(), rest = without(met, whole);
    const V near = hn::Add(hull.near.s, tip), far = hn::Add(hull.far.s, tip);
    const V t_near = time_at(body, hull.near.time), t_far = time_at(body, hull.far.time);
    if (found) {
      *found = where(whole, {near, far});
      times[0] = t_near, times[1] = t_far;
    } else {
      add(rays, whole, near, far, t_near, t_far);
    }
    if (none(rest)) return;
    constexpr int kDeepest = 20;
    if (depth == kDeepest) {  // what is certainly swept at each end
      add(rays, rest, near, min(hn::Add(hull.at(hull.near.time).far, tip), rays.high), t_near, t_near);
      add(rays, rest, max(hn::Add(hull.at(hull.far.time).near, tip), rays.low), far, t_far, t_far);
      return;
    }
    HullPart half = body.part;
    const double middle = (half.t0 + half.t1) / 2;
    half.t1 = middle, half.error /= 4;
    sweep_half(half, depth + 1, rays, rest);
    half.t0 = middle, half.t1 = body.part.t1;
    sweep_half(half, depth + 1, rays, rest);
  }

  void sweep_half(const HullPart& half, int depth, const Rays& rays, M mask) {
    const HullBody body(half, body_.box);
    if (!body.beside) sweep(body, depth, rays, mask, nullptr, nullptr);
  }

  static V time_at(const HullBody& body, V time) {
    const HullPart& p = body.part;
    return pick(hn::Ge(time, set(1)), set(p.t1), hn::Add(set(p.t0), hn::Mul(time, set(p.t1 - p.t0))));
  }

  void add(const Rays& rays, M mask, V near, V far, V t_near, V t_far) {
    unsigned m = bits(both(mask, hn::Gt(hn::Sub(far, near), set(w_.thinnest))));
    if (!m) return;
    double place[base::kLanes], n[base::kLanes], f[base::kLanes], tn[base::kLanes], tf[base::kLanes];
    hn::StoreU(rays.place, kD, place), hn::StoreU(near, kD, n), hn::StoreU(far, kD, f);
    hn::StoreU(t_near, kD, tn), hn::StoreU(t_far, kD, tf);
    for (; m; m &= m - 1) {
      const int k = std::countr_zero(m);
      others_.push_back({static_cast<int>(place[k]), {n[k], f[k], tn[k], tf[k]}});
    }
  }

  /// In the order of the rays, so that sums do not depend on how many rays are handled at once.
  void take_others() {
    std::sort(others_.begin(), others_.end(), [](const Other& a, const Other& b) {
      if (a.ray != b.ray) return a.ray < b.ray;
      return a.cut.near != b.cut.near ? a.cut.near < b.cut.near : a.cut.far < b.cut.far;
    });
    for (const Other& o : others_) w_.cut(w_.self, o.ray, o.cut);
  }

  const HullBody& body_;
  RayWindow& w_;
  base::BlockVector<Other> others_;
  std::size_t last_ = 0;  // the face that had the rays before on its outer side
  bool met_ = false;      // whether the body met one of the last rays looked at
};

inline void cut_hull_lanes(const HullBody& body, RayWindow& window) {
  HullCut(body, window).cut();
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
