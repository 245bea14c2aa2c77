#include "nurbs/mesh_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "nurbs/chord_bound.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::nurbs {

namespace {

constexpr std::int64_t kMinCell = 1 << 12;  // of kGrid, so that rounding a cell's sides changes little
constexpr double kRoundedSides = 1 + 1e-3;
constexpr double kMaxParts = 1e6;  // in one direction of a node

/// Numbers of equal parts in the two directions.
struct Parts {
  double u = 1, v = 1;

  double cells() const { return u * v; }
};

/// The fewest cells whose bound is within the tolerance.
Parts parts_for(const SecondDerivatives& bound, double tolerance) {
  const double a = bound.uu / (8 * tolerance), b = bound.uv / (4 * tolerance), c = bound.vv / (8 * tolerance);
  const double infinite = std::numeric_limits<double>::infinity();
  if (!(a + b + c < kMaxParts * kMaxParts)) return {infinite, infinite};
  // a / u² + b / (u v) + c / v² ≤ 1 for a given u: a quadratic equation in 1 / v.
  const auto parts_v = [&](double u) {
    const double rest = 1 - a / (u * u), slope = b / u;
    if (!(rest > 0)) return infinite;
    return std::max(1.0, std::ceil((slope + std::sqrt(slope * slope + 4 * rest * c)) / (2 * rest) - 1e-9));
  };
  Parts best{infinite, 1};
  const auto attempt = [&](double u) {
    const Parts parts{u, parts_v(u)};
    if (parts.cells() < best.cells()) best = parts;
  };
  // Without rounding, both directions have the same share.
  const double ratio = c > 0 ? std::sqrt(a / c) : infinite;
  const double good = c > 0 ? std::sqrt(2 * a + b * ratio) : std::sqrt(a) + b;
  const double first = std::max(1.0, std::floor(std::isfinite(good) ? good : 1) - 4);
  for (int k = 0; k < 10; ++k) attempt(first + k);
  for (int k = 0; k < 4; ++k) attempt(std::max(1.0, std::ceil(std::sqrt(a))) + k);
  for (double u = 1; u <= 8; ++u) attempt(u);
  attempt(std::max(1.0, std::ceil(a + b + 1)));
  return best;
}

/// A rectangle that is divided into equal cells.
struct Grid {
  MeshCell node;
  Parts parts;
};

class Planner {
 public:
  Planner(const Degrees& degrees, double tolerance, std::size_t max)
      : degrees_(degrees), tolerance_(tolerance), max_(static_cast<double>(max)) {}

  /// Appends the grids of a node and returns the number of their cells. `parts`: those of the node by its own bound.
  double divide(const Vec4* net, const MeshCell& node, const SecondDerivatives& bound, const Parts& parts,
                std::vector<Grid>& grids) {
    base::still_wanted();
    const Place size = node.upper - node.lower;
    const bool fits =
        parts.u * kMinCell <= static_cast<double>(size.x) && parts.v * kMinCell <= static_cast<double>(size.y);
    if (fits && (parts.cells() <= 2 || !worth_halving(net, parts))) return add(node, parts, grids);
    const bool along_u =
        may_halve(size.x) && (!may_halve(size.y) || (bound.uu >= bound.vv && parts.u > 1) || parts.v == 1);
    if (!may_halve(along_u ? size.x : size.y)) refuse();
    std::vector<Vec4> halves(2 * degrees_.size());
    Vec4 *first = halves.data(), *second = first + degrees_.size();
    halve(net, degrees_, along_u, first, second);
    MeshCell below = node, above = node;
    if (along_u)
      below.upper.x = above.lower.x = node.lower.x + size.x / 2;
    else
      below.upper.y = above.lower.y = node.lower.y + size.y / 2;
    const std::size_t before = grids.size();
    const SecondDerivatives low = second_derivatives(first, degrees_), high = second_derivatives(second, degrees_);
    double cells = divide(first, below, low, parts_of(low), grids);
    cells += divide(second, above, high, parts_of(high), grids);
    if (!fits || cells < 0.95 * parts.cells()) return cells;
    grids.resize(before);
    return add(node, parts, grids);
  }

  double add(const MeshCell& node, const Parts& parts, std::vector<Grid>& grids) const {
    if (parts.cells() > max_) too_many();
    grids.push_back({node, parts});
    return parts.cells();
  }

  [[noreturn]] static void too_many() {
    throw std::invalid_argument("tolerance: the mesh would have more than 50 million triangles; give a larger one");
  }

  Parts parts_of(const SecondDerivatives& bound) const { return parts_for(bound, tolerance_ / kRoundedSides); }

  void expand(const Grid& grid, std::vector<MeshCell>& cells) const {
    const MeshCell& node = grid.node;
    if (static_cast<double>(cells.size()) + grid.parts.cells() > max_) too_many();
    const auto nu = static_cast<std::int64_t>(grid.parts.u), nv = static_cast<std::int64_t>(grid.parts.v);
    const auto line = [](std::int64_t low, std::int64_t high, std::int64_t i, std::int64_t n) {
      return low + static_cast<std::int64_t>(std::llround(static_cast<double>(high - low) *
                                                          (static_cast<double>(i) / static_cast<double>(n))));
    };
    for (std::int64_t i = 0; i < nu; ++i)
      for (std::int64_t j = 0; j < nv; ++j)
        cells.push_back({{line(node.lower.x, node.upper.x, i, nu), line(node.lower.y, node.upper.y, j, nv)},
                         {line(node.lower.x, node.upper.x, i + 1, nu), line(node.lower.y, node.upper.y, j + 1, nv)}});
  }

 private:
  static bool may_halve(std::int64_t side) { return side >= 2 * kMinCell; }

  /// Whether the bound is larger than the second derivatives in the middle are.
  bool worth_halving(const Vec4* net, const Parts& parts) const {
    return parts.cells() > 1.1 * parts_of(second_derivatives_in_middle(net, degrees_)).cells();
  }

  [[noreturn]] static void refuse() {
    throw std::invalid_argument("tolerance: cells become smaller than 1e-9 of a span; give a larger tolerance");
  }

  Degrees degrees_;
  double tolerance_;
  double max_;
};

}  // namespace

std::vector<MeshCell> plan_cells(const BezierSpan& span, double tolerance, int least_u, int least_v, std::size_t max) {
  Planner planner(span.degrees, tolerance, max);
  std::vector<Grid> grids;
  std::vector<MeshCell> cells;
  const SecondDerivatives bound = second_derivatives(span.net.data(), span.degrees);
  const double count = planner.divide(span.net.data(), {{0, 0}, {kGrid, kGrid}}, bound, planner.parts_of(bound), grids);
  if (count > static_cast<double>(max)) Planner::too_many();
  for (const Grid& grid : grids) planner.expand(grid, cells);
  const auto crossed = [&](auto side) {
    return std::count_if(cells.begin(), cells.end(), [&](const MeshCell& c) { return side(c); });
  };
  const bool few_u = crossed([](const MeshCell& c) { return c.lower.y == 0; }) < least_u ||
                     crossed([](const MeshCell& c) { return c.upper.y == kGrid; }) < least_u;
  const bool few_v = crossed([](const MeshCell& c) { return c.lower.x == 0; }) < least_v ||
                     crossed([](const MeshCell& c) { return c.upper.x == kGrid; }) < least_v;
  if (!few_u && !few_v) return cells;
  std::vector<MeshCell> out;
  // Each cell is divided, since any rectangle within a cell is within the tolerance.
  const Parts parts{few_u ? static_cast<double>(least_u) : 1, few_v ? static_cast<double>(least_v) : 1};
  for (const MeshCell& cell : cells) planner.expand({cell, parts}, out);
  return out;
}

}  // namespace riffler::nurbs
