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

/// Points relative to the tip, in part directions.
struct Arms {
  V x, y, z;

  HWY_INLINE Arms(const ToolFrame& frame, const SphereGroup& points, int k)
      : x(sub(hn::Load(kD, points.x + k), set(frame.tip.x))),
        y(sub(hn::Load(kD, points.y + k), set(frame.tip.y))),
        z(sub(hn::Load(kD, points.z + k), set(frame.tip.z))) {}
};

HWY_INLINE void find_inside(std::span<const LaneEdge> outline, const ToolFrame& frame, PointGroup& group) {
  group.inside = 0;
  for (int k = 0; k < base::kLanes; k += lanes()) {
    const Centres at(frame, *group.points, k);
    Points place(at.rho, at.z);
    for (const LaneEdge& e : outline) e.arc ? place.add_arc(e) : place.add_line(e);
    const M in =
        both(both(place.inside, hn::Gt(place.square, zero())), hn::Ge(hn::Load(kD, group.points->radius + k), zero()));
    group.inside |= bits(in) << k;
    hn::StoreU(at.z, kD, group.z + k), hn::StoreU(place.square, kD, group.square + k);
  }
}

/// Force, torque and stiffness of the points in `in`; see Contact::push and Contact::resist. `per_size`: 1 over the
/// size of the area.
HWY_INLINE void add_force(const Arms& at, M in, V depth, V stiffness, const V (&area)[3], V per_size, ForceSums& sums,
                          int k) {
  const V factor = pick(in, mul(depth, stiffness), zero()), per_mm = pick(in, mul(stiffness, per_size), zero());
  // The wrench of the area's vector; force and stiffness are multiples of it and of its products.
  const V w[6] = {area[0],
                  area[1],
                  area[2],
                  sub(mul(at.y, area[2]), mul(at.z, area[1])),
                  sub(mul(at.z, area[0]), mul(at.x, area[2])),
                  sub(mul(at.x, area[1]), mul(at.y, area[0]))};
  for (int i = 0; i < 3; ++i)
    add_at(sums.force[i] + k, mul(factor, w[i])), add_at(sums.torque[i] + k, mul(factor, w[i + 3]));
  int place = 0;
#pragma GCC unroll 6  // else `w` is in memory
  for (int i = 0; i < 6; ++i) {
    const V row = mul(per_mm, w[i]);
#pragma GCC unroll 6
    for (int j = 0; j <= i; ++j) add_at(sums.stiffness[place++] + k, mul(row, w[j]));
  }
}

}  // namespace

void AddPoints(std::span<const LaneEdge> outline, const ToolFrame& frame, std::span<PointGroup> groups,
               const StiffnessRamp& ramp, ForceSums& sums) {
  // Groups do not wait for one another's square roots: none is added before all are found.
  for (PointGroup& group : groups) find_inside(outline, frame, group);
  const V per_length = set(1 / ramp.length), top = set(ramp.top);
  for (const PointGroup& group : groups) {
    const V cutter = set(group.weight * ramp.stiffness.cutter);
    const V more = set(group.weight * (ramp.stiffness.holder - ramp.stiffness.cutter));
    const SamplePoints::AreaGroup& areas = *group.areas;
    for (int k = 0; k < base::kLanes; k += lanes()) {
      const M in = from_bits(group.inside >> k);
      if (none(in)) continue;
      const V area[3] = {hn::Load(kD, areas.x + k), hn::Load(kD, areas.y + k), hn::Load(kD, areas.z + k)};
      const V z = hn::LoadU(kD, group.z + k);
      const V above = min(max(add(mul(sub(z, top), per_length), set(0.5)), zero()), set(1));
      add_force(Arms(frame, *group.points, k), in, sqrt(hn::LoadU(kD, group.square + k)), add(cutter, mul(above, more)),
                area, hn::Load(kD, areas.per_size + k), sums, k);
    }
  }
}

}  // namespace riffler::collide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace riffler::collide {

HWY_EXPORT(AddPoints);

void add_points(std::span<const LaneEdge> outline, const ToolFrame& frame, std::span<PointGroup> groups,
                const StiffnessRamp& ramp, ForceSums& sums) {
  HWY_DYNAMIC_DISPATCH(AddPoints)(outline, frame, groups, ramp, sums);
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
