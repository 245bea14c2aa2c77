#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "riffler/tool/cutters.hpp"
#include "stress/scenario.hpp"

namespace riffler::stress {

namespace {

constexpr const char* kCutters[] = {"ball",         "flat",   "fillet",         "taper-ball", "taper-flat", "cone-end",
                                    "free-profile", "barrel", "corner-rounder", "short-ball", "disc"};

/// `segments` blown up by `scale`.
Tool scaled(std::vector<tool::ProfileSegment> segments, double scale, double length) {
  for (tool::ProfileSegment& s : segments) {
    s.to *= scale;
    if (s.centre) *s.centre *= scale;
  }
  return cutters::profile(std::move(segments), length);
}

/// A flank of radius 20 whose centre lies beyond the axis, for a cutter of radius 3.2.
std::vector<tool::ProfileSegment> barrel() {
  const Vec2 from{1, 0}, to{3, 6}, chord = to - from, across = glm::normalize(Vec2(-chord.y, chord.x));
  const Vec2 centre = (from + to) / 2.0 + across * std::sqrt(400 - glm::dot(chord, chord) / 4);
  return {{from, {}}, {to, centre}, {{3.2, 8}, {}}};
}

/// `r`: largest radius; `length`: enough to reach out of the stock.
Tool draw_cutter(Random& random, const std::string& cutter, double r, double length) {
  if (cutter == "ball") return cutters::ball(2 * r, length);
  if (cutter == "flat") return cutters::flat(2 * r, length);
  if (cutter == "fillet") return cutters::fillet(2 * r, r * random.one_of({0.01, 0.125, 0.5, 0.9, 1.0}), length);
  if (cutter == "taper-ball") return cutters::taper(r / 6, random.uniform(0.15, 0.8), 2 * r, length);
  if (cutter == "taper-flat") return cutters::taper(r / 4, random.uniform(0.15, 0.8), 2 * r, length, true);
  if (cutter == "cone-end") return cutters::cone_end(random.uniform(0.8, 1.2), r / 4, 0.4, 2 * r, length);
  if (cutter == "free-profile")
    return scaled({{{0.4, 0}, {}}, {{0.8, 0.4}, Vec2(0.4, 0.4)}, {{0.5, 1.6}, {}}, {{1, 2.1}, {}}}, r, length);
  if (cutter == "barrel") return scaled(barrel(), r / 3.2, length);
  if (cutter == "corner-rounder")
    return scaled({{{0.25, 0}, {}}, {{0.25, 0.25}, {}}, {{1, 1}, Vec2(1, 0.25)}}, r, length);
  if (cutter == "short-ball") return cutters::ball(2 * r, r * random.one_of({1.0, 1.2, 2.0}));
  if (cutter == "disc") return cutters::flat(2 * r, r * random.one_of({0.02, 0.1, 0.3}));
  throw std::invalid_argument("there is no cutter '" + cutter + "'");
}

Setting draw_setting(Random& random) {
  const int k = random.below(10);
  return k < 5 ? Setting::Usual : k < 7 ? Setting::TinyCutter : k < 8 ? Setting::HugeCutter : Setting::FarFromOrigin;
}

}  // namespace

std::span<const char* const> cutter_names() {
  return kCutters;
}

const char* name(Setting setting) {
  constexpr const char* kNames[] = {"usual sizes", "radius 1e-3 mm", "radius 1e3 mm", "at 1e5 mm"};
  return kNames[static_cast<int>(setting)];
}

Stage draw_stage(Random& random, const std::string& cutter) {
  const Setting setting = draw_setting(random);
  // Round sizes put walls on rays and on lattice planes; others must not.
  const bool round = random.one_in(2);
  double radius = round ? 3 : random.uniform(1.5, 5);
  if (setting == Setting::TinyCutter) radius = round ? 1e-3 : random.uniform(0.5e-3, 2e-3);
  if (setting == Setting::HugeCutter) radius = round ? 1e3 : random.uniform(0.5e3, 2e3);
  // A hollow arc is cut as cones that leave 0.001 mm of it: 700 of them at this radius. Fewer will do.
  if (setting == Setting::HugeCutter && cutter == "corner-rounder") radius /= 50;
  const double pitch = radius / (round ? random.one_of({2.0, 3.0, 4.0, 6.0}) : random.uniform(1.5, 6));
  Vec3 lower{0}, size;
  for (int k = 0; k < 3; ++k) {
    size[k] = pitch * (12 + random.below(29));
    if (!round) lower[k] = random.uniform(-1, 1) * size[k];
    if (setting == Setting::FarFromOrigin) lower[k] += 1e5 * random.sign();
  }
  const double reach = std::max(1.5 * glm::length(size), 8 * radius);
  Tool tool = draw_cutter(random, cutter, radius, reach);
  const dexel::Frame frame{{lower, lower + size}, pitch, random.one_in(4) ? "z" : "xyz"};
  const double tolerance = radius * random.power_of_ten(-3.5, -1.5), finest = std::min(tool.length(), radius) / 8;
  return {setting, frame, std::move(tool), tolerance, finest};
}

}  // namespace riffler::stress
