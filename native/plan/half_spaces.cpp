#include "plan/half_spaces.hpp"

#include <algorithm>
#include <cmath>

#include "geom/math.hpp"

namespace riffler::plan {

namespace {

constexpr double kAlongPlane = 1e-9;  // sine of the angle below which a line counts as parallel to a plane

/// The box's lowest point along one axis; the middle if that axis does not matter.
double lowest_in_box(double up, double reach) {
  return std::abs(up) < kAlongPlane ? 0 : up > 0 ? -reach : reach;
}

/// The lowest point on the boundary line of spaces[i], within the spaces before it.
std::optional<Lowest2> lowest_on_edge(std::span<const HalfSpace<Vec2>> spaces, std::size_t i, const Vec2& up,
                                      double reach, double slack) {
  const double length2 = glm::dot(spaces[i].along, spaces[i].along);
  const Vec2 foot = spaces[i].along * (spaces[i].least / length2);
  const Vec2 way = Vec2(-spaces[i].along.y, spaces[i].along.x) / std::sqrt(length2);
  double low = -4 * reach, high = 4 * reach;
  int at_low = -1, at_high = -1;
  const auto clip = [&](const Vec2& along, double least, int id) {
    const double rate = glm::dot(along, way), need = least - glm::dot(along, foot);
    if (std::abs(rate) < kAlongPlane) return need <= slack;
    if (const double t = need / rate; rate > 0) {
      if (t > low) low = t, at_low = id;
    } else if (t < high) {
      high = t, at_high = id;
    }
    return true;
  };
  for (const double side : {-1.0, 1.0})
    if (!clip({side, 0}, -reach, -1) || !clip({0, side}, -reach, -1)) return {};
  for (std::size_t k = 0; k < i; ++k)
    if (!clip(spaces[k].along, spaces[k].least, static_cast<int>(k))) return {};
  if (low > high + slack) return {};
  const double slope = glm::dot(up, way);
  if (std::abs(slope) < kAlongPlane) {
    const double t = std::clamp(0.0, std::min(low, high), std::max(low, high));
    return Lowest2{foot + t * way, {static_cast<int>(i), t == low ? at_low : t == high ? at_high : -1}};
  }
  return Lowest2{foot + (slope > 0 ? low : high) * way, {static_cast<int>(i), slope > 0 ? at_low : at_high}};
}

/// Incremental algorithm, in the given order (Seidel, Discrete Comput. Geom. 6 (1991) 423).
std::optional<Lowest2> lowest_in_order(std::span<const HalfSpace<Vec2>> spaces, const Vec2& up, double reach,
                                       double slack) {
  Lowest2 best{{lowest_in_box(up.x, reach), lowest_in_box(up.y, reach)}, {-1, -1}};
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    if (glm::dot(spaces[i].along, best.point) >= spaces[i].least - slack) continue;
    if (glm::dot(spaces[i].along, spaces[i].along) < kAlongPlane * kAlongPlane) return {};
    const std::optional<Lowest2> next = lowest_on_edge(spaces, i, up, reach, slack);
    if (!next) return {};
    best = *next;
  }
  return best;
}

std::optional<Lowest3> lowest_in_order(std::span<const HalfSpace<Vec3>> spaces, const Vec3& up, double reach,
                                       double slack) {
  Lowest3 best{{lowest_in_box(up.x, reach), lowest_in_box(up.y, reach), lowest_in_box(up.z, reach)}, {-1, -1, -1}};
  std::vector<HalfSpace<Vec2>> flat;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    const Vec3& normal = spaces[i].along;
    if (glm::dot(normal, best.point) >= spaces[i].least - slack) continue;
    // In the plane of the violated half-space, with the box's six sides first.
    const Vec3 foot = normal * spaces[i].least;
    const Vec3 p = geom::any_perpendicular(normal);
    const Vec3 q = glm::cross(normal, p);
    flat.clear();
    const auto add = [&](const Vec3& along, double least) {
      flat.push_back({{glm::dot(along, p), glm::dot(along, q)}, least - glm::dot(along, foot)});
    };
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        Vec3 along(0);
        along[axis] = side;
        add(along, -reach);
      }
    for (std::size_t k = 0; k < i; ++k) add(spaces[k].along, spaces[k].least);
    const std::optional<Lowest2> in_plane = lowest_in_order(flat, {glm::dot(up, p), glm::dot(up, q)}, 4 * reach, slack);
    if (!in_plane) return {};
    const auto id = [](int at) { return at < 6 ? -1 : at - 6; };
    best = {foot + in_plane->point.x * p + in_plane->point.y * q,
            {static_cast<int>(i), id(in_plane->active[0]), id(in_plane->active[1])}};
  }
  return best;
}

/// Solves with few half-spaces: repeatedly adds the one that the current lowest point violates most.
template <class Vector>
auto lowest_of_few(std::span<const HalfSpace<Vector>> spaces, const Vector& up, double reach, double slack) {
  thread_local std::vector<HalfSpace<Vector>> few;
  thread_local std::vector<int> ids;
  few.clear(), ids.clear();
  while (true) {
    auto best = lowest_in_order(few, up, reach, slack);
    if (!best) return best;
    double most = slack;
    int next = -1;
    for (std::size_t k = 0; k < spaces.size(); ++k)
      if (const double out = spaces[k].least - glm::dot(spaces[k].along, best->point); out > most)
        most = out, next = static_cast<int>(k);
    // A half-space that is already included is violated only by rounding.
    if (next < 0 || std::find(ids.begin(), ids.end(), next) != ids.end()) {
      for (int& id : best->active) id = id < 0 ? -1 : ids[id];
      return best;
    }
    few.push_back(spaces[next]), ids.push_back(next);
  }
}

}  // namespace

std::optional<Lowest2> lowest(std::span<const HalfSpace<Vec2>> spaces, const Vec2& up, double reach, double slack) {
  return lowest_of_few(spaces, up, reach, slack);
}

std::optional<Lowest3> lowest(std::span<const HalfSpace<Vec3>> spaces, const Vec3& up, double reach, double slack) {
  return lowest_of_few(spaces, up, reach, slack);
}

}  // namespace riffler::plan
