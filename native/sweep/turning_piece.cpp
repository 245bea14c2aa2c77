#include "sweep/turning_piece.hpp"

#include <algorithm>
#include <cmath>

namespace riffler {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kDeepest = 24;   // halvings of a part in which a ray is met twice
constexpr int kMostHits = 60;  // of a bracket; a handful is usual
constexpr double kStop = 0.1;  // of the tolerance: what the search for an extreme may leave
/// |n · d| below which a face bends a(t) too much to trust two tangents across its edge.
constexpr double kEdgeOn = 0.25;
}  // namespace

struct TurningPiece::Sample {
  double t;
  bool hit;
  SweptHit near, far;
};

/// The derivative of a(t), or of −b(t) for the far end: negative where the stretch still grows.
struct TurningPiece::Slope {
  double rate;
  double facing;  // |n · d|
};

void SweptIntervals::add(const SweptInterval& interval) {
  SweptInterval merged = interval;
  int kept = 0;
  for (int k = 0; k < count_; ++k) {
    const SweptInterval& o = items_[k];
    if (o.far.s < merged.near.s || o.near.s > merged.far.s) {
      items_[kept++] = o;
      continue;
    }
    if (o.near.s < merged.near.s) merged.near = o.near, merged.near_t = o.near_t;
    if (o.far.s > merged.far.s) merged.far = o.far, merged.far_t = o.far_t;
  }
  if (kept == kMost) --kept;  // more stretches than a convex piece can make in one part: keep the newest
  items_[kept] = merged;
  count_ = kept + 1;
}

TurningPiece::TurningPiece(const Piece& piece, const Motion& motion, double t0, double t1, double tolerance)
    : piece_(piece),
      motion_(&motion),
      t0_(t0),
      t1_(t1),
      tolerance_(tolerance),
      first_(at(t0)),
      last_(at(t1)),
      straight_(piece, motion.tip(t0), motion.axis((t0 + t1) / 2), motion.tip(t1) - motion.tip(t0)) {}

TurningPiece::Sample TurningPiece::sample(double u, double v, double t, const SweptPiece& body) const {
  Sample s{t, false, {}, {}};
  s.hit = body.hit(u, v, s.near, s.far);
  return s;
}

TurningPiece::Sample TurningPiece::sample(double u, double v, double t) const {
  return sample(u, v, t, at(t));
}

void TurningPiece::hit(double u, double v, const Interval& material, SweptIntervals& out) const {
  part(u, v, material, sample(u, v, t0_, first_), sample(u, v, t1_, last_), 0, out);
}

TurningPiece::Slope TurningPiece::slope(double u, double v, const Sample& s, bool far) const {
  const SweptHit& hit = far ? s.far : s.near;
  const Vec3 n = (s.t == t0_ ? first_ : s.t == t1_ ? last_ : at(s.t)).normal(u, v, hit);
  const double rate = glm::dot(n, motion_->velocity({u, v, hit.s}, s.t)), facing = std::abs(n.z);
  // The ray enters where n.z < 0 and leaves where n.z > 0, so both cases divide by −|n.z|.
  return {rate == 0 ? 0 : -rate / facing, facing};
}

void TurningPiece::part(double u, double v, const Interval& material, const Sample& from, const Sample& to, int depth,
                        SweptIntervals& out) const {
  if (!from.hit && !to.hit) {
    const Sample middle = inside(u, v, from.t, to.t);
    if (!middle.hit) return;
    const Sample near0 = extreme(u, v, false, from, middle, material.near),
                 near1 = extreme(u, v, false, middle, to, material.near);
    const Sample far0 = extreme(u, v, true, from, middle, material.far),
                 far1 = extreme(u, v, true, middle, to, material.far);
    const Sample& near = near0.near.s < near1.near.s ? near0 : near1;
    const Sample& far = far0.far.s > far1.far.s ? far0 : far1;
    return out.add({near.near, far.far, near.t, far.t});
  }
  const bool apart = from.hit && to.hit && (from.far.s < to.near.s || to.far.s < from.near.s);
  if (apart && depth < kDeepest) {
    // The piece runs along the ray: halve until neighbouring poses overlap. Never a hull across a gap.
    const Sample middle = sample(u, v, (from.t + to.t) / 2);
    part(u, v, material, from, middle, depth + 1, out);
    if (middle.hit || depth + 1 < kDeepest) part(u, v, material, middle, to, depth + 1, out);
    return;
  }
  if (apart) {
    out.add({from.near, from.far, from.t, from.t});
    return out.add({to.near, to.far, to.t, to.t});
  }
  const Sample near = extreme(u, v, false, from, to, material.near), far = extreme(u, v, true, from, to, material.far);
  out.add({near.near, far.far, near.t, far.t});
}

/// The pose between `from` and `to` (one of them at least meets the ray) at which the stretch reaches lowest, or
/// highest for `far`. Stops early once the end lies beyond the material.
TurningPiece::Sample TurningPiece::extreme(double u, double v, bool far, const Sample& from, const Sample& to,
                                           double beyond) const {
  const auto value = [&](const Sample& s) { return !s.hit ? kInfinity : far ? -s.far.s : s.near.s; };
  const double enough = far ? -beyond : beyond;
  Sample low = from, high = to;
  double f0 = value(low), f1 = value(high);
  Sample best = f0 <= f1 ? low : high;
  if (value(best) < enough) return best;
  Slope g0 = low.hit ? slope(u, v, low, far) : Slope{-kInfinity, 0};
  Slope g1 = high.hit ? slope(u, v, high, far) : Slope{kInfinity, 0};
  const auto surface = [&](const Sample& s) { return far ? s.far.surface : s.near.surface; };
  for (int i = 0; i < kMostHits && g0.rate < 0 && g1.rate > 0; ++i) {
    const double width = high.t - low.t;
    double t = (low.t + high.t) / 2;
    const bool both = low.hit && high.hit && std::isfinite(g0.rate) && std::isfinite(g1.rate);
    if (both && (surface(low) == surface(high) || std::min(g0.facing, g1.facing) > kEdgeOn)) {
      // Both tangents lie below a convex function: where they cross is below its minimum. Near an edge-on face the
      // function may bend the other way; then they cross outside or too high, and halving goes on.
      const double cross = (f1 - f0 - g1.rate * width) / (g0.rate - g1.rate), bound = f0 + g0.rate * cross;
      if (cross > 0 && cross < width && bound <= value(best)) {
        if (value(best) - bound <= kStop * tolerance_) break;
        const double secant = -g0.rate / (g1.rate - g0.rate) * width;
        t = low.t + std::clamp(i % 2 == 0 ? secant : cross, 0.02 * width, 0.98 * width);
      }
    }
    if (std::min(-g0.rate, g1.rate) * width <= kStop * tolerance_ && std::max(-g0.rate, g1.rate) * width <= tolerance_)
      break;
    if (!(t > low.t && t < high.t)) break;
    const Sample s = sample(u, v, t);
    if (!s.hit) {
      // The ray is not met there: beyond the end at which it is not met either, or in a gap that a shorter part shows.
      if (!high.hit)
        high = s, f1 = kInfinity, g1 = {kInfinity, 0};
      else if (!low.hit)
        low = s, f0 = kInfinity, g0 = {-kInfinity, 0};
      else
        break;
      continue;
    }
    if (value(s) < value(best)) best = s;
    if (value(best) < enough) break;
    const Slope g = slope(u, v, s, far);
    if (g.rate < 0)
      low = s, f0 = value(s), g0 = g;
    else
      high = s, f1 = value(s), g1 = g;
  }
  return best;
}

/// A pose strictly between two that miss the ray at which the piece meets it, if there is one.
TurningPiece::Sample TurningPiece::inside(double u, double v, double t0, double t1) const {
  const double middle = (t0 + t1) / 2, half = (t1 - t0) / 2;
  // No point of the piece that could meet the ray comes further than this from where it is in the middle.
  const Vec3 way = motion_->tip(t1) - motion_->tip(t0);
  const double lever = std::hypot(std::max(std::abs(bottom(piece_)), std::abs(top(piece_))), max_radius(piece_));
  const double reach = glm::length(way) / 2 + lever * motion_->angle() * half;
  if (at(middle).clearance(u, v, reach) > reach) return {middle, false, {}, {}};
  SweptHit near, far;
  double guess = middle;
  if (straight_.hit(u, v, near, far) && glm::length(way) > 0) {
    guess = t0_ + (near.way + far.way) / 2 / glm::length(motion_->tip(t1_) - motion_->tip(t0_)) * (t1_ - t0_);
    guess = std::clamp(guess, t0, t1);
  }
  Sample best = sample(u, v, guess);
  if (best.hit) return best;
  // Golden section on the clearance, convex in t.
  const double golden = 0.6180339887498949;
  double a = t0, b = t1, x = b - golden * (b - a), y = a + golden * (b - a);
  double fx = at(x).clearance(u, v, 0), fy = at(y).clearance(u, v, 0);
  for (int i = 0; i < 24; ++i) {
    if (std::min(fx, fy) <= 0) {
      best = sample(u, v, fx < fy ? x : y);
      if (best.hit) return best;
    }
    if (fx < fy)
      b = y, y = x, fy = fx, x = b - golden * (b - a), fx = at(x).clearance(u, v, 0);
    else
      a = x, x = y, fx = fy, y = a + golden * (b - a), fy = at(y).clearance(u, v, 0);
  }
  return best;
}

Vec3 TurningPiece::normal(double u, double v, const SweptHit& hit, double t) const {
  const Vec3 n = at(t).normal(u, v, hit);
  const Vec3 p{u, v, hit.s}, velocity = motion_->velocity(p, t);
  const double speed = glm::length(velocity);
  const bool end = t == 0 || t == 1;
  if (end || !(std::abs(glm::dot(n, velocity)) > 0.05 * speed)) return n;
  // An extreme within the part with n · v ≠ 0 lies on an edge of the piece: the edge sweeps the surface.
  const Vec3 axis = motion_->axis(t), w = p - motion_->tip(t), out = w - glm::dot(w, axis) * axis;
  const Vec3 swept = glm::cross(glm::cross(axis, out), velocity);
  const double length = glm::length(swept);
  if (!(length > 1e-9 * speed * glm::length(out))) return n;
  return swept * ((glm::dot(swept, out) < 0 ? -1.0 : 1.0) / length);
}

}  // namespace riffler
