#include "marching/diagonal.hpp"

#include <cmath>

namespace riffler::marching {

namespace {

/// v[axis] for an axis known only at run time; glm's operator branches.
double component(const Vec3& v, int axis) {
  return (&v.x)[axis];
}

/// The quad seen along its edge, from outside, relative to corner 0: two coordinates across, the height along.
struct Projection {
  Vec2 p[4];
  double height[4];
  double area012, area023, area123, area130;  // doubled

  explicit Projection(const Quad& q) {
    const int b = (q.axis + 1) % 3, c = (q.axis + 2) % 3;
    const Vec3& origin = q.corner[0];
    p[0] = Vec2(0.0), height[0] = 0;
    for (int n = 1; n < 4; ++n) {
      const Vec3& corner = q.corner[n];
      // Seen from the other side, left and right are swapped.
      p[n] = {q.side * (component(corner, b) - component(origin, b)), component(corner, c) - component(origin, c)};
      height[n] = component(corner, q.axis) - component(origin, q.axis);
    }
    area012 = cross(p[1], p[2]), area023 = cross(p[2], p[3]);
    area123 = cross(p[2] - p[1], p[3] - p[1]), area130 = area012 + area023 - area123;
  }
  static double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

  /// Height at `o` of the triangle (r, s, t), whose doubled area is given.
  double height_at(const Vec2& o, int r, int s, int t, double area) const {
    const double at_s = cross(p[t] - o, p[r] - o), at_t = cross(p[r] - o, p[s] - o);
    return height[r] + ((height[s] - height[r]) * at_s + (height[t] - height[r]) * at_t) / area;
  }
};

double squared_length(const Vec3& v) {
  return glm::dot(v, v);
}

}  // namespace

Diagonals valid_diagonals(const Quad& quad) {
  const Projection s(quad);
  return {s.area012 > 0 && s.area023 > 0, s.area123 > 0 && s.area130 > 0};
}

int choose_diagonal(const Quad& quad, const Vec3& hit, double tie) {
  const Projection s(quad);
  const bool first = s.area012 > 0 && s.area023 > 0, second = s.area123 > 0 && s.area130 > 0;
  if (!first || !second) return first ? 0 : second ? 1 : -1;
  // Six times the volume between the two surfaces, over their area: approximately their maximum distance.
  const double apart = s.height[1] * s.area023 + s.height[3] * s.area012 - s.height[2] * s.area130;
  if (std::abs(apart) > tie * (s.area012 + s.area023)) {
    const int b = (quad.axis + 1) % 3, c = (quad.axis + 2) % 3;
    const Vec2 o{quad.side * (component(hit, b) - component(quad.corner[0], b)),
                 component(hit, c) - component(quad.corner[0], c)};
    const double target = component(hit, quad.axis) - component(quad.corner[0], quad.axis);
    const double at_first =
        Projection::cross(s.p[2], o) < 0 ? s.height_at(o, 0, 1, 2, s.area012) : s.height_at(o, 0, 2, 3, s.area023);
    const double at_second = Projection::cross(s.p[3] - s.p[1], o - s.p[1]) < 0 ? s.height_at(o, 1, 2, 3, s.area123)
                                                                                : s.height_at(o, 1, 3, 0, s.area130);
    const double first_off = std::abs(at_first - target), second_off = std::abs(at_second - target);
    if (std::abs(first_off - second_off) > tie) return first_off < second_off ? 0 : 1;
  }
  return squared_length(quad.corner[2] - quad.corner[0]) <= squared_length(quad.corner[3] - quad.corner[1]) ? 0 : 1;
}

}  // namespace riffler::marching
