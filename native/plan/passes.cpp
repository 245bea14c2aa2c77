#include "plan/passes.hpp"

#include <cmath>
#include <optional>

#include "riffler/base/check.hpp"

namespace riffler::plan {

namespace {

struct Touch {
  Vec3 centre, contact, normal;
};

/// The ball that touches the part near a ball moved along its wall: placed on the nearest point, so that it follows a
/// curved wall.
std::optional<Touch> laid(const RollingBall& ball, const Vec3& near, const Vec3& away) {
  const double radius = ball.radius();
  const mesh::Closest::Hit hit = ball.part()(near, 2 * radius);
  if (hit.triangle < 0 || !(hit.distance > 0.1 * radius)) return {};
  const Foot foot{hit.point, (near - hit.point) / hit.distance, hit.triangle};
  const auto normal = ball.faced(foot);
  if (!normal || glm::dot(foot.away, away) < 0.5) return {};
  const Vec3 centre = foot.point + radius * foot.away;
  if (ball.part().within(centre, radius * (1 - 1e-6))) return {};
  return Touch{centre, foot.point, *normal};
}

/// Along the wall at `side`, away from the other one.
Vec3 outwards(const Station& s, int side) {
  const Vec3& here = s.feet[side].away;
  const Vec3& there = s.feet[1 - side].away;
  return glm::normalize(there - glm::dot(there, here) * here);
}

/// Moves from the valley to `distance` (mm) from it, in steps that are short relative to the ball.
std::optional<Touch> beside(const RollingBall& ball, const Station& s, int side, double distance) {
  const int steps = std::max(1, static_cast<int>(std::ceil(distance / (0.25 * ball.radius()))));
  Vec3 out = outwards(s, side);
  Touch touch{s.centre, s.feet[side].point, s.normals[side]};
  Vec3 away = s.feet[side].away;
  for (int k = 0; k < steps; ++k) {
    const auto next = laid(ball, touch.centre + (distance / steps) * out, away);
    if (!next) return {};
    touch = *next, away = (touch.centre - touch.contact) / ball.radius();
    out = glm::normalize(out - glm::dot(out, away) * away);
  }
  return touch;
}

}  // namespace

double stepover_of_scallop(double radius, double height) {
  base::require_finite(radius, "radius"), base::require_finite(height, "scallop");
  return 2 * std::sqrt(std::max(0.0, height * (2 * radius - height)));
}

std::vector<PencilPath> passes_beside(const RollingBall& ball, const Valley& valley, int count, double stepover,
                                      const Progress& progress) {
  constexpr std::size_t kStationsAReport = 16;
  std::vector<PencilPath> passes;
  for (int side = 0; side < 2; ++side)
    for (int k = 1; k <= count; ++k) {
      PencilPath pass;
      pass.radius = ball.radius();
      bool whole = true;
      const auto end = [&] {
        if (pass.size() > 1) passes.push_back(pass);
        pass.centres.clear(), pass.contacts.clear(), pass.normals.clear();
      };
      for (std::size_t n = 0; n < valley.stations.size(); ++n) {
        const Station& s = valley.stations[n];
        if (n % kStationsAReport == 0) base::report(progress, 0);
        if (const auto touch = beside(ball, s, side, k * stepover)) {
          pass.centres.push_back(touch->centre);
          pass.contacts.push_back({touch->contact, touch->contact});
          pass.normals.push_back({touch->normal, touch->normal});
        } else {
          whole = false;
          end();
        }
      }
      pass.closed = whole && valley.closed();
      end();
    }
  return passes;
}

}  // namespace riffler::plan
