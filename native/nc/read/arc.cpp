#include "nc/read/arc.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"

namespace riffler::nc {

namespace {

[[noreturn]] void fail_miss(double miss) {
  char text[128];
  std::snprintf(text, sizeof text, "the arc's end misses its circle by %.4f mm%s", miss,
                miss <= kMaxArcMiss ? ": option arc_tolerance allows more" : "");
  throw std::invalid_argument(text);
}

/// An arc about `centre` between the circles through the two ends.
Arc between(const Vec2& from, const Vec2& to, const Vec2& centre, bool clockwise) {
  const Vec2 a = from - centre, b = to - centre;
  const double start = base::atan2(a.y, a.x);
  // Angle from a to b in the direction of travel, (0, 2 π].
  double sweep = base::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
  if (clockwise) sweep = -sweep;
  if (glm::length(to - from) < kFullCircle)
    sweep = kTwoPi;
  else if (sweep <= 0)
    sweep += kTwoPi;
  return {centre, glm::length(a), glm::length(b), start, clockwise ? -sweep : sweep};
}

}  // namespace

Arc Arc::with_turns(int turns) const {
  Arc out = *this;
  out.sweep += std::copysign(kTwoPi * (turns - 1), sweep);
  return out;
}

Vec2 Arc::at(double t) const {
  const double r = r0 + t * (r1 - r0), angle = start + t * sweep;
  return centre + r * Vec2(base::cos(angle), base::sin(angle));
}

double Arc::length() const {
  return std::abs(sweep) * (r0 + r1) / 2;
}

int Arc::chords(double tolerance) const {
  // Sagitta r (1 − cos h) = 2 r sin²(h / 2) of a chord over the angle 2 h; at most half a right angle, so that small
  // circles keep their shape.
  const double r = std::max(r0, r1);
  const double half = 2 * base::asin(std::min(1.0, std::sqrt(tolerance / (2 * r))));
  const double step = std::min(2 * half, kPi / 4);
  return std::max(1, static_cast<int>(std::min(1e9, std::ceil(std::abs(sweep) / step))));
}

Arc arc_about(const Vec2& from, const Vec2& to, const Vec2& centre, bool clockwise, double miss) {
  const Arc arc = between(from, to, centre, clockwise);
  if (std::abs(arc.r1 - arc.r0) > miss) fail_miss(std::abs(arc.r1 - arc.r0));
  if (!(arc.r0 > 0 && arc.r1 > 0)) throw std::invalid_argument("an arc of radius 0");
  if (!(std::min(arc.r0, arc.r1) >= kMinRadius))
    throw std::invalid_argument("an arc about its centre with a radius below 0.00127 mm");
  return arc;
}

Arc arc_of_radius(const Vec2& from, const Vec2& to, double radius, bool clockwise, double miss) {
  const double r = std::abs(radius);
  const Vec2 chord = to - from;
  const double length = glm::length(chord);
  if (!(r > 0)) throw std::invalid_argument("an arc of radius 0");
  if (length < kFullCircle) throw std::invalid_argument("a full circle by R has no centre");
  // On the circle through the start with the nearest possible centre, the end misses by the excess length of the chord.
  if (length - 2 * r > miss) fail_miss(length - 2 * r);
  const double height = std::sqrt(std::max(0.0, (r - length / 2) * (r + length / 2)));
  // Seen along the chord, the centre of the shorter arc is on the right if clockwise, otherwise on the left.
  const double side = (clockwise == (radius > 0)) ? -1 : 1;
  const Vec2 left(-chord.y / length, chord.x / length);
  const Vec2 centre = (from + to) / 2.0 + side * height * left;
  Arc arc = between(from, to, centre, clockwise);
  // The directions of a half circle differ only by rounding, so use R's.
  if (height == 0) arc.sweep = clockwise ? -kPi : kPi;
  return arc;
}

Arc tangent_arc(const Vec2& from, const Vec2& to, const Vec2& direction, double miss) {
  constexpr double kOnLine = 1e-9;  // mm
  if (!(glm::length(direction) > 1e-6))
    throw std::invalid_argument("CT without an element before it whose direction it could take");
  const Vec2 tangent = glm::normalize(direction), left(-tangent.y, tangent.x), chord = to - from;
  if (!(glm::length(chord) > kFullCircle)) throw std::invalid_argument("CT that ends where it begins");
  const double aside = glm::dot(chord, left);
  if (!(std::abs(aside) > kOnLine)) throw std::invalid_argument("CT to a point straight ahead or behind: write a line");
  const double radius = glm::dot(chord, chord) / (2 * aside);
  if (!(std::abs(radius) <= kMaxLength)) throw std::invalid_argument("CT of a radius that is out of range");
  return arc_about(from, to, from + radius * left, radius < 0, miss);
}

}  // namespace riffler::nc
