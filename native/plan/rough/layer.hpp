// The material of one layer of roughing, and the width of cut of a cutter that moves through it.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "plan/finish/cusp.hpp"
#include "plan/place_grid.hpp"
#include "riffler/geom/interval.hpp"

namespace riffler::plan {

/// Half the diagonal of a cell as a share of the spacing, rounded up.
constexpr double kCellRadius = 0.7072;

/// Distance, in spacings, between the cutter at the start of a pass and the nearest middle of a cell with material.
constexpr double kSpared = 0.75;

/// Heights of the stock in the cells around the places of a grid. No material of a cell is above its height.
class StockTops {
 public:
  /// `tops`: mm; −∞ where there is no stock.
  StockTops(const PlaceGrid& grid, Field tops, const CutterProfile& profile);

  double top(std::size_t place) const { return tops_[place]; }
  const Field& tops() const { return tops_; }
  /// Greatest height of all cells that the cutter at `p` may touch, mm.
  double highest(const Vec2& p) const;
  /// Removes what the cutter cuts on a straight move of its tip. The whole move counts as being at its higher end.
  void cut(const Vec3& from, const Vec3& to);

 private:
  static constexpr int kSteps = 4;  // number of distances from the axis in a spacing

  const PlaceGrid* grid_;
  Field tops_;
  std::vector<double> heights_;  // upper bound of the cutter's lower side over a cell, at each distance
  double radius_;
};

/// A set of places with one bit for each place: a disc is a few words in each row.
class PlaceBits {
 public:
  PlaceBits(const PlaceGrid& grid, const PlaceSet& set);

  /// Whether some place of the set is within `radius` of p.
  bool any_within(const Vec2& p, double radius) const;
  /// Removes the places within `radius` of p from the set, and calls visit(offset from p) for each.
  template <class Visit>
  void take_within(const Vec2& p, double radius, const Visit& visit) {
    const auto [first, last] = rows_within(p, radius);
    for (int row = first; row <= last; ++row) {
      const Run run = run_within(row, p, radius);
      const double dy = grid_->lower.y + row * grid_->spacing - p.y;
      each_word(row, run, [&](std::size_t word, std::uint64_t mask) {
        std::uint64_t found = words_[word] & mask;
        words_[word] &= ~mask;
        for (; found != 0; found &= found - 1) {
          const std::size_t column = 64 * (word % per_row_) + static_cast<std::size_t>(std::countr_zero(found));
          visit(Vec2(grid_->lower.x + static_cast<double>(column) * grid_->spacing - p.x, dy));
        }
        return false;
      });
    }
  }
  bool has(std::size_t place) const {
    const auto n = static_cast<std::size_t>(grid_->columns);
    return words_[place / n * per_row_ + place % n / 64] >> (place % n % 64) & 1;
  }

 private:
  struct Run {
    int first, last;  // columns
  };
  std::array<int, 2> rows_within(const Vec2& p, double radius) const;
  Run run_within(int row, const Vec2& p, double radius) const;
  /// Calls use(word, mask) for the words of a run until it returns true.
  template <class Use>
  bool each_word(int row, const Run& run, const Use& use) const {
    if (run.first > run.last) return false;
    const auto base = static_cast<std::size_t>(row) * per_row_;
    const int from = run.first / 64, to = run.last / 64;
    for (int k = from; k <= to; ++k) {
      std::uint64_t mask = ~std::uint64_t{0};
      if (k == from) mask &= ~std::uint64_t{0} << (run.first % 64);
      if (k == to) mask &= ~std::uint64_t{0} >> (63 - run.last % 64);
      if (use(base + static_cast<std::size_t>(k), mask)) return true;
    }
    return false;
  }

  const PlaceGrid* grid_;
  std::size_t per_row_;
  std::vector<std::uint64_t> words_;
};

/// The cells of a layer that have material. The cutter is a disc. A cell has material until the whole cell is removed.
class Layer {
 public:
  /// `material`: cells that the cutter can remove completely; `touched`: these, and cells whose middle it can remove;
  /// `radius`: of the cutter, mm.
  Layer(const PlaceGrid& grid, const PlaceSet& material, const PlaceSet& touched, double radius);

  /// Whether a cell that the cutter can remove completely still has material.
  bool material(std::size_t place) const { return material_.has(place); }
  /// Whether the cutter at `p` removes the last material of some cell.
  bool touches(const Vec2& p) const;
  /// Whether the cutter at `p` touches no cell with material. Also true between two such places a diagonal apart.
  bool frees(const Vec2& p) const;
  /// Whether no cell with material has its middle within `radius` (mm) of `p`.
  bool frees(const Vec2& p, double radius) const;
  /// Whether the cutter at `p` is more than `more` spacings from the middle of every cell with material. It may cut the
  /// sides of some cells.
  bool spares(const Vec2& p, double more) const;
  /// Moves the cutter by at most half a cell and removes the material that it touches. Returns the width of cut across
  /// the motion, mm. The width is that of the last few moves, because in one move only some cells at the rim lose their
  /// middles.
  double move(const Vec2& from, const Vec2& to);
  /// Removes the material that the cutter touches at `p`.
  void place(const Vec2& p);

 private:
  const PlaceGrid* grid_;
  PlaceBits material_, middles_;  // `middles_`: cells whose middle is not removed yet, for measuring widths
  double radius_;
  std::array<Interval, 4> widths_;  // cut by the last moves
  std::size_t moves_ = 0;
};

}  // namespace riffler::plan
