// Where the surface crosses a lattice edge, and its normal there.
#pragma once

#include <array>

#include "marching/bricks.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::marching {

/// The topology never depends on hits: signs alone decide which edges are crossed.
struct alignas(16) Hit {
  /// Position along the edge in pitches, up to half a pitch outside [0, 1] if the ray's own end lies there. A weak hit
  /// is one that its ray does not really have: there is no end nearby, or the end's normal points in the wrong
  /// direction. Its normal is the axis, and its position is stored minus kWeak.
  float place;
  std::array<float, 3> normal;  // unit, out of the material, in the lattice's axes

  static constexpr float kWeak = 32;
  bool weak() const { return place < -kWeak / 2; }
  double t() const { return weak() ? place + kWeak : place; }
};

/// Reads hits from the rays. In a volume of one direction, edges across the rays are crossed at their midpoints, half a
/// pitch from the ray, with the axis as normal; the ends of rays have the ray's direction as normal. Not thread-safe:
/// caches the last normal.
class HitFinder {
 public:
  HitFinder(const Volume& volume, const Lattice& lattice);
  Hit operator()(const LatticeEdge& edge);

 private:
  const Lattice* lattice_;
  std::array<const dexel::Grid*, 3> grids_;  // null: no rays along that axis
  dexel::PackedNormal last_packed_{};
  Vec3 last_ = dexel::PackedNormal{}.unpack();
};

}  // namespace riffler::marching
