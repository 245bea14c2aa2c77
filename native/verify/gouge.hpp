// Gouges: what a program takes from inside the part, deeper under its surface than the tolerance.
#pragma once

#include "mesh/closest.hpp"
#include "verify/event.hpp"
#include "verify/loss.hpp"
#include "verify/moves.hpp"
#include "verify/workbench.hpp"

namespace riffler::verify {

/// How deep under the part's surface. Read by several threads at once.
class PartSurface {
 public:
  /// `tolerance`: mm, depth from which on it is a gouge. std::invalid_argument for a mesh that `Closest` does not take.
  PartSurface(const Mesh& part, double tolerance);

  /// With sides.
  const mesh::Closest& closest() const { return closest_; }
  double tolerance() const { return tolerance_; }

  /// How deep under the part's surface (to 1 %), mm, and where.
  struct Deepest {
    double depth = 0;
    Vec3 point{0};
  };
  /// Makes `worst` the deepest point of [near, far] on a ray, where that is deeper.
  void look_deeper(const Vec3& near, const Vec3& far, Deepest& worst) const;
  /// False where no point of the piece is deeper than the tolerance; true where one is, or nearly.
  bool deep(const Vec3& near, const Vec3& far) const;

 private:
  mesh::Closest closest_;
  double tolerance_;
};

/// The part over a stock's grids. Read by several threads at once.
class Target {
 public:
  /// `frame` is the stock's; `tolerance` as for PartSurface. std::invalid_argument where the mesh is none to make a
  /// volume of.
  Target(const Mesh& part, const dexel::Frame& frame, double tolerance, const Progress& progress = {});

  const PartSurface& surface() const { return surface_; }
  const Box3& bounds() const { return bounds_; }
  /// The part's material in a slab of the stock.
  SlabTiles tiles(const Slab& slab) const { return tiles_of(volume_.grids()[slab.grid], slab); }

 private:
  Volume volume_;
  PartSurface surface_;
  Box3 bounds_;
};

/// Adds an event for each move that took from the part in this slab, where it has the material `part`. `before` and
/// `after` are the slab's states round the moves, `cuts` the moves that may have done it (places in `moves`),
/// ascending.
void find_gouges(const PartSurface& surface, const SlabTiles& part, Workbench& bench, const SlabTiles& before,
                 const SlabTiles& after, const Moves& moves, std::span<const std::size_t> cuts,
                 std::vector<Event>& events);

/// Material of the part that the stock lacks from the start: an event of row 0, or nothing.
void find_missing(const Target& target, const dexel::Grid& grid, const Slab& slab, const SlabTiles& stock,
                  std::vector<Event>& events);

}  // namespace riffler::verify
