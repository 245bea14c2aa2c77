// The material of one layer of roughing, and how wide a moving cutter cuts into it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "plan/finish/cusp.hpp"
#include "plan/place_grid.hpp"
#include "riffler/geom/interval.hpp"

namespace riffler::plan {

/// Heights of the stock over the cells around the places of a grid. No cell holds more than its height tells.
class StockTops {
 public:
  /// `tops`: mm; −∞ where there is no stock.
  StockTops(const PlaceGrid& grid, Field tops, const CutterProfile& profile);

  double top(std::size_t place) const { return tops_[place]; }
  const Field& tops() const { return tops_; }
  /// The highest one of all cells that the cutter at `p` may touch.
  double highest(const Vec2& p) const;
  /// Takes off what the cutter removes with its tip at `tip`.
  void cut(const Vec3& tip);

 private:
  static constexpr int kSteps = 4;  // distances from the axis, in a spacing

  const PlaceGrid* grid_;
  Field tops_;
  std::vector<double> heights_;  // of the cutter's lower side, at most, over a cell at each distance
  double radius_;
};

/// Cells of a layer that have material, which the cutter removes within a radius. A cell has material until all of it
/// is removed.
class Layer {
 public:
  /// `material`: cells that the cutter can remove as a whole; `touched`: these, and those whose middle it can remove.
  Layer(const PlaceGrid& grid, PlaceSet material, PlaceSet touched, double radius);

  const PlaceSet& material() const { return material_; }
  /// Whether the cutter at `p` removes the last of some cell.
  bool touches(const Vec2& p) const;
  /// Whether the cutter at `p` is free of every cell.
  bool frees(const Vec2& p) const;
  /// Moves the cutter by at most half a cell and removes what it touches; the width across the motion, mm, of what it
  /// has removed in the last moves: in a single one only some cells along its rim lose their middles.
  double move(const Vec2& from, const Vec2& to);
  /// Removes what the cutter touches where it stands.
  void place(const Vec2& p);

 private:
  const PlaceGrid* grid_;
  PlaceSet material_, middles_;  // the latter until their middles are removed: widths are measured between those
  double radius_;
  std::array<Interval, 4> widths_;  // of the last moves
  std::size_t moves_ = 0;
};

/// Half the diagonal of a cell, as a share of the spacing, and a little.
constexpr double kCellRadius = 0.7072;

}  // namespace riffler::plan
