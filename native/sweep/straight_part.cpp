#include "sweep/straight_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/hypot.hpp"

namespace riffler::sweep {

namespace {

SweptShape swept_shape(const tool::Piece& piece, bool hidden0, bool hidden1) {
  constexpr double kEverywhere = std::numeric_limits<double>::infinity();
  SweptShape s{shape_of(piece), false, false, -kEverywhere, kEverywhere, 0, 0, {}};
  s.face0 = s.cut0 && !hidden0 && s.r0 > 0, s.face1 = s.cut1 && !hidden1;
  // Rounding must not lose a hit at an end of the side, because the edge's own hits may be tangent there.
  const double slack = 1e-11 * (std::abs(s.z0) + std::abs(s.z1) + std::max(s.r0, s.r1));
  // Where a ray meets the line that a cone's apex sweeps, two roots coincide and lose half of their digits.
  const double apex = 1e-7 * (s.z1 - s.z0);
  if (s.cut0) s.low = s.z0 - (s.r0 > 0 ? slack : apex);
  if (s.cut1) s.high = s.z1 + (s.r1 > 0 ? slack : apex);
  return s;
}

}  // namespace

SectionLine::SectionLine(double a, double b, double least) {
  const double norm = geom::hypot(a, b);
  exists = norm >= least;
  if (exists) ds = -b / norm, dt = a / norm, per_norm = 1 / norm;
}

StraightBody::StraightBody(const ConvexGroup& group, const Pose& from, const Vec3& motion, double start, double end)
    : count(group.count),
      tilt(geom::hypot(from.axis.x, from.axis.y)),
      oz(from.axis.z),
      way(glm::length(motion)),
      t0(start),
      per_way(way > 0 ? (end - start) / way : 0),
      middle((start + end) / 2) {
  const Vec3 o = from.axis, unit = way > 0 ? motion / way : Vec3(0);
  const Vec3 a = tilt > 0 ? Vec3(-o.z * o.x / tilt, -o.z * o.y / tilt, tilt) : Vec3(1, 0, 0);
  const Vec3 b = tilt > 0 ? Vec3(o.y / tilt, -o.x / tilt, 0) : Vec3(0, o.z, 0);
  for (int i = 0; i < 3; ++i) tip[i] = from.tip[i], moved[i] = motion[i], axis[i] = o[i], e1[i] = a[i], e2[i] = b[i];
  m1 = glm::dot(unit, a), m2 = glm::dot(unit, b), mo = glm::dot(unit, o);
  face = SectionLine(oz, -mo, 1e-12);
  const double rise = way * (m1 * tilt + mo * oz);
  // The rim between two pieces sweeps a surface of its own if it is an edge; one of the pieces handles it.
  for (std::size_t k = 0; k < count; ++k) {
    SweptShape& s = pieces[k];
    s = swept_shape(group.pieces[k], k > 0 && smooth_together(group.pieces[k - 1], group.pieces[k]), k + 1 < count);
    const double reach = tilt * max_radius(group.pieces[k]), end0 = s.z0 * oz, end1 = s.z1 * oz;
    s.floor = (s.ball ? s.zc * oz - s.r : std::min(end0, end1) - reach) + std::min(rise, 0.0);
    s.ceiling = (s.ball ? s.zc * oz + s.r : std::max(end0, end1) + reach) + std::max(rise, 0.0);
    const double q = s.slope * s.slope;
    s.outline = SectionLine(q * oz * mo - tilt * m1, m1 * m1 + m2 * m2 - q * mo * mo, 1e-14);
  }
}

}  // namespace riffler::sweep
