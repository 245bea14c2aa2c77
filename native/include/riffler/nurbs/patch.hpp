// Rational B-spline (NURBS) patches, stored as arrays.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::nurbs {

inline constexpr int kMaxDegree = 15;
/// Largest ratio of two weights of a patch.
inline constexpr double kMaxWeightRatio = 1e12;

/// One tensor-product patch, as exchange formats describe it. Its domain is [knots[degree], knots[count]] in each
/// direction; knots need not be clamped.
struct Patch {
  std::size_t count_u = 0, count_v = 0;  // control points
  std::vector<Vec3> points;              // mm; point (i, j) has the index i * count_v + j
  std::vector<double> weights;           // in the same order, positive
  std::vector<double> knots_u, knots_v;  // count + degree + 1 each, not decreasing
  int degree_u = 1, degree_v = 1;        // 1 to kMaxDegree
  /// Borders: closed polylines in (u, v) within the domain, the last point joined to the first. The patch is where an
  /// odd number of them encloses a parameter; without borders, it is the whole domain. Their directions do not matter.
  std::vector<std::vector<Vec2>> trims;
  std::string name;  // of the face in its file

  Vec2 lower() const;  // corners of the domain
  Vec2 upper() const;
};

}  // namespace riffler::nurbs
