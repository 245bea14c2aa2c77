// Rational B-spline (NURBS) patches, stored as arrays.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::nurbs {

inline constexpr int kMaxDegree = 15;
/// Largest ratio of two weights of a patch.
inline constexpr double kMaxWeightRatio = 1e12;

/// One untrimmed tensor-product patch, as exchange formats describe it. Its domain is [knots[degree], knots[count]] in
/// each direction; knots need not be clamped.
struct Patch {
  std::size_t count_u = 0, count_v = 0;  // control points
  std::vector<Vec3> points;              // mm; point (i, j) has the index i * count_v + j
  std::vector<double> weights;           // in the same order, positive
  std::vector<double> knots_u, knots_v;  // count + degree + 1 each, not decreasing
  int degree_u = 1, degree_v = 1;        // 1 to kMaxDegree

  Vec2 lower() const;  // corners of the domain
  Vec2 upper() const;
};

}  // namespace riffler::nurbs
