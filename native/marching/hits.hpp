// Where the surface crosses a lattice edge, and its normal there.
#pragma once

#include <array>

#include "marching/bricks.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::marching {

/// Topology never depends on hits: signs alone say which edges are crossed.
struct alignas(16) Hit {
  /// Place along the edge in pitches, up to half a pitch outside [0, 1] where the ray's own end lies there. A weak hit
  /// is one that its ray does not really have: no end near, or an end whose normal looks the wrong way; it has the axis
  /// as its normal and is stored kWeak lower.
  float place;
  std::array<float, 3> normal;  // unit, out of the material, in the lattice's axes

  static constexpr float kWeak = 32;
  bool weak() const { return place < -kWeak / 2; }
  double t() const { return weak() ? place + kWeak : place; }
};

/// Reads hits off the rays. In a volume of one direction the edges across the rays are crossed in the middle, half a
/// pitch from the ray, with the axis as normal; the ends of its rays have the ray's direction as normal.
/// For one thread: it remembers the last normal.
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
