#include "plan/swept_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace riffler {

double displacement(const Motion& motion, const Assembly& assembly, double from, double to) {
  // A chord is shorter than its arc, but 2 sin(a/2) is not worth a sine.
  const double way = glm::length(motion.to().tip - motion.from().tip);
  return (way + motion.angle() * assembly.reach()) * (to - from);
}

SweptCheck swept_check(const Collider& collider, const Assembly& assembly, const Motion& motion, double wanted,
                       int max_evaluations, const Collider::Nearest* start, const Collider::Nearest* end) {
  SweptCheck out;
  out.clearance = std::numeric_limits<double>::infinity();
  const auto keep = [&](const Collider::Nearest& near, double t) {
    if (near.distance < out.clearance)
      out.clearance = near.distance, out.at = t, out.touch = near.touch, out.point = near.point;
    return near.distance;
  };
  const auto look = [&](double t) {
    ++out.evaluations;
    return keep(collider.nearest(assembly, motion.at(t)), t);
  };
  struct Stretch {
    double from, to, first, last;
  };
  const double first = start ? keep(*start, 0) : look(0), last = end ? keep(*end, 1) : look(1);
  std::vector<Stretch> open{{0, 1, first, last}};
  out.bound = out.clearance;
  const auto bound = [&](const Stretch& s) {
    return std::min({0.5 * (s.first + s.last - displacement(motion, assembly, s.from, s.to)), s.first, s.last});
  };
  // Into as many equal parts as would do if the clearance were that of the ends, some to either side.
  const auto split = [&](const Stretch& s) {
    const double room = s.first + s.last - 2 * wanted, way = displacement(motion, assembly, s.from, s.to);
    const double parts = room > 0 ? std::clamp(std::ceil(way / room), 2.0, 1e6) : 1e6;
    return glm::mix(s.from, s.to, std::floor(parts / 2) / parts);
  };
  while (!open.empty() && out.clearance >= wanted && out.evaluations < max_evaluations) {
    const Stretch s = open.back();
    open.pop_back();
    const double low = bound(s), middle = split(s);
    if (low >= wanted || middle <= s.from || middle >= s.to) {
      out.bound = std::min(out.bound, low);
      continue;
    }
    const double d = look(middle);
    open.push_back({middle, s.to, d, s.last}), open.push_back({s.from, middle, s.first, d});
  }
  for (const Stretch& s : open) out.bound = std::min(out.bound, bound(s));
  out.bound = std::min(out.bound, out.clearance);
  out.answer = out.clearance < wanted ? SweptCheck::Answer::Gouges
               : open.empty()         ? SweptCheck::Answer::Clear
                                      : SweptCheck::Answer::Unknown;
  return out;
}

}  // namespace riffler
