// Level curves on the offset surface of a part: the places where a cutter at one height touches the part.
#pragma once

#include <optional>
#include <vector>

#include "plan/contours.hpp"
#include "plan/finish/patterns.hpp"
#include "plan/finish/steep_faces.hpp"

namespace riffler::plan {

/// A piece of a level curve, with the part to the right of the motion.
struct LevelPiece {
  std::vector<Vec3> tips;  ///< a closed one ends where it begins
  bool closed = false;
};

/// Level curves of the drop surface of part, fixtures and allowance, moved outwards by half the tolerance. The curves
/// therefore lie outside of the exact drop surface, by at most the tolerance. A grid of heights shows which curves
/// there are, the drop cutter finds their points, and DropCutter::rise bounds the error between two points.
class LevelCurves {
 public:
  /// `spacing`: of the grid's places, mm. `least_slope`: faces that are less steep are left out, rad. Throws
  /// std::invalid_argument if there are too many places.
  LevelCurves(const PatternScene& scene, double spacing, double least_slope, const Progress& progress);

  const PlaceGrid& grid() const { return grid_; }
  /// Heights of the surface at the grid's places, mm; below the part where the tool touches nothing.
  const Field& heights() const { return heights_; }
  double height(const Vec2& p) const;
  /// Whether some corner of the grid's cell around `p` is not above `z`: otherwise curves within the cell are not
  /// found.
  bool sees_below(const Vec2& p, double z) const;
  /// The point between `low`, where the surface is below `z`, and `high` at which it reaches `z`. The result is on the
  /// lower side, within the precision.
  Vec2 border(Vec2 low, Vec2 high, double z) const;

  /// The cutter with its tip at `p` and `z` if it touches an upright wall there with its full radius; its landing is
  /// there.
  std::optional<SurfacePoint> at_wall(const Vec2& p, double z) const;

  /// The pieces of the curves at height `z` that touch selected faces; with `near`, only those near its places.
  std::vector<LevelPiece> at(double z, const PlaceSet* near, std::vector<BlockedPlace>& blocked) const;

 private:
  struct Touch {
    bool meant = false;
    const char* blocked = nullptr;
  };
  void refine(const Vec2& a, const Vec2& b, double z, std::vector<Vec3>& out) const;
  std::optional<Vec2> between(const Vec2& a, const Vec2& b, double z) const;
  Touch touch(const Vec2& p, const Vec2& right, double z) const;
  Vec2 onto(const Vec2& p, const Vec2& right, double z) const;
  Vec3 end_between(const Vec3& in, const Vec3& out) const;
  void keep_meant(const std::vector<Vec3>& tips, bool closed, std::vector<LevelPiece>& out,
                  std::vector<BlockedPlace>& blocked) const;

  const PatternScene& scene_;
  double tolerance_, least_slope_, low_, reach_, middle_;
  DropCutter outer_;
  SteepFaces walls_;
  PlaceGrid grid_;
  Field heights_;
};

}  // namespace riffler::plan
