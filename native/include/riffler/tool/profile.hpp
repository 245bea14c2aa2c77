// The cutter's profile: lines and arcs in the (radius, height) half-plane, from the tip upwards, in mm.
#pragma once

#include <optional>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/tool/piece.hpp"

namespace riffler::tool {

/// One segment of a profile, from the previous segment's end to `to` = (radius, height): a straight line, or the
/// shorter arc about `centre` if that is given.
struct ProfileSegment {
  Vec2 to;
  std::optional<Vec2> centre;
};

/// A profile starts at the tip (0, 0), its heights never fall, and it ends at the radius of the cutter's upper end.
class Profile {
 public:
  /// Throws std::invalid_argument naming the first bad segment: not finite, negative radius, falling height, an arc
  /// that misses one of its ends by more than 1e-6 of its radius or kConcaveTolerance, or a point or centre beyond
  /// kLargest.
  explicit Profile(std::vector<ProfileSegment> segments);

  const std::vector<ProfileSegment>& segments() const { return segments_; }
  /// Height of the upper end, and largest radius, mm.
  double length() const { return segments_.back().to.y; }
  double max_radius() const { return max_radius_; }

  /// Convex pieces whose union is the cutter, from the tip upwards. Lines and convex arcs are exact. Truncated cones
  /// replace a concave arc and leave at most `kConcaveTolerance` between them and the arc.
  std::vector<Piece> pieces() const;

  static constexpr double kConcaveTolerance = 1e-3;  // mm
  static constexpr double kLargest = 1e6;            // mm; beyond it, rounding errors are not small against a tolerance

 private:
  std::vector<ProfileSegment> segments_;
  double max_radius_ = 0;
};

}  // namespace riffler::tool
