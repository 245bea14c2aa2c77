#include "collide/winding.hpp"

#include <cmath>

namespace riffler {

double winding_number(const Surface& surface, const Vec3& p) {
  // Half solid angles as arguments of complex numbers (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30(2)
  // (1983)).
  double sum = 0;
  for (std::size_t t = 0; t < surface.size(); ++t) {
    const Corners& at = surface.corners(t);
    const Vec3 a = at.a - p, b = at.b - p, c = at.c - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += std::atan2(glm::dot(a, glm::cross(b, c)),
                      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / 6.283185307179586;
}

}  // namespace riffler
