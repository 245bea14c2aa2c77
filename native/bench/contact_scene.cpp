#include "bench/contact_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/math.hpp"
#include "riffler/tool/cutters.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::bench {

namespace {

double height(double x, double y) {
  const double a = kPi * (0.93 * x + 0.37 * y) / 29 + 0.4, b = kPi * (0.8 * y - 0.6 * x) / 23 + 0.9,
               c = kPi * (0.3 * x + 0.95 * y + 3 * std::sin(0.11 * x)) / 13;
  return 4.2 * std::abs(std::sin(a)) + 2.5 * std::abs(std::sin(b)) + 1.1 * std::abs(std::sin(c));
}

/// Points of the outline, from the axis at the bottom to the axis at the top.
std::vector<Vec2> corners_of(const tool::Outline& outline, int segments) {
  std::vector<Vec2> out;
  for (const tool::OutlineEdge& e : outline.edges()) {
    if (out.empty()) out.push_back(e.from);
    int steps = 1;
    double from = 0, sweep = 0;
    if (e.centre) {
      const Vec2 a = e.from - *e.centre, b = e.to - *e.centre;
      from = std::atan2(a.y, a.x), sweep = std::remainder(std::atan2(b.y, b.x) - from, 2 * kPi);
      steps = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) * segments / (2 * kPi))));
    }
    for (int k = 1; k < steps; ++k) {
      const double angle = from + sweep * k / steps;
      out.push_back(*e.centre + std::abs(e.bulge) * Vec2(std::cos(angle), std::sin(angle)));
    }
    out.push_back(e.to);
  }
  return out;
}

}  // namespace

Mesh valleys(int squares) {
  Mesh out;
  const int n = squares + 1;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = kValleySide * i / squares, y = kValleySide * j / squares;
      out.vertices.push_back({x, y, height(x, y)});
    }
  for (int j = 0; j < squares; ++j)
    for (int i = 0; i < squares; ++i) {
      const int a = j * n + i;
      out.triangles.push_back({a, a + 1, a + n + 1});
      out.triangles.push_back({a, a + n + 1, a + n});
    }
  return out;
}

double valley_height(const Mesh& sheet, int squares, double x, double y) {
  const double s = x / kValleySide * squares, t = y / kValleySide * squares;
  const int i = std::clamp(static_cast<int>(s), 0, squares - 1), j = std::clamp(static_cast<int>(t), 0, squares - 1);
  const int a = j * (squares + 1) + i;
  const auto z = [&](int v) { return sheet.vertices[v].z; };
  const double u = s - i, v = t - j;
  if (u >= v) return z(a) + u * (z(a + 1) - z(a)) + v * (z(a + squares + 2) - z(a + 1));
  return z(a) + v * (z(a + squares + 1) - z(a)) + u * (z(a + squares + 2) - z(a + squares + 1));
}

std::vector<ContactTool> contact_tools() {
  return {{"long", cutters::ball(6, 20).with_shank({{20, 3, 40, 3}, {40, 3, 60, 10}}).with_holder({{60, 20, 100, 20}})},
          {"short", cutters::ball(6, 6).with_shank({{6, 3, 8, 3}, {8, 3, 10, 8}}).with_holder({{10, 20, 50, 20}})},
          {"plain", cutters::ball(6, 30)}};
}

std::vector<Pose> contact_poses(const Mesh& sheet, int squares, int count, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  const auto uniform = [&](double from, double to) {
    return from + static_cast<double>(bits() >> 11) * 0x1p-53 * (to - from);
  };
  std::vector<Pose> out;
  for (int k = 0; k < count; ++k) {
    const double x = uniform(0, kValleySide), y = uniform(0, kValleySide), above = uniform(-0.3, 2),
                 tilt = uniform(0, kPi / 6), way = uniform(0, 2 * kPi);
    const Vec3 axis{std::sin(tilt) * std::cos(way), std::sin(tilt) * std::sin(way), std::cos(tilt)};
    out.push_back({{x, y, valley_height(sheet, squares, x, y) + above}, glm::normalize(axis)});
  }
  return out;
}

Mesh turned(const Tool& tool, int segments) {
  const std::vector<Vec2> corners = corners_of(tool::Outline(tool), segments);
  Mesh out;
  const auto on_axis = [](const Vec2& c) { return !(c.x > 0); };
  std::vector<int> first;  // vertex of each corner
  for (const Vec2& c : corners) {
    first.push_back(static_cast<int>(out.vertices.size()));
    for (int k = 0; k < (on_axis(c) ? 1 : segments); ++k) {
      const double angle = 2 * kPi * k / segments;
      out.vertices.push_back({c.x * std::cos(angle), c.x * std::sin(angle), c.y});
    }
  }
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const bool low = on_axis(corners[i]), high = on_axis(corners[i + 1]);
    for (int k = 0; k < segments && !(low && high); ++k) {
      const int next = (k + 1) % segments, a = first[i] + (low ? 0 : k), b = first[i] + (low ? 0 : next),
                c = first[i + 1] + (high ? 0 : next), d = first[i + 1] + (high ? 0 : k);
      if (!low) out.triangles.push_back({a, b, c});
      if (!high) out.triangles.push_back({a, c, d});
    }
  }
  return out;
}

}  // namespace riffler::bench
