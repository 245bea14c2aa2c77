// Rule for approaches to cuts and retracts from them.
#pragma once

#include <optional>

#include "riffler/collide/collider.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Obstacles that approaches and retracts must clear, and how they move.
struct LinkRule {
  const collide::Collider* collider = nullptr;  ///< part and fixtures; null: no checks
  double tolerance = 0.02;                      ///< mm that the tool may enter them, since cuts touch the part
  std::optional<double> retract;                ///< mm of the first move out of a cut; default: as far as is clear
  std::optional<Vec3> direction;  ///< unit vector of that move; default: the tool's axis, or a clear direction
  /// mm before a cut to move at feed, with a rapid up to there; default: all of the approach at feed.
  std::optional<double> lead_in;
};

/// Throws std::invalid_argument naming the field.
void validate(const LinkRule& rule);

}  // namespace riffler::nc
