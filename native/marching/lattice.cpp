#include "marching/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace riffler::marching {

namespace {

/// At 2²¹ pitches a cell still has more than four float32 steps: enough for the parities that keep vertices apart.
void check_reach(double reach, double pitch) {
  if (reach < 0x1p21 * pitch) return;
  std::ostringstream text;
  text << "the volume's box reaches " << reach << " mm from the origin; a mesh in float32 coordinates needs less than "
       << 0x1p21 * pitch << " mm (2^21 times the pitch)";
  throw std::invalid_argument(text.str());
}

}  // namespace

Lattice::Lattice(const Volume& volume) : axis_(volume.reference().axis()), pitch_(volume.frame().pitch) {
  const Box3 box = to_local(axis_, volume.frame().box);
  const bool tri_dexel = volume.grids().size() == 3;
  box_ = box;
  double reach = 0;
  for (int a = 0; a < 3; ++a) {
    reach = std::max({reach, std::abs(box.lower[a]), std::abs(box.upper[a])});
    rays_[a] = dexel::ray_count(box.size()[a], pitch_);
    origin_[a] = box.lower[a];
    // A lone ray may lie outside a box thinner than half a pitch. Its plane is moved to the middle of the box
    // (tri-dexel, or along the rays, where no rays lie in it), so that both faces are on the lattice's edges.
    const bool movable = tri_dexel || a == 2;
    if (rays_[a] == 1 && movable) origin_[a] = (box.lower[a] + box.upper[a] - pitch_) / 2;
    // In a volume of one direction, walls lie half a pitch from their rays.
    if (!tri_dexel && a != 2) box_.lower[a] -= pitch_ / 2, box_.upper[a] += pitch_ / 2;
  }
  check_reach(reach, pitch_);
  for (int a = 0; a < 3; ++a) reach = std::max({reach, std::abs(at(a, 0)), std::abs(at(a, points(a) - 1))});
  reach += pitch_ / 2;  // vertices may leave the outermost cells by less than that
  int exponent = 0;
  std::frexp(reach, &exponent);  // reach < 2^exponent
  step_ = std::ldexp(1.0, exponent - 24);
}

}  // namespace riffler::marching
