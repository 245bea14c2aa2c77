#include "sweep/hull_part.hpp"

#include <algorithm>
#include <cmath>

#include "base/lanes.hpp"

namespace riffler::sweep {

namespace {

HullFace face_at(const tool::HalfSpace& half, const Mat3 (&frames)[2], const Vec3& way) {
  HullFace face;
  for (int pose = 0; pose < 2; ++pose) {
    const Vec3 n = frames[pose] * half.normal;
    for (int i = 0; i < 3; ++i) face.at[pose][i] = n[i];
    face.off[pose] = half.offset + (pose == 1 ? glm::dot(n, way) : 0.0);
    face.inverse[pose] = std::abs(n.z) > 1e-14 ? 1 / n.z : 0;
  }
  return face;
}

}  // namespace

HullBody::HullBody(const HullPart& of, const Box3& within) : part(of), box(within) {
  const RolledMotion& motion = *part.motion;
  const Vec3 from = motion.tip(part.t0), to = motion.tip(part.t1) - from;
  const Mat3 frames[2] = {motion.frame(part.t0), motion.frame(part.t1)};
  for (int i = 0; i < 3; ++i) tip[i] = from[i], way[i] = to[i];
  moved = glm::length(to), angle = motion.angle() * (part.t1 - part.t0);
  // Some ten times the rounding errors of a height over a face.
  const double size = part.hull->reach + moved;
  slack = 2e-15 * size, nearby = 2e-15 * size;
  for (const tool::HalfSpace& half : part.hull->faces)
    if (add(face_at(half, frames, to))) return;
  heights.resize(2 * faces.size() * base::kLanes);
  // The hull of a body at two poses an angle φ apart leaves the swept body by φ D / 4 at most, where D ≤ 2 reach is the
  // body's width across the axis of the turn.
  constexpr double kShare = 0.2;
  narrow = angle * std::min(part.hull->size, 2 * part.reach) / 4 <= kShare * part.tolerance;
}

/// Keeps a face that divides the box at one of the poses. Returns whether it has the box on its outer side at both.
bool HullBody::add(const HullFace& face) {
  const Vec3 middle = 0.5 * (box.lower + box.upper) - Vec3(tip[0], tip[1], tip[2]),
             half = 0.5 * (box.upper - box.lower);
  // far more than rounding, and far too little to matter
  const double margin = 1e-12 * (part.hull->reach + glm::length(middle) + glm::length(half));
  bool inside = true, outside = true;
  for (int pose = 0; pose < 2; ++pose) {
    double height = -face.off[pose], spread = margin;
    for (int i = 0; i < 3; ++i) height += face.at[pose][i] * middle[i], spread += std::abs(face.at[pose][i]) * half[i];
    inside = inside && height < -spread;
    outside = outside && height > spread;
  }
  if (!inside) faces.push_back(face);
  beside = outside;
  return outside;
}

}  // namespace riffler::sweep
