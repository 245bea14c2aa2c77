// Inside test for surfaces that need not be closed.
#pragma once

#include <array>
#include <vector>

#include "collide/surface.hpp"

namespace riffler::collide {

/// Generalized winding number (Jacobson, Kavan and Sorkine-Hornung, ACM TOG 32(4) (2013) 33): 1 inside a closed surface
/// whose normals point outwards, 0 outside, in between near openings. Distant triangles are combined as a dipole at
/// their centroid (Barill et al., ACM TOG 37(4) (2018) 43), with an error below 1e-2: enough to decide a side. Keeps a
/// reference to the surface.
class WindingNumber {
 public:
  explicit WindingNumber(const Surface& surface);

  double operator()(const Vec3& p) const;

 private:
  struct Dipole {
    Vec3 area{0}, middle{0};
    double size = 0;  // sum of the triangles' areas

    void add(const Vec3& more, const Vec3& place, double by);
  };

  const Surface& surface_;
  std::vector<std::array<Dipole, base::kLanes>> dipoles_;  // per group of the tree
};

}  // namespace riffler::collide
