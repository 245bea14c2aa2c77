// The result of a check of a motion.
#pragma once

#include <cstddef>

#include "riffler/collide/contact.hpp"

namespace riffler::collide {

/// Whether a tool that moves between two poses keeps its clearance along the whole motion, not only at sampled poses.
struct Swept {
  enum class Answer {
    Clear,    ///< the clearance is at least the wanted one along the whole motion
    Gouges,   ///< the clearance is less at time `at`
    Unknown,  ///< the evaluation limit was reached
  } answer = Answer::Unknown;
  double at = 0;         ///< time of the smallest clearance found, 0 to 1
  double clearance = 0;  ///< that clearance, mm; ∞ where every obstacle is far away
  double bound = 0;      ///< lower bound of the clearance over the whole motion, mm
  Touch touch = Touch::Cutter;
  std::size_t evaluations = 0;  ///< groups of bounds, and triangles tested one by one
};

}  // namespace riffler::collide
