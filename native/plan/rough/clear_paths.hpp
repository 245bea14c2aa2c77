// Paths for a cutter through what is cleared of one layer.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "plan/rough/layer.hpp"

namespace riffler::plan {

/// Finds paths on which the cutter stays at places where it may be and meets no cell with material: near a path's ends,
/// where passes stop and begin next to material, it may touch cells but removes no middle of one. References are kept.
class ClearPaths {
 public:
  /// `in`: places where the cutter may be; `standing`: cells that it never removes.
  ClearPaths(const PlaceGrid& grid, const PlaceSet& in, const PlaceSet& standing, const Layer& layer, double radius);

  /// The corners of a path, both ends included; empty if there is none of at most `most` mm.
  std::vector<Vec2> between(const Vec2& from, const Vec2& to, double most);
  /// A path to `to` from the nearest place around which nothing stands, so that a rapid may come down there; empty if
  /// there is none within `most` mm.
  std::vector<Vec2> from_above(const Vec2& to, double most);
  /// Call it when material has come back.
  void forget() { known_.assign(known_.size(), 0); }

 private:
  bool free(std::size_t place);
  bool open(const Vec2& p, const Vec2& from, const Vec2& to);
  bool straight(const Vec2& a, const Vec2& b, const Vec2& from, const Vec2& to);
  /// Places from `from` to the first one that is `found`, nearest to `aim` first; empty if there is none.
  std::vector<Vec2> search(const Vec2& from, const Vec2& aim, bool aimed, double most,
                           const std::function<bool(std::size_t)>& found);
  void pull(const std::vector<Vec2>& way, std::size_t first, std::size_t last, std::vector<Vec2>& out);

  const PlaceGrid* grid_;
  const PlaceSet* in_;
  PlaceBits standing_;
  const Layer* layer_;
  double radius_;
  std::vector<char> known_;  // places that are free
  std::vector<double> lengths_;
  std::vector<std::uint32_t> round_, before_;
  std::uint32_t rounds_ = 0;
};

}  // namespace riffler::plan
