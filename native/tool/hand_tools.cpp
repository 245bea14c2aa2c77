#include "riffler/tool/hand_tools.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "riffler/base/check.hpp"

namespace riffler::tool::hand_tools {

namespace {

using Sizes = std::vector<std::pair<std::string, double>>;

void check_sizes(const Sizes& sizes) {
  for (const auto& [name, value] : sizes)
    if (!(value > 0 && value <= Hull::kLargest))
      throw std::invalid_argument(name + " must be positive and finite, at most 1e6");
}

void check_angle(double angle, double most, const std::string& name, const std::string& range) {
  if (!(angle > 0 && angle < most)) throw std::invalid_argument(name + " must lie between 0 and " + range);
}

/// What stands on a section: its lower end rises by `rise` per mm along x and `lean` per mm along y from the tip.
Hull prism(const std::vector<Vec2>& section, double rise, double lean, double length) {
  std::vector<Vec3> points;
  for (const Vec2& p : section) {
    const double end = rise * p.x + lean * p.y;
    if (!(end < length))
      throw std::invalid_argument("length must be more than the ground end needs: " + std::to_string(end) +
                                  " mm; make it longer, or the angle wider");
    points.push_back({p.x, p.y, end}), points.push_back({p.x, p.y, length});
  }
  return make_hull(points, "hulls[0]");
}

Tool one(const char* kind, Sizes sizes, Hull hull) {
  return Tool(kind, std::move(sizes), std::vector<Hull>{std::move(hull)});
}

}  // namespace

Tool convex(const std::vector<std::vector<Vec3>>& hulls) {
  constexpr std::size_t kMost = 64;
  if (hulls.empty()) throw std::invalid_argument("hulls: give one list of points or more");
  if (hulls.size() > kMost)
    throw std::invalid_argument("hulls: at most " + std::to_string(kMost) + ", not " + std::to_string(hulls.size()));
  std::vector<Hull> bodies;
  for (std::size_t k = 0; k < hulls.size(); ++k)
    bodies.push_back(make_hull(hulls[k], "hulls[" + std::to_string(k) + "]"));
  return Tool("convex", {}, std::move(bodies));
}

Tool chisel(double width, double thickness, double bevel, double length, double skew) {
  Sizes sizes{{"width", width}, {"thickness", thickness}, {"bevel", bevel}, {"length", length}};
  check_sizes(sizes);
  check_angle(bevel, kPi / 2, "bevel", "a right angle (rad)");
  if (!(std::abs(skew) < kPi / 2)) throw std::invalid_argument("skew must be less than a right angle (rad)");
  sizes.emplace_back("skew", skew);
  const double half = width / 2;
  return one("chisel", std::move(sizes),
             prism({{0, -half}, {0, half}, {thickness, half}, {thickness, -half}}, 1 / base::tan(bevel),
                   base::tan(skew), length));
}

Tool gouge(double width, double radius, double bevel, double length) {
  Sizes sizes{{"width", width}, {"radius", radius}, {"bevel", bevel}, {"length", length}};
  check_sizes(sizes);
  check_angle(bevel, kPi / 2, "bevel", "a right angle (rad)");
  if (!(width <= 2 * radius)) throw std::invalid_argument("width must not be more than twice the radius");
  const double half = base::asin(std::min(1.0, width / (2 * radius)));
  const double widest = 2 * base::acos(std::max(0.0, 1 - kArcTolerance / radius));
  const int sides = std::clamp(static_cast<int>(std::ceil(2 * half / widest)), 2, kArcSides);
  std::vector<Vec2> section;
  for (int k = 0; k <= sides; ++k) {
    const double a = half * (2.0 * k / sides - 1), s = base::sin(a / 2);
    section.push_back({2 * radius * s * s, radius * base::sin(a)});
  }
  return one("gouge", std::move(sizes), prism(section, 1 / base::tan(bevel), 0, length));
}

Tool v_tool(double angle, double width, double bevel, double length) {
  Sizes sizes{{"angle", angle}, {"width", width}, {"bevel", bevel}, {"length", length}};
  check_sizes(sizes);
  check_angle(angle, kPi, "angle", "a half turn (rad)");
  check_angle(bevel, kPi / 2, "bevel", "a right angle (rad)");
  const double half = width / 2, depth = half / base::tan(angle / 2);
  return one("v_tool", std::move(sizes),
             prism({{0, 0}, {depth, half}, {depth, -half}}, 1 / base::tan(bevel), 0, length));
}

Tool knife(double width, double thickness, double edge_angle, double length) {
  Sizes sizes{{"width", width}, {"thickness", thickness}, {"edge_angle", edge_angle}, {"length", length}};
  check_sizes(sizes);
  check_angle(edge_angle, kPi, "edge_angle", "a half turn (rad)");
  const double half = thickness / 2, ground = half / base::tan(edge_angle / 2);
  if (!(ground < width))
    throw std::invalid_argument("width must be more than the ground sides need: " + std::to_string(ground) +
                                " mm; make it wider, or the edge angle");
  return one("knife", std::move(sizes),
             prism({{0, 0}, {-ground, half}, {-width, half}, {-width, -half}, {-ground, -half}}, -1, 0, length));
}

}  // namespace riffler::tool::hand_tools
