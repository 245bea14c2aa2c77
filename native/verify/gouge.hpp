// Gouges: material removed from inside the part, deeper below its surface than the tolerance.
#pragma once

#include "mesh/closest.hpp"
#include "verify/event.hpp"
#include "verify/loss.hpp"
#include "verify/moves.hpp"
#include "verify/workbench.hpp"

namespace riffler::verify {

/// Depth below the part's surface. Several threads may read it at once.
class PartSurface {
 public:
  /// `tolerance`: mm, smallest depth of a gouge. Throws std::invalid_argument for a mesh that `Closest` rejects.
  PartSurface(const Mesh& part, double tolerance);

  /// Includes the side of the surface.
  const mesh::Closest& closest() const { return closest_; }
  double tolerance() const { return tolerance_; }

  /// Largest depth below the part's surface (within 1 %), mm, and its point.
  struct Deepest {
    double depth = 0;
    Vec3 point{0};
  };
  /// Updates `worst` with the deepest point of [near, far] on a ray if that is deeper.
  void look_deeper(const Vec3& near, const Vec3& far, Deepest& worst) const;
  /// False if no point of the piece is deeper than the tolerance; true if one is, or nearly.
  bool deep(const Vec3& near, const Vec3& far) const;

 private:
  mesh::Closest closest_;
  double tolerance_;
};

/// The part as a volume on the stock's grids. Several threads may read it at once.
class Target {
 public:
  /// `frame`: that of the stock; `tolerance`: as PartSurface. Throws std::invalid_argument if no volume can be made of
  /// the mesh.
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

/// Adds an event for each move that removed part material in this slab, where the part has the material `part`.
/// `before` and `after`: the slab's states before and after the moves; `cuts`: indices in `moves`, ascending, of the
/// moves that may have done it.
void find_gouges(const PartSurface& surface, const SlabTiles& part, Workbench& bench, const SlabTiles& before,
                 const SlabTiles& after, const Moves& moves, std::span<const std::size_t> cuts,
                 std::vector<Event>& events);

/// Part material that the stock lacks from the start: an event of row 0, or nothing.
void find_missing(const Target& target, const dexel::Grid& grid, const Slab& slab, const SlabTiles& stock,
                  std::vector<Event>& events);

}  // namespace riffler::verify
