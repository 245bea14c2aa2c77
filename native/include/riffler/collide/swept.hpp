// What a check of a motion answers.
#pragma once

#include <cstddef>

#include "riffler/collide/contact.hpp"

namespace riffler::collide {

/// Whether a tool that moves between two poses stays clear all along, not at sampled poses only.
struct Swept {
  enum class Answer {
    Clear,    ///< the clearance is at least the wanted one all along
    Gouges,   ///< it is less at time `at`
    Unknown,  ///< the evaluations ran out
  } answer = Answer::Unknown;
  double at = 0;         ///< time of the least clearance seen
  double clearance = 0;  ///< that clearance, mm; ∞ where everything is far off
  double bound = 0;      ///< no pose in between has less than this, mm
  Touch touch = Touch::Cutter;
  std::size_t evaluations = 0;  ///< groups of bounds, and triangles looked at by themselves
};

}  // namespace riffler::collide
