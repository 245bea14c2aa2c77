// The signs of a brick and of two layers of points around it, one word per column.
#pragma once

#include <bit>

#include "marching/bricks.hpp"
#include "marching/cases.hpp"

namespace riffler::marching {

/// Points and cells are counted from the brick's first, so −2 … 33 are valid along each axis; bit K + 2 of a column's
/// word is its point K.
class Neighbourhood {
 public:
  static constexpr int kLayers = 2, kSide = kBrickSide + 2 * kLayers;
  /// Bits of the brick's own points, and the lowest of them.
  static constexpr std::uint64_t kOwn = std::uint64_t{0xffffffff} << kLayers, kFirstOwn = 1U << kLayers;

  Neighbourhood(const Bricks& bricks, const Vec3i& brick);

  std::uint64_t column(int i, int j) const { return words_[(i + kLayers) * kSide + j + kLayers]; }
  /// Bits of the edges along an axis that start in a column and change sign.
  std::uint64_t crossed(int axis, int i, int j) const {
    const std::uint64_t here = column(i, j);
    return here ^ (axis == 2 ? here >> 1 : axis == 0 ? column(i + 1, j) : column(i, j + 1));
  }
  /// Bits of the cells of a column with both signs among their corners.
  std::uint64_t mixed(int i, int j) const {
    const std::uint64_t a = column(i, j), b = column(i + 1, j), c = column(i, j + 1), d = column(i + 1, j + 1);
    const std::uint64_t any = a | b | c | d, all = a & b & c & d;
    return (any | any >> 1) & ~(all & all >> 1);
  }
  /// Signs of a cell's corners, as a case code.
  int code(int i, int j, int k) const {
    const int b = k + kLayers;
    const auto pair = [&](int di, int dj, int c) {
      const auto bits = static_cast<unsigned>(column(i + di, j + dj) >> b & 3);
      return (bits & 1) << c | (bits >> 1) << (c + 4);
    };
    return static_cast<int>(pair(0, 0, 0) | pair(1, 0, 1) | pair(0, 1, 2) | pair(1, 1, 3));
  }
  /// The table entry of a cell. If the neighbour across a problem face has that face as its problem too, both cells
  /// take their second entry; the rule depends on signs alone, so both decide the same.
  const CellCase& entry(const CaseTable& table, int i, int j, int k) const {
    const CellCase& first = table[code(i, j, k)];
    if (first.problem == kNoFace) [[likely]]
      return first;
    int at[3] = {i, j, k};
    at[first.problem >> 1] += first.problem & 1 ? 1 : -1;
    const CellCase& across = table[code(at[0], at[1], at[2])];
    return across.problem == (first.problem ^ 1) ? table[first.second] : first;
  }

 private:
  std::array<std::uint64_t, kSide * kSide> words_;
};

}  // namespace riffler::marching
