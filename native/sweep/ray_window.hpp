// The rays of a tile that one step may touch, as the vector kernels see them: plain arrays and numbers.
#pragma once

#include <cstdint>

#include "base/lanes.hpp"
#include "riffler/dexel/tile.hpp"
#include "sweep/quick_reject.hpp"

namespace riffler::sweep {

/// What a step takes from one ray: [near, far], and the motion's t at its two ends.
struct RayCut {
  double near, far, near_t, far_t;
};

/// Sums over the pieces of material taken, each weighted by its length and its ray's share of h². Every ray adds to the
/// slot of its column modulo kLanes, so that the result does not depend on how many rays a kernel handles at once.
struct alignas(64) RemovedSums {
  double length[base::kLanes] = {};
  double direction[3][base::kLanes] = {};  ///< Σ length × direction of the force (unit)
  double moment[3][base::kLanes] = {};     ///< Σ length × (middle − pivot) × direction
};

/// The tool's motion, for the direction of the force: the velocity of its material point at p and time t is
/// way + spin × (p − tip − t way).
struct ForceLaw {
  double tip[3], way[3], spin[3];
  double axis[3];   ///< direction where nothing moves
  double pivot[3];  ///< of the moment
  bool turns;       ///< spin is not zero
  double speed;     ///< |way|
};

struct RayWindow {
  // The tile (tile_cut.hpp): the only span of every ray, or the hull of several.
  const dexel::Span* rays;
  dexel::Span* opened;        ///< the same for writing, or null: `open` it first
  const std::uint32_t* many;  ///< bit b of row a: the ray holds several spans
  double u[dexel::kTileSide];
  alignas(64) double v[dexel::kTileSide + base::kLanes];
  bool uneven;  ///< some cells are no squares of the pitch: areas are share_u × share_v squares
  double share_u[dexel::kTileSide];
  alignas(64) double share_v[dexel::kTileSide + base::kLanes];
  double thinnest;  ///< mm: what is left thinner vanishes
  // The part that the step may touch: columns [first[a], end[a]) of rows first_row … last_row, at these heights.
  int first_row, last_row;
  std::uint8_t first[dexel::kTileSide], end[dexel::kTileSide];
  double low, high;
  QuickReject look;
  // What is wanted.
  bool in_place;    ///< cut single spans here; otherwise every cut goes to `cut`
  bool measured;    ///< add up the lengths taken
  bool with_force;  ///< and the directions
  const ForceLaw* law;
  void* self;
  void (*open)(void* self);                             ///< sets `rays` and `opened`
  void (*cut)(void* self, int ray, const RayCut& cut);  ///< what is not cut here
  RemovedSums* sums;
  // What was done.
  std::uint64_t tested = 0, changed = 0, hits = 0;
  bool emptied = false;  ///< rays have become empty here
};

}  // namespace riffler::sweep
