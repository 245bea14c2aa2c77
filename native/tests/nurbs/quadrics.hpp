// Exact quadrics and tori as rational patches, their distances in closed form, and evaluation straight from the
// definition of B-splines.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "geom/math.hpp"
#include "riffler/nurbs/surface.hpp"

namespace riffler::nurbs::shapes {

/// A rational curve in the half plane of radius (x) and height (y).
struct Profile {
  std::vector<Vec2> points;
  std::vector<double> weights, knots;
  int degree = 1;
};

inline Profile line(const Vec2& a, const Vec2& b) {
  return {{a, b}, {1, 1}, {0, 0, 1, 1}, 1};
}

/// An arc of `quarters` · 90° about `centre` from the angle `start`.
inline Profile arc(const Vec2& centre, double radius, double start, int quarters) {
  Profile p;
  p.degree = 2;
  p.knots = {0};
  for (int k = 0; k <= 2 * quarters; ++k) {
    const double angle = start + k * kPi / 4, far = k % 2 ? std::sqrt(2.0) : 1;
    p.points.push_back(centre + radius * far * Vec2(std::cos(angle), std::sin(angle)));
    p.weights.push_back(1 / far);
    if (k % 2 == 0) p.knots.insert(p.knots.end(), 2, k / 2);
  }
  p.knots.push_back(quarters);
  return p;
}

/// Turned about z by `quarters` · 90°: u is the angle, v runs along the profile.
inline Patch turned(const Profile& profile, int quarters = 4, const Vec3& offset = Vec3(0)) {
  const Profile circle = arc(Vec2(0), 1, 0, quarters);
  Patch patch;
  patch.count_u = circle.points.size(), patch.count_v = profile.points.size();
  patch.degree_u = 2, patch.degree_v = profile.degree;
  patch.knots_u = circle.knots, patch.knots_v = profile.knots;
  for (std::size_t i = 0; i < patch.count_u; ++i)
    for (std::size_t j = 0; j < patch.count_v; ++j) {
      // The last point of a whole turn is the first one, to the bit.
      const Vec2 c = quarters == 4 && i + 1 == patch.count_u ? circle.points[0] : circle.points[i];
      patch.points.push_back(offset + Vec3(profile.points[j].x * c, profile.points[j].y));
      patch.weights.push_back(circle.weights[i] * profile.weights[j]);
    }
  return patch;
}

inline Patch ball(double radius, int quarters = 4, const Vec3& offset = Vec3(0)) {
  Profile half = arc(Vec2(0), radius, -kPi / 2, 2);
  half.points[0].x = half.points[4].x = 0;
  half.points[1].x = half.points[3].x = radius;
  return turned(half, quarters, offset);
}

inline Patch torus(double ring, double tube, const Vec3& offset = Vec3(0)) {
  Profile circle = arc({ring, 0}, tube, 0, 4);
  circle.points.back() = circle.points.front();
  return turned(circle, 4, offset);
}

/// Control points and weights at random: wavy, with knots of different distances and multiplicities.
inline Patch random_patch(std::mt19937& random, int degree_u, int degree_v, double weights) {
  std::uniform_real_distribution<double> share(-1, 1);
  const auto knots = [&](int degree, std::size_t count) {
    std::vector<double> k(static_cast<std::size_t>(degree) + 1, -3);
    double at = -3;
    while (k.size() < count) {
      at += 0.2 + std::abs(share(random));
      const std::size_t times = share(random) > 0.5 ? static_cast<std::size_t>(degree) : 1;
      k.insert(k.end(), std::min(times, count - k.size()), at);
    }
    k.insert(k.end(), static_cast<std::size_t>(degree) + 1, at + 0.7);
    return k;
  };
  Patch patch;
  patch.degree_u = degree_u, patch.degree_v = degree_v;
  patch.count_u = static_cast<std::size_t>(degree_u) + 3, patch.count_v = static_cast<std::size_t>(degree_v) + 2;
  patch.knots_u = knots(degree_u, patch.count_u), patch.knots_v = knots(degree_v, patch.count_v);
  for (std::size_t i = 0; i < patch.count_u; ++i)
    for (std::size_t j = 0; j < patch.count_v; ++j) {
      patch.points.emplace_back(10.0 * static_cast<double>(i) + 3 * share(random),
                                10.0 * static_cast<double>(j) + 3 * share(random), 8 * share(random));
      patch.weights.push_back(std::pow(weights, share(random)));
    }
  return patch;
}

/// Cox and de Boor's recursion, from the definition.
inline double basis(const std::vector<double>& knots, std::size_t i, int degree, double t, double end) {
  if (degree == 0) {
    const bool last = t == end && knots[i] < knots[i + 1] && knots[i + 1] == end;
    return (knots[i] <= t && t < knots[i + 1]) || last ? 1 : 0;
  }
  const auto p = static_cast<std::size_t>(degree);
  double sum = 0;
  if (knots[i + p] > knots[i]) sum += (t - knots[i]) / (knots[i + p] - knots[i]) * basis(knots, i, degree - 1, t, end);
  if (knots[i + p + 1] > knots[i + 1])
    sum += (knots[i + p + 1] - t) / (knots[i + p + 1] - knots[i + 1]) * basis(knots, i + 1, degree - 1, t, end);
  return sum;
}

inline Vec3 by_definition(const Patch& patch, const Vec2& uv) {
  Vec3 sum(0);
  double weight = 0;
  for (std::size_t i = 0; i < patch.count_u; ++i) {
    const double bu = basis(patch.knots_u, i, patch.degree_u, uv.x, patch.upper().x);
    if (bu == 0) continue;
    for (std::size_t j = 0; j < patch.count_v; ++j) {
      const std::size_t k = i * patch.count_v + j;
      const double b = bu * basis(patch.knots_v, j, patch.degree_v, uv.y, patch.upper().y) * patch.weights[k];
      sum += b * patch.points[k], weight += b;
    }
  }
  return sum / weight;
}

/// n × n parameters over a patch's domain, borders included.
inline std::vector<Vec2> grid(const Patch& patch, int n) {
  std::vector<Vec2> uv;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      uv.push_back(glm::mix(patch.lower(), patch.upper(), Vec2(i, j) / static_cast<double>(n - 1)));
  return uv;
}

}  // namespace riffler::nurbs::shapes
