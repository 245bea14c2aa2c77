#include "nurbs/check_patch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "riffler/base/check.hpp"

namespace riffler::nurbs {

namespace {

using base::in_figures;

[[noreturn]] void refuse(const std::string& text) {
  throw std::invalid_argument(text);
}

/// One of the two directions of a patch.
struct Direction {
  const std::vector<double>& knots;
  std::size_t count;
  int degree;
  std::string letter;

  std::string knots_name() const { return "knots_" + letter; }
  std::string degree_name() const { return "degree_" + letter; }
};

void check_degree(const Direction& d) {
  if (d.degree < 1 || d.degree > kMaxDegree)
    refuse(d.degree_name() + " must be from 1 to " + std::to_string(kMaxDegree) + ", not " + std::to_string(d.degree) +
           (d.degree < 1 ? "; a surface that is constant along " + d.letter + " is a curve"
                         : "; approximate the surface with more control points of a lower degree"));
  if (d.count < static_cast<std::size_t>(d.degree) + 1)
    refuse("points has " + std::to_string(d.count) + " along " + d.letter + ", but " + d.degree_name() + " " +
           std::to_string(d.degree) + " needs at least " + std::to_string(d.degree + 1) +
           "; give more points or a lower degree");
}

void check_count(const Direction& d) {
  const std::size_t needed = d.count + static_cast<std::size_t>(d.degree) + 1;
  if (d.knots.size() == needed) return;
  std::string text = d.knots_name() + " has " + std::to_string(d.knots.size()) + " knots, but " +
                     std::to_string(d.count) + " points of degree " + std::to_string(d.degree) + " need " +
                     std::to_string(needed) + " (points + degree + 1)";
  if (d.knots.size() + 2 == needed)
    text += "; where a format leaves out the first and the last knot, repeat them";
  else
    text += "; write repeated knots as often as they occur";
  refuse(text);
}

void check_order(const Direction& d) {
  for (std::size_t i = 0; i < d.knots.size(); ++i) {
    const std::string row = d.knots_name() + ", row " + std::to_string(i) + ": ";
    if (!(std::abs(d.knots[i]) <= base::kMaxSize)) refuse(row + in_figures(d.knots[i]) + " is not a finite number");
    if (i > 0 && d.knots[i] < d.knots[i - 1])
      refuse(row + in_figures(d.knots[i]) + " after " + in_figures(d.knots[i - 1]) +
             "; knots must not decrease: to reverse a surface, reverse its points too");
  }
}

/// A knot that is repeated more often than the degree, within the domain, tears the surface.
void check_multiplicity(const Direction& d) {
  const auto p = static_cast<std::size_t>(d.degree);
  const double lower = d.knots[p], upper = d.knots[d.count];
  if (!(lower < upper))
    refuse(d.knots_name() + ": the domain, from knot " + std::to_string(p) + " to knot " + std::to_string(d.count) +
           ", is empty: both are " + in_figures(lower) + "; repeat the first and the last knot degree + 1 times only");
  for (std::size_t i = 0, end = 0; i < d.knots.size(); i = end) {
    while (end < d.knots.size() && d.knots[end] == d.knots[i]) ++end;
    const std::size_t most = d.knots[i] > lower && d.knots[i] < upper ? p : p + 1;
    if (end - i <= most) continue;
    refuse(d.knots_name() + ", row " + std::to_string(i) + ": " + in_figures(d.knots[i]) + " occurs " +
           std::to_string(end - i) + " times, at most " + std::to_string(most) + " are possible for degree " +
           std::to_string(d.degree) + "; where the surface is torn, make a patch of each side");
  }
}

std::string row_of(const Patch& patch, std::size_t at) {
  return "row (" + std::to_string(at / patch.count_v) + ", " + std::to_string(at % patch.count_v) + "): ";
}

void check_points(const Patch& patch) {
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    const Vec3& p = patch.points[i];
    if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= base::kMaxSize))
      refuse("points, " + row_of(patch, i) + "not finite; give mm, not multiplied by the weights");
  }
}

void check_weights(const Patch& patch) {
  for (std::size_t i = 0; i < patch.weights.size(); ++i)
    if (!(patch.weights[i] > 0 && patch.weights[i] <= base::kMaxSize))
      refuse("weights, " + row_of(patch, i) + in_figures(patch.weights[i]) +
             " is not positive and finite; 1 everywhere makes a surface without weights");
  const auto [low, high] = std::minmax_element(patch.weights.begin(), patch.weights.end());
  if (*high > kMaxWeightRatio * *low)
    refuse("weights from " + in_figures(*low) + " to " + in_figures(*high) +
           ": the ratio must be at most 1e12; divide the patch by inserting knots, or correct the smallest weight at " +
           row_of(patch, static_cast<std::size_t>(low - patch.weights.begin())) + "or the largest");
}

void check_trims(const Patch& patch) {
  if (patch.trims.empty()) return;
  if (patch.degree_u + patch.degree_v > kMaxDegree)
    refuse("trims need degree_u + degree_v of at most " + std::to_string(kMaxDegree) + ", not " +
           std::to_string(patch.degree_u + patch.degree_v) +
           "; approximate the surface with more control points of a lower degree");
  const Vec2 lower = patch.lower(), upper = patch.upper();
  for (std::size_t i = 0; i < patch.trims.size(); ++i) {
    const std::string loop = "trims, loop " + std::to_string(i);
    if (patch.trims[i].size() < 3)
      refuse(loop + " has " + std::to_string(patch.trims[i].size()) +
             " points, but a closed curve needs at least 3; leave it out");
    for (std::size_t k = 0; k < patch.trims[i].size(); ++k) {
      const Vec2& p = patch.trims[i][k];
      if (!(p.x >= lower.x && p.x <= upper.x && p.y >= lower.y && p.y <= upper.y))
        refuse(loop + ", row " + std::to_string(k) + ": (" + in_figures(p.x) + ", " + in_figures(p.y) +
               ") is not in the domain, u from " + in_figures(lower.x) + " to " + in_figures(upper.x) + " and v from " +
               in_figures(lower.y) + " to " + in_figures(upper.y));
    }
  }
}

}  // namespace

void check_patch(const Patch& patch) {
  const std::size_t n = patch.count_u * patch.count_v;
  if (patch.points.size() != n || patch.weights.size() != n)
    refuse("points and weights must have count_u · count_v = " + std::to_string(n) + " rows, not " +
           std::to_string(patch.points.size()) + " and " + std::to_string(patch.weights.size()));
  for (const Direction& d : {Direction{patch.knots_u, patch.count_u, patch.degree_u, "u"},
                             Direction{patch.knots_v, patch.count_v, patch.degree_v, "v"}}) {
    check_degree(d);
    check_count(d);
    check_order(d);
    check_multiplicity(d);
  }
  check_points(patch);
  check_weights(patch);
  check_trims(patch);
}

}  // namespace riffler::nurbs
