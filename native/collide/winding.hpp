// On which side of a surface a point is, for surfaces that need not be closed.
#pragma once

#include <array>
#include <vector>

#include "collide/surface.hpp"

namespace riffler::collide {

/// Generalized winding number (Jacobson, Kavan and Sorkine-Hornung, ACM TOG 32(4) (2013) 33): 1 inside of a closed
/// surface whose normals point outwards, 0 outside, in between near openings. Triangles that are far off are taken
/// together, as a dipole at their middle (Barill et al., ACM TOG 37(4) (2018) 43), which costs less than 1e-2: enough
/// to tell a side. Refers to the surface.
class WindingNumber {
 public:
  explicit WindingNumber(const Surface& surface);

  double operator()(const Vec3& p) const;

 private:
  struct Dipole {
    Vec3 area{0}, middle{0};
    double size = 0;  // of all triangles, however they are turned

    void add(const Vec3& more, const Vec3& place, double by);
  };

  const Surface& surface_;
  std::vector<std::array<Dipole, base::kLanes>> dipoles_;  // of the tree's groups
};

}  // namespace riffler::collide
