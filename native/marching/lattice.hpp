// The lattice that a volume's rays span, and the float32 coordinates that its mesh may use.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/dexel/volume.hpp"

namespace riffler::marching {

/// Lattice points (I, J, K) with one layer outside the volume on every side: 0 ≤ I ≤ count(0) + 1 and so on; I − 1 is
/// the index of a ray. Cell (I, J, K) is the cube between points (I, J, K) and (I + 1, J + 1, K + 1).
/// Axes are those of the world for a tri-dexel volume and the cyclic frame of its rays for any other.
class Lattice {
 public:
  /// Throws std::invalid_argument where the box reaches 2²¹ pitches or more from the origin.
  explicit Lattice(const Volume& volume);

  /// The direction whose cyclic frame the lattice works in.
  Axis axis() const { return axis_; }
  /// Rays along each axis, without the outer layers.
  int rays(int axis) const { return rays_[axis]; }
  int points(int axis) const { return rays_[axis] + 2; }
  int cells(int axis) const { return rays_[axis] + 1; }
  double pitch() const { return pitch_; }
  /// Nothing of the surface lies outside: the volume's box, and across the rays of one direction half a pitch more.
  const Box3& box() const { return box_; }
  /// Coordinate of lattice plane `index`; for planes that carry rays it is bit for bit what Grid::u and Grid::v say.
  double at(int axis, int index) const { return origin_[axis] + (index - 0.5) * pitch_; }
  /// The distance u between neighbouring float32 values where the lattice reaches furthest out, a power of two: every
  /// multiple of u that a vertex may take is a float32. A quarter of the pitch at most (or 1e-6 of it more).
  double step() const { return step_; }

 private:
  Axis axis_;
  std::array<int, 3> rays_;
  std::array<double, 3> origin_;
  Box3 box_;
  double pitch_, step_;
};

}  // namespace riffler::marching
