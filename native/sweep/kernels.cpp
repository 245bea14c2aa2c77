#include "sweep/kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/kernels.cpp"
// Keep clang-format from sorting foreach_target.h to another place.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "sweep/lanes/hull_lanes-inl.hpp"
#include "sweep/lanes/normal_lanes-inl.hpp"
#include "sweep/lanes/straight_lanes-inl.hpp"
#include "sweep/lanes/turning_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

void CutStraight(const StraightBody& body, RayWindow& window) {
  cut_straight_lanes(body, window);
}

void CutTurning(const TurningBody& body, RayWindow& window) {
  cut_turning_lanes(body, window);
}

void CutHull(const HullBody& body, RayWindow& window) {
  cut_hull_lanes(body, window);
}

void ComputeNormals(const SweptSurface& surface, SweptEnds& ends) {
  normal_lanes(surface, ends);
}

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <stdexcept>

namespace riffler::sweep {

HWY_EXPORT(CutStraight);
HWY_EXPORT(CutTurning);
HWY_EXPORT(CutHull);
HWY_EXPORT(ComputeNormals);

void cut_straight(const StraightBody& body, RayWindow& window) {
  HWY_DYNAMIC_DISPATCH(CutStraight)(body, window);
}

void cut_turning(const TurningBody& body, RayWindow& window) {
  HWY_DYNAMIC_DISPATCH(CutTurning)(body, window);
}

void cut_hull(const HullBody& body, RayWindow& window) {
  HWY_DYNAMIC_DISPATCH(CutHull)(body, window);
}

void compute_normals(const SweptSurface& surface, SweptEnds& ends) {
  HWY_DYNAMIC_DISPATCH(ComputeNormals)(surface, ends);
}

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

void use_instruction_set(const std::string& name) {
  std::int64_t chosen = name.empty() ? -1 : 0;
  hwy::SetSupportedTargetsForTest(0);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    if (name == hwy::TargetName(target)) chosen = target;
  if (chosen == 0) throw std::invalid_argument("this machine has no instruction set " + name);
  if (chosen > 0) hwy::SetSupportedTargetsForTest(chosen);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace riffler::sweep

#endif
