#include "sweep/swept_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

struct Span {
  double begin, end;
  double low;  // no distance within it is less
};

}  // namespace

double swept_distance(const tool::Outline& cutter, const Motion& motion, const Vec3& p, double enough, double slack) {
  const double speed = speed_at(motion, p);
  double best = std::min(distance_at(cutter, motion, p, 0), distance_at(cutter, motion, p, 1));
  // Halves, the more promising one first: at most one span of each size waits.
  std::array<Span, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, 1, best - speed};
  while (depth > 0) {
    const Span span = stack[--depth];
    if (span.low >= std::min(best - slack, enough)) continue;
    const double middle = 0.5 * (span.begin + span.end), quarter = 0.25 * (span.end - span.begin);
    best = std::min(best, distance_at(cutter, motion, p, middle));
    if (speed * quarter <= slack || depth + 2 > stack.size()) continue;
    Span first{span.begin, middle, distance_at(cutter, motion, p, span.begin + quarter) - speed * quarter};
    Span second{middle, span.end, distance_at(cutter, motion, p, span.end - quarter) - speed * quarter};
    best = std::min({best, first.low + speed * quarter, second.low + speed * quarter});
    if (first.low < second.low) std::swap(first, second);
    stack[depth++] = first;
    stack[depth++] = second;
  }
  return best;
}

}  // namespace riffler::sweep
