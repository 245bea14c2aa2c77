#include "sweep/swept_distance.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace riffler::sweep {
namespace {

double distance_at(const tool::Outline& cutter, const Motion& motion, const Vec3& p, double t) {
  const Vec3 from_tip = p - motion.tip(t);
  const Vec3 axis = motion.axis(t);
  const double z = glm::dot(from_tip, axis);
  return cutter.nearest(glm::length(from_tip - z * axis), z).distance;
}

/// Largest speed of a material point at `p`, mm per unit of time: of its parts by the tip and by the turn.
double speed_at(const Motion& motion, const Vec3& p) {
  const Vec3 travel = motion.to().tip - motion.from().tip;
  const double reach = std::max(glm::length(p - motion.from().tip), glm::length(p - motion.to().tip));
  return glm::length(travel) + motion.angle() * reach;
}

/// A span of time and the distance at its middle.
struct Span {
  double middle, half;
  double distance;
};

}  // namespace

double swept_distance(const tool::Outline& cutter, const Motion& motion, const Vec3& p, double enough, double slack) {
  const double speed = speed_at(motion, p);
  double best = distance_at(cutter, motion, p, 0.5);
  // Halves, the more promising one first: at most one span of each size waits.
  std::array<Span, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {0.5, 0.5, best};
  while (depth > 0) {
    const Span span = stack[--depth];
    const double reach = speed * span.half;  // no distance within the span is smaller by more than this
    if (reach <= slack || span.distance - reach >= std::min(best - slack, enough) || depth + 2 > stack.size()) continue;
    const double half = 0.5 * span.half;
    Span first{span.middle - half, half, distance_at(cutter, motion, p, span.middle - half)};
    Span second{span.middle + half, half, distance_at(cutter, motion, p, span.middle + half)};
    best = std::min({best, first.distance, second.distance});
    if (first.distance < second.distance) std::swap(first, second);
    stack[depth++] = first;
    stack[depth++] = second;
  }
  return best;
}

}  // namespace riffler::sweep
