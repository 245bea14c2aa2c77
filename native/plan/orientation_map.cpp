#include "riffler/plan/orientation_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/plan/contact_location.hpp"

namespace riffler::plan {

namespace {

void check_angles(const std::vector<double>& angles, const char* name, double most) {
  if (angles.empty()) throw std::invalid_argument(std::string(name) + ": at least one is needed");
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const std::string place = std::string(name) + ", row " + std::to_string(i) + ": ";
    if (!(std::abs(angles[i]) <= most))
      throw std::invalid_argument(place + "not within " + std::to_string(most) + " rad");
    if (i > 0 && !(angles[i] > angles[i - 1])) throw std::invalid_argument(place + "not more than the one before");
  }
}

OrientationMap blank(const PencilPath& path, std::size_t k, const MapRule& rule) {
  OrientationMap out;
  out.frame = frame_at(path, k);
  for (const double inclination : rule.inclinations)
    for (const double tilt : rule.tilts) out.axes.push_back(axis_of(out.frame, {inclination, tilt}));
  out.clearance.assign(out.axes.size(), std::numeric_limits<double>::quiet_NaN());
  out.state.assign(out.axes.size(), OrientationMap::State::Beyond);
  out.touch.assign(out.axes.size(), collide::Touch::Cutter);
  return out;
}

void fill(OrientationMap& map, std::size_t i, const PencilPath& path, std::size_t k, const CutterSupport& cutter,
          const collide::Assembly& assembly, const collide::Collider& collider, const MapRule& rule) {
  const Vec3& axis = map.axes[i];
  if (rule.limit && geom::angle_between(axis, rule.limit->about) > rule.limit->angle + 1e-12) return;
  Pose pose;
  try {
    pose = location_on_path(cutter, path, k, axis);
  } catch (const std::invalid_argument&) {
    map.state[i] = OrientationMap::State::Unreachable;
    return;
  }
  const double wanted = rule.clearance - rule.tolerance;
  using State = OrientationMap::State;
  if (!rule.clearances) {
    map.state[i] = collider.keeps(assembly, pose, wanted) ? State::Free : State::Blocked;
    return;
  }
  const collide::Collider::Nearest near = collider.nearest(assembly, pose);
  map.clearance[i] = near.distance, map.touch[i] = near.touch;
  map.state[i] = near.distance >= wanted ? State::Free : State::Blocked;
}

}  // namespace

void validate(const MapRule& rule) {
  check_angles(rule.inclinations, "inclinations", kPi);
  check_angles(rule.tilts, "tilts", kPi / 2);
  base::require(std::isfinite(rule.clearance), "clearance", "must be finite");
  base::require_not_negative(rule.tolerance, "tolerance", base::kFiniteAndNotNegative);
  if (!rule.limit) return;
  unit_axis(rule.limit->about, "limit");
  if (!(rule.limit->angle >= 0 && rule.limit->angle < kPi))
    throw std::invalid_argument("limit: the angle must be at least 0 and below pi rad");
}

std::optional<std::size_t> OrientationMap::least_tilt() const {
  std::optional<std::size_t> best;
  double least = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (state[i] != State::Free) continue;
    const double angle = geom::angle_between(axes[i], frame.z);
    if (!best || angle < least) best = i, least = angle;
  }
  return best;
}

std::string OrientationMap::why_none() const {
  static constexpr const char* kPieces[] = {"the cutter enters the part", "the shank enters the part",
                                            "the holder enters the part", "the tool enters a fixture"};
  if (least_tilt()) return {};
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (state[i] == State::Blocked && (!best || clearance[i] > clearance[*best])) best = i;
  if (!best) {
    const bool some = std::find(state.begin(), state.end(), State::Unreachable) != state.end();
    return some ? "the cutter cannot touch there with any axis within the limit" : "every axis is beyond the limit";
  }
  if (clearance[*best] >= 0)
    return "no axis keeps the clearance; at best it is " + std::to_string(clearance[*best]) + " mm";
  return std::string(kPieces[static_cast<int>(touch[*best])]) + " with every axis, at best by " +
         std::to_string(-clearance[*best]) + " mm";
}

std::vector<OrientationMap> orientation_maps(const PencilPath& path, const std::vector<std::size_t>& points,
                                             const collide::Assembly& assembly, const collide::Collider& collider,
                                             const MapRule& rule, const Progress& progress) {
  validate(rule);
  for (const std::size_t k : points)
    if (k >= path.size())
      throw std::invalid_argument("point " + std::to_string(k) + ": the path has " + std::to_string(path.size()) +
                                  " points");
  const CutterSupport cutter(assembly.tool());
  std::vector<OrientationMap> out;
  for (const std::size_t k : points) {
    base::report(progress, 0);
    out.push_back(blank(path, k, rule));
  }
  const std::size_t wide = rule.inclinations.size() * rule.tilts.size();
  base::parallel_for(
      points.size() * wide, 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          fill(out[i / wide], i % wide, path, points[i / wide], cutter, assembly, collider, rule);
      },
      progress);
  return out;
}

}  // namespace riffler::plan
