// Rows on a family of curves, seen along the axis, with further rows between two that leave too much material.
#pragma once

#include <functional>
#include <vector>

#include "plan/finish/patterns.hpp"

namespace riffler::plan {

/// Curves, each with a number v, and with a parameter u along the curve.
struct RowFamily {
  double from, to;            ///< u at the first and last point of a row
  double step;                ///< difference of u between samples
  std::vector<double> first;  ///< numbers of the first rows, ascending
  bool ring = false;          ///< whether the last curve is the first one again
  std::function<Vec2(double u, double v)> at{};
  std::function<double(const Vec2& p, double v)> along{};         ///< u of a point of row v
  std::function<double(double u, double v0, double v1)> apart{};  ///< distance of two rows at u, mm
  std::function<double(double u, double v)> pace{};               ///< mm along row v for each unit of u
  std::function<double(double u, double v)> chord{};  ///< u to the next point of a bent curve; none: straight
};

/// Makes the rows `first`, and halves the distance between two rows where needed. Let M be a place in the middle
/// between rows X and Y. A row is needed there if: the ridge between the nearest place of a row and M, or a point half
/// way from M to X or Y, is too high (slopes, walls along the rows); M's contact is too far from the cutter on the rows
/// (curved and creased faces); or X and Y are not both cut there (borders).
PatternRows family_rows(const PatternScene& scene, const RowFamily& family, const Progress& progress);

/// The centre of spiral and radial patterns, in the rows' frame: the option, or the middle of the part's box.
Vec2 centre_of(const PatternScene& scene);
/// Radius (mm) of a circle about `centre` that contains every position of the cutter on the part.
double farthest_from(const PatternScene& scene, const Vec2& centre);

}  // namespace riffler::plan
