// Rows of a family of curves seen along the axis, and further ones between them where they leave too much.
#pragma once

#include <functional>
#include <vector>

#include "plan/finish/patterns.hpp"

namespace riffler::plan {

/// Curves with a parameter u along each, from the first to the last, and a number v across.
struct RowFamily {
  double from, to;            ///< u along a row
  double step;                ///< of u, between samples
  std::vector<double> first;  ///< numbers of the first rows, ascending
  bool ring = false;          ///< the last of them is the first one again
  std::function<Vec2(double u, double v)> at{};
  std::function<double(const Vec2& p, double v)> along{};         ///< u of a point of row v
  std::function<double(double u, double v0, double v1)> apart{};  ///< mm between two rows
  std::function<double(double u, double v)> pace{};               ///< mm along row v for each unit of u
  std::function<double(double u, double v)> chord{};  ///< u to the next point of a bent curve; none: straight
};

/// The rows `first`, and halves between two of them where needed. Three things decide at places between two rows X and
/// Y, of which the middle one is M: the cutter's ridge from the nearest place of a row to M and to the points half way
/// from M to X and Y (slopes, walls that rows pass alongside), the distance of M's contact from the cutter on the rows
/// (curved and creased faces), and whether X and Y are cut there at all (borders).
PatternRows family_rows(const PatternScene& scene, const RowFamily& family, const Progress& progress);

/// The centre of patterns about one, in the rows' frame: the option, or the middle of the part's box.
Vec2 centre_of(const PatternScene& scene);
/// Distance (mm) from a point that takes in all places of the cutter on the part.
double farthest_from(const PatternScene& scene, const Vec2& centre);

}  // namespace riffler::plan
