// The reference for a path of many moves: the least over them, found by branch and bound in the few that are near.
#pragma once

#include <span>
#include <vector>

#include "reference/swept_distance.hpp"

namespace riffler::reference {

class SweptPath {
 public:
  SweptPath(const tool::Profile& profile, std::span<const Pose> poses);

  /// The moves that count for points within `reach` of `p`, as long as distances above `reach` need no telling apart.
  /// Every answer is right to 1e-10 mm.
  class Near {
   public:
    /// Signed distance of `q` from what the moves sweep, or `reach` if that is less: positive outside (then the true
    /// distance), negative inside (then at most the true depth).
    double distance(const Vec3& q) const;
    /// Whether a move reaches deeper than `depth` over q. Cheaper than the distance.
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
  /// Valid as long as the path is.
  Near near(const Vec3& p, double reach) const;

 private:
  std::vector<SweptDistance> moves_;
};

}  // namespace riffler::reference
