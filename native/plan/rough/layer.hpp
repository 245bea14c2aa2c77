// The material of one layer of roughing, and how wide a moving cutter cuts into it.
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

/// Half the diagonal of a cell, as a share of the spacing, and a little.
constexpr double kCellRadius = 0.7072;

/// Spacings between the cutter and the next middle of a cell with material, where a pass begins.
constexpr double kSpared = 0.75;

/// Heights of the stock over the cells around the places of a grid. No cell holds more than its height tells.
class StockTops {
 public:
  /// `tops`: mm; −∞ where there is no stock.
  StockTops(const PlaceGrid& grid, Field tops, const CutterProfile& profile);

  double top(std::size_t place) const { return tops_[place]; }
  const Field& tops() const { return tops_; }
  /// The highest one of all cells that the cutter at `p` may touch.
  double highest(const Vec2& p) const;
  /// Takes off what the cutter removes on a straight move of its tip, as if all of that were as high as its higher end.
  void cut(const Vec3& from, const Vec3& to);

 private:
  static constexpr int kSteps = 4;  // distances from the axis, in a spacing

  const PlaceGrid* grid_;
  Field tops_;
  std::vector<double> heights_;  // of the cutter's lower side, at most, over a cell at each distance
  double radius_;
};

/// A set of places as one bit each, so that a disc is a few words in each row.
class PlaceBits {
 public:
  PlaceBits(const PlaceGrid& grid, const PlaceSet& set);

  /// Whether some place of the set is within `radius` of p.
  bool any_within(const Vec2& p, double radius) const;
  /// Takes those places out of the set, and calls visit(offset from p) for each.
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

/// Cells of a layer that have material, which the cutter removes within a radius. A cell has material until all of it
/// is removed.
class Layer {
 public:
  /// `material`: cells that the cutter can remove as a whole; `touched`: these, and those whose middle it can remove.
  Layer(const PlaceGrid& grid, const PlaceSet& material, const PlaceSet& touched, double radius);

  /// Whether a cell still has material that the cutter can remove as a whole.
  bool material(std::size_t place) const { return material_.has(place); }
  /// Whether the cutter at `p` removes the last of some cell.
  bool touches(const Vec2& p) const;
  /// Whether the cutter at `p`, and a spacing around it, is free of every cell.
  bool frees(const Vec2& p) const;
  /// Whether no middle of a cell with material is within `radius` of p.
  bool frees(const Vec2& p, double radius) const;
  /// Whether the cutter at `p` leaves `more` spacings around it to the next middle of a cell with material: it may
  /// shave the sides of some.
  bool spares(const Vec2& p, double more) const;
  /// Moves the cutter by at most half a cell and removes what it touches; the width across the motion, mm, of what it
  /// has removed in the last moves: in a single one only some cells along its rim lose their middles.
  double move(const Vec2& from, const Vec2& to);
  /// Removes what the cutter touches where it stands.
  void place(const Vec2& p);

 private:
  const PlaceGrid* grid_;
  PlaceBits material_, middles_;  // the latter until their middles are removed: widths are measured between those
  double radius_;
  std::array<Interval, 4> widths_;  // of the last moves
  std::size_t moves_ = 0;
};

}  // namespace riffler::plan
