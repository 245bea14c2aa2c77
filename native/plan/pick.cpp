#include "plan/pick.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace riffler::plan {

namespace {

template <class Square>
Picked least(const PencilPath& path, const Square& square) {
  if (path.contacts.empty()) throw std::invalid_argument("the path has no points");
  Picked out{0, 0, std::numeric_limits<double>::infinity(), {}, {}};
  for (std::size_t k = 0; k < path.contacts.size(); ++k)
    for (int side = 0; side < 2; ++side)
      if (const double d = square(path.contacts[k][side]); d < out.distance)
        out.index = k, out.side = side, out.distance = d;
  out.distance = std::sqrt(out.distance);
  out.point = path.contacts[out.index][out.side], out.normal = path.normals[out.index][out.side];
  return out;
}

}  // namespace

Picked nearest_contact(const PencilPath& path, const Vec3& p) {
  if (!geom::finite(p)) throw std::invalid_argument("point: not finite");
  return least(path, [&](const Vec3& c) { return glm::dot(c - p, c - p); });
}

Picked nearest_contact(const PencilPath& path, const Vec3& origin, const Vec3& direction) {
  if (!geom::finite(origin)) throw std::invalid_argument("origin: not finite");
  const double length = glm::length(direction);
  if (!geom::finite(direction) || !(length > 0)) throw std::invalid_argument("direction: not finite or zero");
  const Vec3 way = direction / length;
  return least(path, [&](const Vec3& c) {
    const Vec3 off = c - origin - std::max(0.0, glm::dot(c - origin, way)) * way;
    return glm::dot(off, off);
  });
}

}  // namespace riffler::plan
