#include "riffler/plan/lift.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "plan/point_lift.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr int kLooksAReport = 16;
constexpr double kLoose = 0.1;  // of the depth found at the height before

class Climb {
 public:
  Climb(const collide::Collider& collider, const collide::Assembly& assembly, const Pose& pose, const LiftRule& rule)
      : collider_(collider),
        assembly_(assembly),
        pose_(pose),
        rule_(rule),
        columns_(assembly.outline(), rule.clearance) {}

  Lift run() {
    double h = 0, last = 0;
    while (look(h), out_.clearance = now_.distance, now_.distance < rule_.clearance - rule_.tolerance) {
      out_.touch = now_.touch, out_.point = now_.point;
      if (h > rule_.max_lift || out_.evaluations >= rule_.max_evaluations) return ended(h, false);
      double to = std::max(blocked().to, std::nextafter(h, 2 * rule_.max_lift));
      // Newton steps shrink fast. Steps that do not are a wall, or approach an edge of the tool at a constant ratio:
      // then look most of the distance ahead to their limit.
      const double step = to - h, ratio = last > 0 ? step / last : 0;
      if (ratio > 0.25) to = ahead(to, step * (ratio < 0.8 ? 0.9 * ratio / (1 - ratio) : 4));
      last = step, h = to;
    }
    if (h == 0) out_.touch = now_.touch, out_.point = now_.point;
    // No surface intersects the tool: it is outside, or entirely inside the material.
    out_.swallowed = collider_.inside_part(pose_.tip + (h + 0.5 * assembly_.tool().length()) * pose_.axis);
    return ended(h, h <= rule_.max_lift && !out_.swallowed);
  }

 private:
  struct Range {
    double from, to;
  };

  Lift ended(double h, bool free) {
    out_.height = h, out_.free = free;
    return out_;
  }

  void look(double h) {
    at_ = h;
    if (out_.evaluations % kLooksAReport == 0) base::still_wanted();
    const Pose pose{pose_.tip + h * pose_.axis, pose_.axis};
    // Any point that blocks a height serves to climb. Where the nearest was deep, it need not be the deepest.
    const double loose = out_.evaluations > 0 ? kLoose * (rule_.clearance - now_.distance) : 0;
    now_ = collider_.nearest(assembly_, pose, std::max(loose, 0.0));
    if (loose > 0 && !(now_.distance < rule_.clearance - rule_.tolerance)) now_ = collider_.nearest(assembly_, pose);
    if (++out_.evaluations == 1) out_.before = now_.distance;
  }

  /// Range of heights around the current one that are blocked by the point found there.
  Range blocked() const {
    const Vec3 d = now_.point - pose_.tip;
    const double up = glm::dot(d, pose_.axis), z = up - at_, rho = glm::length(d - up * pose_.axis);
    const OffsetToolColumns::Column column = columns_.at(rho, z);
    // The depth in a fixture equals its thickness even where none of its points is inside the tool: then only its depth
    // is known.
    return column.covered ? Range{up - column.high, up - column.low}
                          : Range{at_, at_ + rule_.clearance - now_.distance};
  }

  /// All heights up to `to` are blocked. Returns how far this holds beyond `to`, as proven with look-ahead distances
  /// that double.
  double ahead(double to, double step) {
    while (to <= rule_.max_lift && out_.evaluations < rule_.max_evaluations) {
      look(to + step);
      if (!(now_.distance < rule_.clearance)) break;
      const Range range = blocked();
      if (!(range.from <= to && range.to > to)) break;
      out_.touch = now_.touch, out_.point = now_.point;
      to = range.to, step *= 2;
    }
    return to;
  }

  const collide::Collider& collider_;
  const collide::Assembly& assembly_;
  const Pose pose_;
  const LiftRule& rule_;
  const OffsetToolColumns columns_;
  collide::Collider::Nearest now_{};
  double at_ = 0;
  Lift out_;
};

}  // namespace

void validate(const LiftRule& rule) {
  base::require(std::isfinite(rule.clearance), "clearance", "must be finite");
  base::require_positive(rule.tolerance, "tolerance", base::kPositiveAndFinite);
  base::require_not_negative(rule.max_lift, "max_lift", base::kFiniteAndNotNegative);
  if (rule.max_evaluations < 1) throw std::invalid_argument("max_evaluations must be at least 1");
}

Lift lift(const collide::Collider& collider, const collide::Assembly& assembly, const Pose& pose,
          const LiftRule& rule) {
  validate(rule);
  return Climb(collider, assembly, pose, rule).run();
}

}  // namespace riffler::plan
