#include "collide/force_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collide/force_lanes.cpp"
// foreach_target.h must stay here; clang-format would sort it.
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "collide/outline-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::collide::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

namespace {

HWY_INLINE void add_at(double* sums, V x) {
  hn::StoreU(add(hn::LoadU(kD, sums), x), kD, sums);
}

/// Force, torque and stiffness of the points in `in`; see Contact::push and Contact::resist.
HWY_INLINE void add_force(const Centres& at, M in, V depth, V stiffness, const V (&area)[3], ForceSums& sums, int k) {
  const V factor = pick(in, mul(depth, stiffness), zero());
  const V force[3] = {mul(factor, area[0]), mul(factor, area[1]), mul(factor, area[2])};
  const V torque[3] = {sub(mul(at.y, force[2]), mul(at.h, force[1])), sub(mul(at.h, force[0]), mul(at.x, force[2])),
                       sub(mul(at.x, force[1]), mul(at.y, force[0]))};
  for (int i = 0; i < 3; ++i) add_at(sums.force[i] + k, force[i]), add_at(sums.torque[i] + k, torque[i]);
  const V size = sqrt(add(squared(area[0], area[1]), mul(area[2], area[2])));
  const M some = both(in, hn::Gt(size, zero()));
  const V per = hn::Div(set(1), pick(some, size, set(1))), per_mm = pick(some, mul(stiffness, size), zero());
  const V n[3] = {mul(per, area[0]), mul(per, area[1]), mul(per, area[2])};
  const V w[6] = {n[0],
                  n[1],
                  n[2],
                  sub(mul(at.y, n[2]), mul(at.h, n[1])),
                  sub(mul(at.h, n[0]), mul(at.x, n[2])),
                  sub(mul(at.x, n[1]), mul(at.y, n[0]))};
  int place = 0;
  for (int i = 0; i < 6; ++i) {
    const V row = mul(per_mm, w[i]);
    for (int j = 0; j <= i; ++j) add_at(sums.stiffness[place++] + k, mul(row, w[j]));
  }
}

}  // namespace

void AddPoints(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& points,
               const SamplePoints::AreaGroup& areas, const StiffnessRamp& ramp, double weight, double* distance,
               ForceSums& sums) {
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const Centres at(frame, points, k);
    Points inside(at.rho, at.z);
    for (const LaneEdge& e : outline) e.arc ? inside.add_arc(e) : inside.add_line(e);
    const V d = inside.distance();
    hn::StoreU(d, kD, distance + k);
    const M in = both(hn::Lt(d, zero()), hn::Ge(hn::Load(kD, points.radius + k), zero()));
    if (none(in)) continue;
    const V area[3] = {hn::Load(kD, areas.x + k), hn::Load(kD, areas.y + k), hn::Load(kD, areas.z + k)};
    const V above = min(max(add(hn::Div(sub(at.z, set(ramp.top)), set(ramp.length)), set(0.5)), zero()), set(1));
    const V k_at = add(set(ramp.stiffness.cutter), mul(above, set(ramp.stiffness.holder - ramp.stiffness.cutter)));
    add_force(at, in, hn::Neg(d), mul(set(weight), k_at), area, sums, k);
  }
}

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::collide {

HWY_EXPORT(AddPoints);

void add_points(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& points,
                const SamplePoints::AreaGroup& areas, const StiffnessRamp& ramp, double weight, double* distance,
                ForceSums& sums) {
  HWY_DYNAMIC_DISPATCH(AddPoints)(outline, frame, points, areas, ramp, weight, distance, sums);
}

void ForceSums::add_to(Contact& contact) const {
  const auto sum = [](const double* lanes) {
    double out = 0;
    for (int k = 0; k < base::kLanes; ++k) out += lanes[k];
    return out;
  };
  for (int i = 0; i < 3; ++i) contact.force[i] += sum(force[i]), contact.torque[i] += sum(torque[i]);
  int place = 0;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double s = sum(stiffness[place++]);
      contact.stiffness[i][j] += s;
      if (i != j) contact.stiffness[j][i] += s;
    }
}

}  // namespace riffler::collide

#endif
