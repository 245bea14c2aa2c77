#include "sweep/hull_normals.hpp"

#include <cmath>

#include "geom/math.hpp"

namespace riffler::sweep {

namespace {

struct Nearest {
  double height = -geom::kInfinity, slide = 0;
  Vec3 normal{0, 0, 1};
  void add(const tool::HalfSpace& face, double at, double rate) {
    if (at > height) height = at, slide = rate, normal = face.normal;
  }
};

/// The outward unit normal of the swept body, in the tool's frame. `p` and `velocity`: of the tool's material point.
Vec3 swept_normal(const HullPart& part, const Vec3& p, const Vec3& velocity, double t) {
  Nearest all, leading, trailing;
  for (const tool::HalfSpace& face : part.hull->faces) {
    const double at = glm::dot(face.normal, p) - face.offset, rate = glm::dot(face.normal, velocity);
    all.add(face, at, rate);
    (rate > 0 ? leading : trailing).add(face, at, rate);
  }
  constexpr double kEnd = 1e-9;  // of time, which is stored with 30 bits
  if (t <= kEnd || t >= 1 - kEnd || all.slide == 0) return all.normal;
  const Nearest& other = all.slide > 0 ? trailing : leading;
  const double margin = 4 * part.error + 1e-8 * (part.hull->reach + glm::length(velocity));
  if (!(all.height - other.height <= margin)) return all.normal;
  // Along an edge the swept surface is where n · v = 0, for a normal between those of both faces.
  const Vec3 n = std::abs(other.slide) * all.normal + std::abs(all.slide) * other.normal;
  const double length = glm::length(n);
  return length > 0 ? n / length : all.normal;
}

}  // namespace

void hull_normals(const HullPart& part, Axis grid, SweptEnds& ends) {
  for (auto& array : ends.map) array.resize(ends.count);
  for (std::size_t k = 0; k < ends.count; ++k) {
    const double t = ends.t[k];
    const Vec3 at{ends.u[k], ends.v[k], ends.s[k]};
    const Mat3 frame = part.motion->frame(t), back = glm::transpose(frame);
    const Vec3 n = swept_normal(part, back * (at - part.motion->tip(t)), back * part.motion->velocity(at, t), t);
    const Vec3 out = -to_world(grid, frame * n);  // the material's new surface faces the tool
    const double sum = std::abs(out.x) + std::abs(out.y) + std::abs(out.z);
    double u = out.x / sum, v = out.y / sum;
    if (out.z < 0) {
      const double fu = (1 - std::abs(v)) * (u < 0 ? -1 : 1), fv = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
      u = fu, v = fv;
    }
    ends.map[0][k] = u, ends.map[1][k] = v;
  }
}

}  // namespace riffler::sweep
