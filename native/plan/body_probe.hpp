// Shank and holder of a tool in the stock.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::plan {

/// Moves a tool through a stock: its cutter cuts, and the rest of the tool must not touch what is left. The rest is
/// shank, holder, and a cylinder above the described tool, one pitch wider than its widest place. A copy of the
/// stock is carved with it, so a whole move is tested, not samples of it. It is smaller by half the tolerance, so that
/// contact and what turning moves leave of their surface do not count.
class BodyProbe {
 public:
  /// `up`: along which heights are measured, unit vector. `tolerance`: mm.
  BodyProbe(const Tool& tool, const Volume& stock, const Vec3& up, double tolerance);

  /// Forgets material that is gone: the rest of the tool can touch nothing above the highest place of `stock`.
  void lower_top(const Volume& stock);
  /// Whether the rest of the tool is above all of the stock during a move.
  bool above(const Pose& from, const Pose& to) const;
  /// Whether it would touch the stock in the moves to poses[ends[k]] from the poses before.
  bool touches(const Volume& stock, std::span<const Pose> poses, std::span<const std::uint32_t> ends) const;
  /// Cuts the stock with the moves between the poses. Returns what each removes, mm³.
  std::vector<double> cut(Volume& stock, std::span<const Pose> poses) const;
  /// Cuts the stock with one move, and adds what that removes to `removed`. If the rest of the tool touches what the
  /// cutter leaves, returns what meets the stock, and the stock may then be cut in part; else null.
  const char* strike(Volume& stock, const Pose& from, const Pose& to, double& removed) const;

 private:
  struct Member {
    const char* reason;
    std::vector<sweep::ConvexGroup> groups;
  };
  const char* strike(Volume& stock, const Pose& from, const Pose& to, double& removed, int halvings) const;
  bool touches(const Volume& stock, std::span<const sweep::ConvexGroup> groups, std::span<const Pose> poses,
               std::span<const std::uint32_t> ends) const;

  Vec3 up_;
  double tolerance_, top_ = 0;
  std::vector<tool::Frustum> pieces_;  // of shank, holder, and above
  std::vector<sweep::ConvexGroup> cutter_, all_;
  std::vector<Member> members_;
};

}  // namespace riffler::plan
