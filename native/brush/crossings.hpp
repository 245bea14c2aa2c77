// Where the rays of one direction cross a patch, before and after its displacement.
#pragma once

#include <span>
#include <vector>

#include "brush/patch.hpp"
#include "riffler/dexel/grid.hpp"

namespace riffler::brush {

/// A place where a ray enters or leaves the material; cyclic frame, mm.
struct Crossing {
  double raw;   ///< on the triangle: orders the crossings of a ray
  double w;     ///< on the curved surface through the triangle's vertices
  Vec3 normal;  ///< unit, out of the material
  Vec3 way;     ///< displacement of the point: 0 before it
  bool enters;
  bool operator<(const Crossing& o) const { return raw != o.raw ? raw < o.raw : enters && !o.enters; }
};

/// The crossings of the rays of a grid, in order along each ray: the ends of the material that a mesh bounds, overlaps
/// united.
class Crossings {
 public:
  /// Adds a crossing of ray i · nv + j, in any order; `finish` sorts and unites them.
  void add(std::size_t ray, const Crossing& crossing) {
    found_.push_back(crossing), ray_.push_back(static_cast<std::uint32_t>(ray));
  }
  void finish(const dexel::Grid& grid);

  std::span<const Crossing> ray(int i, int j) const {
    const std::size_t r = static_cast<std::size_t>(i) * static_cast<std::size_t>(nv_) + static_cast<std::size_t>(j);
    return {found_.data() + begin_[r], found_.data() + begin_[r + 1]};
  }

 private:
  void sort(const dexel::Grid& grid);
  void unite();

  int nv_ = 0;
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> ray_;  // of each crossing found, until they are sorted
  std::vector<Crossing> found_;
};

/// The rays of one of the crop's grids that a triangle with a moved vertex crosses before or after the displacement,
/// and their crossings.
struct CrossedRays {
  CrossedRays(const dexel::Grid& grid, const Patch& patch);

  std::vector<bool> wanted;  ///< by number i · nv + j
  Crossings before, after;
};

}  // namespace riffler::brush
