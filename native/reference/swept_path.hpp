// Reference distance from a path of many moves: the smallest over the moves near a point, found by branch and bound.
#pragma once

#include <span>
#include <vector>

#include "reference/swept_distance.hpp"

namespace riffler::reference {

class SweptPath {
 public:
  SweptPath(const tool::Profile& profile, std::span<const Pose> poses);

  /// The moves that can be within `reach` of points within `reach` of `p`. All distances are accurate to 1e-10 mm;
  /// those above `reach` are not distinguished.
  class Near {
   public:
    /// Signed distance of `q` from the swept volume, at most `reach`. Positive outside, and exact there; negative
    /// inside, where its size is at most the true depth.
    double distance(const Vec3& q) const;
    /// Whether q is deeper than `depth` in some move's swept volume. Cheaper than the distance.
    bool deeper(const Vec3& q, double depth) const { return below(q, -depth); }
    bool inside(const Vec3& q) const { return below(q, 0); }
    /// Whether q is further than `distance` (below `reach`) from everything swept.
    bool farther(const Vec3& q, double distance) const { return !below(q, distance); }

   private:
    friend class SweptPath;
    bool below(const Vec3& q, double distance) const;

    double reach_;
    std::vector<const SweptDistance*> moves_;  // the nearest first
  };
  /// Refers to this path, which must outlive it.
  Near near(const Vec3& p, double reach) const;

 private:
  std::vector<SweptDistance> moves_;
};

}  // namespace riffler::reference
