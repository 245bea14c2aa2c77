// Whether a tool that moves between two poses stays clear: not at sampled poses only.
#pragma once

#include "collide/collider.hpp"

namespace riffler {

/// No point of the tool moves further than this between the poses at times `from` and `to` of the motion, mm: the tip's
/// way, and the turn at the furthest point from the tip.
double displacement(const Motion& motion, const Assembly& assembly, double from, double to);

struct SweptCheck {
  enum class Answer {
    Clear,    ///< the clearance is at least the wanted one all along
    Gouges,   ///< it is less at time `at`
    Unknown,  ///< the evaluations ran out
  } answer = Answer::Unknown;
  double at = 0;         ///< time of the least clearance seen
  double clearance = 0;  ///< that clearance, mm
  double bound = 0;      ///< no pose in between has less than this, mm; as far as it was checked
  Touch touch = Touch::Cutter;
  Vec3 point{0};
  int evaluations = 0;
};

/// Conservative advancement from both ends (Mirtich, PhD thesis, Berkeley 1996, 2.3.2, by halving): the clearance
/// changes by no more than the tool's points move, so between two poses with the clearances d0 and d1 and the
/// displacement D it is at least (d0 + d1 − D) / 2. Spans for which that is not yet `wanted` are halved, the first
/// first. Stops at the first pose with less. `start`, `end`: what is nearest at both ends, where it is known.
SweptCheck swept_check(const Collider& collider, const Assembly& assembly, const Motion& motion, double wanted,
                       int max_evaluations, const Collider::Nearest* start = nullptr,
                       const Collider::Nearest* end = nullptr);

}  // namespace riffler
