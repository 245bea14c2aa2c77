// Places that vertices may take: multiples of the float32 step u, chosen so that no two vertices coincide.
//
// A vertex inside its cell keeps off the cell's walls and has an even x. A vertex outside its cell has an odd x and
// remainders modulo 3 that identify its cell. So vertices of different cells always differ, and so do the floats in a
// file.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "marching/lattice.hpp"

namespace riffler::marching {

/// Nearest integer for |x| < 2^51, without a library call: the sum's unit is 1.
inline double round_to_integer(double x) {
  constexpr double shift = 0x1.8p52;
  return (x + shift) - shift;
}

class FloatGrid {
 public:
  explicit FloatGrid(const Lattice& lattice);

  /// Nearest place to `p` (cell units: the cell is [0, 1]³) strictly inside the cell and in the volume's box.
  Vec3 inside(const Vec3i& cell, const Vec3& p) const {
    const Range &x = range_[0][cell.x], &y = range_[1][cell.y], &z = range_[2][cell.z];
    const Vec3 q{2 * round_to_integer((x.base + p.x * steps_per_cell_) / 2),
                 round_to_integer(y.base + p.y * steps_per_cell_), round_to_integer(z.base + p.z * steps_per_cell_)};
    return Vec3{std::clamp(q.x, x.low, x.high), std::clamp(q.y, y.low, y.high), std::clamp(q.z, z.low, z.high)} * step_;
  }
  /// Nearest place for a vertex outside its cell: at least four steps from each wall whose bit (2 axis + side) in
  /// `opened` is not set; no limit at the other walls.
  Vec3 outside(const Vec3i& cell, const Vec3& p, int opened) const;
  /// Whether `p`, in cell units, lies in the cell.
  static bool in_cell(const Vec3& p) { return p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1 && p.z >= 0 && p.z <= 1; }
  /// `inside` or, for a point outside the cell, `outside` without walls.
  Vec3 near(const Vec3i& cell, const Vec3& p) const;
  /// The free place nearest to `v`, which lies inside `cell`. Vertices of one cell avoid each other in steps along y
  /// and z; even the smallest cell has three of them.
  template <class Taken>
  Vec3 free_place(const Vec3i& cell, const Vec3& v, Taken&& taken) const {
    for (int reach = 0;; ++reach)
      for (int y = -reach; y <= reach; ++y)
        for (int z = -reach; z <= reach; ++z) {
          const Vec3 place = inside(cell, to_cell(cell, v + Vec3(0, y, z) * step_));
          if (!taken(place)) return place;
        }
  }
  /// How far vertices may leave their cell, in cells; 0 if the float32 steps are too coarse.
  double opening() const { return opening_; }
  double step() const { return step_; }
  /// The point of the volume's box nearest to `p`, in cell units. There is no material outside the box, even if tangent
  /// planes meet there.
  Vec3 in_box(const Vec3i& cell, const Vec3& p) const {
    Vec3 out;
    for (int a = 0; a < 3; ++a) {
      const double base = range_[a][cell[a]].base;
      out[a] = std::clamp(p[a], (box_.lower[a] - base) / steps_per_cell_, (box_.upper[a] - base) / steps_per_cell_);
    }
    return out;
  }
  /// `v` (world units) in cell units of `cell`.
  Vec3 to_cell(const Vec3i& cell, const Vec3& v) const;
  /// The cell that contains a vertex made by `inside`.
  Vec3i cell_of(const Vec3& v) const;

 private:
  struct Range {
    double base, low, high;  // in steps: lower wall; lowest and highest place in the open cell and the box
  };
  std::array<std::vector<Range>, 3> range_;
  Box3 box_;  // in steps
  double step_, steps_per_cell_, opening_;
};

}  // namespace riffler::marching
