// The rays of a tile that one step may touch, in plain arrays and numbers for the SIMD kernels.
#pragma once

#include <cstdint>

#include "base/lanes.hpp"
#include "riffler/dexel/tile.hpp"
#include "sweep/open_tile.hpp"
#include "sweep/quick_reject.hpp"

namespace riffler::sweep {

/// What a step removes from one ray: [near, far], with the motion's t at its two ends.
struct RayCut {
  double near, far, near_t, far_t;
};

/// Sums over the removed pieces of material, each weighted by its length and its ray's fraction of h². Every ray adds
/// to the slot of its column modulo kLanes, so the result does not depend on how many rays a kernel handles at once.
struct alignas(64) RemovedSums {
  double length[base::kLanes] = {};
  double direction[3][base::kLanes] = {};  ///< Σ length × unit direction of the force
  double moment[3][base::kLanes] = {};     ///< Σ length × (middle − pivot) × direction
};

/// The tool's motion, which gives the direction of the force: at time t, the material point at p has the velocity D +
/// spin × (p − tip − t D), with D the displacement of the tip.
struct ForceLaw {
  double tip[3], way[3], spin[3];
  double axis[3];   ///< direction used where nothing moves
  double pivot[3];  ///< reference point of the moment
  bool turns;       ///< spin is not zero
  double speed;     ///< length of D
};

struct RayWindow {
  // The tile (open_tile.hpp).
  const dexel::Span* rays;  ///< the plane `first`, for reading
  const RayPlanes* planes;  ///< all planes
  bool opened;              ///< whether they may be written; if not, call `open` first
  double step;              ///< origin of the ends that arise at the beginning of the motion (open_tile.hpp)
  double u[dexel::kTileSide];
  alignas(64) double v[dexel::kTileSide + base::kLanes];
  bool uneven;  ///< some cells are not squares of the pitch; their areas are share_u × share_v squares
  double share_u[dexel::kTileSide];
  alignas(64) double share_v[dexel::kTileSide + base::kLanes];
  double thinnest;  ///< mm; thinner remains vanish
  // The part that the step may touch: columns [first[a], end[a]) of the rows first_row … last_row, at these heights.
  int first_row, last_row;
  std::uint8_t first[dexel::kTileSide], end[dexel::kTileSide];
  double low, high;
  QuickReject look;
  // Options.
  bool with_times;  ///< the times at which ends arise are needed, for normals
  bool measured;    ///< sum up the removed lengths
  bool with_force;  ///< and their directions
  const ForceLaw* law;
  void* self;
  void (*open)(void* self);                             ///< sets `rays`, `planes` and `opened`
  void (*cut)(void* self, int ray, const RayCut& cut);  ///< cuts that are not made here
  RemovedSums* sums;
  // Results.
  std::uint64_t tested = 0, changed = 0, hits = 0;
};

}  // namespace riffler::sweep
