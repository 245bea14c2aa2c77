// What approaches to cuts and retracts from them keep clear of.
#pragma once

#include <optional>

#include "riffler/collide/collider.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// What approaches and retracts must keep clear of, and how they go.
struct LinkRule {
  const collide::Collider* collider = nullptr;  ///< part and fixtures; null: nothing is looked at
  double tolerance = 0.02;                      ///< mm that the tool may enter them: cuts touch the part
  std::optional<double> retract;                ///< mm of the first stretch out of a cut; not given: what is clear
  std::optional<Vec3> direction;  ///< unit, of that stretch; not given: along the tool's axis, or what is clear
  /// mm before a cut that are fed, the way down to there is a rapid; not given: all of it is fed.
  std::optional<double> lead_in;
};

/// Throws std::invalid_argument naming the option.
void validate(const LinkRule& rule);

}  // namespace riffler::nc
