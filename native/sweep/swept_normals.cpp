#include "sweep/swept_normals.hpp"

#include <algorithm>
#include <cmath>

#include "base/lanes.hpp"

namespace riffler::sweep {

namespace {

/// The times between which a step moves.
Interval times(const Step& step) {
  if (const auto* part = std::get_if<TurningPart>(&step.body)) return {part->t0, part->t1};
  const StraightBody& body = std::get<StraightPart>(step.body).body;
  return {body.t0, body.t0 + body.way * body.per_way};
}

}  // namespace

SweptSurface::SweptSurface(const Step& step, Axis grid) {
  const ConvexGroup& group = group_of(step);
  count = group.count;
  std::transform(group.pieces.begin(), group.pieces.begin() + group.count, pieces.begin(), shape_of);
  const Motion& motion = *step.motion;
  const Interval t = times(step);
  angle = motion.angle(), middle = (t.near + t.far) / 2;
  constexpr double kSeries = 0.125;  // rad, where the kernel's series ends below 1e-16 (pose_lanes-inl.hpp)
  wide = angle * (t.far - t.near) / 2 > kSeries;
  const Vec3 from = motion.from().tip, to = motion.to().tip, turn = motion.rotation(), now = motion.axis(middle);
  const Vec3 sideways = angle > 0 ? glm::cross(turn / angle, now) : Vec3(0);
  for (int i = 0; i < 3; ++i) {
    tip[i] = from[i], way[i] = to[i] - from[i], spin[i] = turn[i];
    axis[i] = now[i], side[i] = sideways[i];
  }
  if (angle == 0) {  // from 0 to 1 on the body's own path
    const StraightBody& body = std::get<StraightPart>(step.body).body;
    std::copy_n(body.tip, 3, tip), std::copy_n(body.moved, 3, way);
  }
  world = (2 - static_cast<int>(grid)) % 3;
}

void SweptEnds::reserve(std::size_t ends) {
  for (auto* array : {&u, &v, &s, &t, &map[0], &map[1]}) array->reserve(ends + base::kLanes);
}

void SweptEnds::clear() {
  count = 0;
  for (auto* array : {&u, &v, &s, &t, &axis[0], &axis[1], &axis[2]}) array->clear();
}

void SweptEnds::add(double u_at, double v_at, double s_at, double t_at) {
  u.push_back(u_at), v.push_back(v_at), s.push_back(s_at), t.push_back(t_at);
  ++count;
}

void SweptEnds::complete(const SweptSurface& surface, const Motion& motion) {
  while (u.size() % base::kLanes)
    for (auto* array : {&u, &v, &s, &t}) array->push_back(array->back());
  for (auto& array : map) array.resize(u.size());
  if (!surface.wide) return;
  for (auto& array : axis) array.resize(u.size());
  for (std::size_t k = 0; k < u.size(); ++k) {
    const Vec3 at = motion.axis(t[k]);
    for (int i = 0; i < 3; ++i) axis[i][k] = at[i];
  }
}

}  // namespace riffler::sweep
