// Paths for a cutter through the cleared area of one layer.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "plan/rough/layer.hpp"

namespace riffler::plan {

/// Finds paths along which the cutter stays at permitted places and meets no cell with material. Near a path's ends,
/// where passes stop and begin next to material, it may touch cells, but removes the middle of none. Keeps references
/// to its arguments.
class ClearPaths {
 public:
  /// `in`: places where the cutter may be; `standing`: cells that the cutter never removes; `radius`: of the cutter,
  /// mm.
  ClearPaths(const PlaceGrid& grid, const PlaceSet& in, const PlaceSet& standing, const Layer& layer, double radius);

  /// The corners of a path, including both ends; empty if there is no path of at most `most` mm.
  std::vector<Vec2> between(const Vec2& from, const Vec2& to, double most);
  /// A path to `to` from the nearest place with no material around it, so that a rapid may come down there; empty if
  /// there is no such place within `most` mm.
  std::vector<Vec2> from_above(const Vec2& to, double most);
  /// Must be called after material has been put back.
  void forget() { known_.assign(known_.size(), 0); }

 private:
  bool free(std::size_t place);
  bool open(const Vec2& p, const Vec2& from, const Vec2& to);
  bool straight(const Vec2& a, const Vec2& b, const Vec2& from, const Vec2& to);
  /// Places from `from` to the first place for which `found` returns true; empty if there is none. If `aimed`, searches
  /// towards `aim`.
  std::vector<Vec2> search(const Vec2& from, const Vec2& aim, bool aimed, double most,
                           const std::function<bool(std::size_t)>& found);
  void pull(const std::vector<Vec2>& way, std::size_t first, std::size_t last, std::vector<Vec2>& out);

  const PlaceGrid* grid_;
  const PlaceSet* in_;
  PlaceBits standing_;
  const Layer* layer_;
  double radius_;
  std::vector<char> known_;  // places that are known to be free
  std::vector<double> lengths_;
  std::vector<std::uint32_t> round_, before_;
  std::uint32_t rounds_ = 0;
};

}  // namespace riffler::plan
