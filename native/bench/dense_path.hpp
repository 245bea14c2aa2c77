// The dense reference for a path of many moves: the least signed distance from the cutter's profile over 16 384 times a
// move, refined around the least. Times that cannot matter are skipped: the distance changes no faster than the tool
// moves, so a part of a move whose ends are far away is far away. Shares nothing with native/sweep but the profile.
#pragma once

#include <span>
#include <vector>

#include "geom/pose.hpp"
#include "tool/profile.hpp"

namespace riffler::reference {

class DensePath {
 public:
  DensePath(const Profile& profile, std::span<const Pose> poses);

  /// The moves that count for points within `reach` of `p`, as long as distances above `reach` need no telling apart.
  class Near {
   public:
    /// Signed distance of `q` from what the moves sweep, or `reach` if that is less: positive outside (then the true
    /// distance), negative inside (then at most the true depth).
    double distance(const Vec3& q) const { return path_->least(moves_, q, reach_, -1e300); }
    /// Whether a move reaches deeper than `depth` over q. Cheaper than the distance.
    bool deeper(const Vec3& q, double depth) const { return path_->least(moves_, q, -depth, -depth) < -depth; }
    bool inside(const Vec3& q) const { return deeper(q, 0); }
    /// Whether q is further than `distance` (below `reach`) from everything swept.
    bool farther(const Vec3& q, double distance) const {
      return path_->least(moves_, q, distance, distance) >= distance;
    }

   private:
    friend class DensePath;
    const DensePath* path_;
    double reach_;
    std::vector<std::size_t> moves_;
  };
  Near near(const Vec3& p, double reach) const;

 private:
  double at(const Motion& motion, const Vec3& p, double t) const;
  /// How fast the distance of `p` can change with t.
  double rate(const Motion& motion, const Vec3& p) const;
  /// The least distance over the moves if it is below `best`, else `best`; any value below `enough` ends the search.
  double least(const std::vector<std::size_t>& moves, const Vec3& p, double best, double enough) const;
  double least(const Motion& motion, const Vec3& p, double best, double enough) const;

  const Profile& profile_;
  double size_;  // distance of the cutter's farthest point from the tip
  std::vector<Motion> motions_;
};

}  // namespace riffler::reference
