// The smallest value of a convex function of one variable, from values and slopes, with a bound on its error.
#pragma once

#include <algorithm>
#include <cmath>

namespace riffler::reference {

/// A convex function's value at t, and its slope there; at a kink, any slope between those of both sides.
struct Tangent {
  double t, value, slope;
};

/// An interval that contains the smallest value of a function over a motion.
struct Bracket {
  double lower, upper;
  int poses;  ///< at which the function was evaluated
};

/// Where two tangents meet, if the function falls at a and rises at b.
inline double crossing(const Tangent& a, const Tangent& b) {
  return a.t + (a.value - b.value + b.slope * (b.t - a.t)) / (b.slope - a.slope);
}

/// Where the cubic with both tangents is smallest (Nocedal and Wright, Numerical Optimization, 2nd ed., (3.59)).
inline double cubic_least(const Tangent& a, const Tangent& b) {
  const double width = b.t - a.t, d = a.slope + b.slope + 3 * (a.value - b.value) / width;
  const double root = std::sqrt(std::max(d * d - a.slope * b.slope, 0.0));
  return b.t - width * (b.slope + root - d) / (b.slope - a.slope + 2 * root);
}

/// Bracket of the smallest value on [0, 1], at most `gap` wide, or entirely below `below` or above `above`. (It cannot
/// become narrower than rounding.) `tangent(t)` returns a Tangent.
///
/// A convex function lies above all its tangents, so the smallest value is at least where those of two points meet
/// between which it lies. The next point is where they meet, which finds a kink, or the smallest value of a cubic,
/// which finds a smooth minimum, by turns, and the middle where two of these have not halved the interval.
template <class Function>
Bracket least_of_convex(const Function& tangent, double gap, double below, double above) {
  Tangent a = tangent(0.0), b = tangent(1.0);
  if (a.slope >= 0) return {a.value, a.value, 2};
  if (b.slope <= 0) return {b.value, b.value, 2};
  double wide = 1;
  for (int evaluated = 2;; ++evaluated) {
    const double meet = crossing(a, b), best = std::min(a.value, b.value);
    const double lower = std::min(best, a.value + a.slope * (meet - a.t));
    if (best - lower <= gap || lower > above || best < below) return {lower, best, evaluated};
    const double middle = a.t + (b.t - a.t) / 2;
    double next = evaluated % 2 ? meet : cubic_least(a, b);
    if (evaluated % 3 == 1) {
      if (b.t - a.t > wide / 2) next = middle;
      wide = b.t - a.t;
    }
    if (!(next > a.t && next < b.t)) next = middle;
    if (!(next > a.t && next < b.t)) return {lower, best, evaluated};
    const Tangent c = tangent(next);
    if (c.slope == 0) return {c.value, c.value, evaluated + 1};
    (c.slope < 0 ? a : b) = c;
  }
}

}  // namespace riffler::reference
