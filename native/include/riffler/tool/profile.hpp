// The cutter's profile: lines and arcs in the (radius, height) half-plane, from the tip upwards.
#pragma once

#include <optional>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/tool/piece.hpp"

namespace riffler::tool {

/// One step of a profile, from the end of the one before to `to` = (radius, height): a straight line, or, where
/// `centre` is given, an arc about it, the shorter way round.
struct ProfileSegment {
  Vec2 to;
  std::optional<Vec2> centre;
};

/// Starts at the tip (0, 0); heights never fall; ends at the radius with which the cutter ends.
class Profile {
 public:
  /// Throws std::invalid_argument naming the segment that is not finite, has a negative radius, falls, or whose arc
  /// does not pass through both its ends (by more than 1e-6 of its radius, or than kConcaveTolerance), or that reaches
  /// further than kLargest, its centre too.
  explicit Profile(std::vector<ProfileSegment> segments);

  const std::vector<ProfileSegment>& segments() const { return segments_; }
  double length() const { return segments_.back().to.y; }
  double max_radius() const { return max_radius_; }

  /// Convex pieces whose union is the cutter, from the tip upwards. Lines and outward arcs are exact; an inward
  /// (concave) arc becomes truncated cones that leave at most `kConcaveTolerance` of it.
  std::vector<Piece> pieces() const;

  static constexpr double kConcaveTolerance = 1e-3;  // mm
  static constexpr double kLargest = 1e6;            // mm: beyond, rounding is no longer small beside a tolerance

 private:
  std::vector<ProfileSegment> segments_;
  double max_radius_ = 0;
};

}  // namespace riffler::tool
