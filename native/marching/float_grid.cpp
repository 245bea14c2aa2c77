#include "marching/float_grid.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::marching {

namespace {

constexpr double kRoom = 16;  // steps

/// Nearest number ≡ rest modulo `modulus`.
double round_to_class(double x, int rest, int modulus) {
  return modulus * round_to_integer((x - rest) / modulus) + rest;
}

}  // namespace

FloatGrid::FloatGrid(const Lattice& lattice)
    : step_(lattice.step()), steps_per_cell_(lattice.pitch() / lattice.step()) {
  // Less than a cell, by more than `outside` rounds. Then vertices of cells three apart, whose places have the same
  // remainder, stay apart.
  opening_ = std::clamp(1 - 8 / steps_per_cell_, 0.0, 0.95);
  for (int a = 0; a < 3; ++a) {
    box_.lower[a] = lattice.box().lower[a] / step_, box_.upper[a] = lattice.box().upper[a] / step_;
    range_[a].resize(lattice.cells(a));
    for (int n = 0; n < lattice.cells(a); ++n) {
      Range& r = range_[a][n];
      r.base = lattice.at(a, n) / step_;
      r.low = std::floor(r.base) + 1, r.high = std::ceil(lattice.at(a, n + 1) / step_) - 1;
      // A cell that contains a side of the box uses only its part inside, if that has room for all its vertices.
      if (const double end = std::ceil(box_.lower[a]); end > r.low && end + kRoom < r.high) r.low = end;
      if (const double end = std::floor(box_.upper[a]); end < r.high && end - kRoom > r.low) r.high = end;
      if (a == 0) r.low = 2 * std::ceil(r.low / 2), r.high = 2 * std::floor(r.high / 2);
    }
  }
}

Vec3 FloatGrid::outside(const Vec3i& cell, const Vec3& p, int opened) const {
  Vec3 out;
  for (int a = 0; a < 3; ++a) {
    const Range& r = range_[a][cell[a]];
    double q = r.base + p[a] * steps_per_cell_;
    if (!(opened >> (2 * a) & 1)) q = std::max(q, r.low + 4);
    if (!(opened >> (2 * a + 1) & 1)) q = std::min(q, r.high - 4);
    const int rest = cell[a] % 3;
    out[a] = a == 0 ? round_to_class(q, 2 * rest + 1, 6) : round_to_class(q, rest, 3);
  }
  return out * step_;
}

Vec3 FloatGrid::near(const Vec3i& cell, const Vec3& p) const {
  return in_cell(p) ? inside(cell, p) : outside(cell, p, 63);
}

Vec3 FloatGrid::to_cell(const Vec3i& cell, const Vec3& v) const {
  Vec3 p;
  for (int a = 0; a < 3; ++a) p[a] = (v[a] / step_ - range_[a][cell[a]].base) / steps_per_cell_;
  return p;
}

Vec3i FloatGrid::cell_of(const Vec3& v) const {
  Vec3i cell;
  for (int a = 0; a < 3; ++a) {
    const auto& ranges = range_[a];
    const auto above = std::upper_bound(ranges.begin(), ranges.end(), v[a] / step_,
                                        [](double q, const Range& r) { return q < r.low; });
    cell[a] = static_cast<int>(above - ranges.begin()) - 1;
  }
  return cell;
}

}  // namespace riffler::marching
