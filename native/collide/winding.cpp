#include "collide/winding.hpp"

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::collide {

namespace {

constexpr double kFar = 5;  // distance from a sphere's centre, in radii, beyond which its content is taken as a dipole

/// Half the solid angle, as the argument of a complex number (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30(2)
/// (1983) 125).
double half_angle(const Corners& t, const Vec3& p) {
  const Vec3 a = t.a - p, b = t.b - p, c = t.c - p;
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  return base::atan2(glm::dot(a, glm::cross(b, c)),
                     la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

}  // namespace

void WindingNumber::Dipole::add(const Vec3& more, const Vec3& place, double by) {
  area += more, size += by;
  if (size > 0) middle += by / size * (place - middle);
}

WindingNumber::WindingNumber(const Surface& surface) : surface_(surface), dipoles_(surface.tree().groups()) {
  const SphereTree& tree = surface.tree();
  for (std::size_t g = tree.groups(); g-- > 0;)
    for (int k = 0; k < base::kLanes; ++k) {
      Dipole& d = dipoles_[g][k];
      if (tree.group(g).radius[k] < 0) continue;
      if (tree.holds_items(g)) {
        const Corners& t = surface.corners(tree.first_item(g) + static_cast<std::size_t>(k));
        const Vec3 area = 0.5 * glm::cross(t.b - t.a, t.c - t.a);
        d.add(area, (t.a + t.b + t.c) / 3.0, glm::length(area));
      } else {
        for (const Dipole& below : dipoles_[tree.first_child(g) + static_cast<std::size_t>(k)])
          d.add(below.area, below.middle, below.size);
      }
    }
}

double WindingNumber::operator()(const Vec3& p) const {
  const SphereTree& tree = surface_.tree();
  double near = 0, far = 0;
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t g = open.back();
    open.pop_back();
    const bool items = tree.holds_items(g);
    for (int k = 0; k < base::kLanes; ++k) {
      const BoundingSphere s = tree.group(g).sphere(k);
      if (s.radius < 0) continue;
      const Dipole& d = dipoles_[g][k];
      if (glm::length(s.centre - p) > kFar * s.radius) {
        const Vec3 way = d.middle - p;
        const double distance = glm::length(way);
        far += glm::dot(d.area, way) / (distance * distance * distance);
      } else if (items) {
        near += half_angle(surface_.corners(tree.first_item(g) + static_cast<std::size_t>(k)), p);
      } else {
        open.push_back(tree.first_child(g) + static_cast<std::size_t>(k));
      }
    }
  }
  return (near + 0.5 * far) / (2 * kPi);
}

}  // namespace riffler::collide
