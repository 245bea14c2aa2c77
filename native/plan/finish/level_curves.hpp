// Curves of one height on the offset surface of a part: where a cutter at that height touches it.
#pragma once

#include <optional>
#include <vector>

#include "plan/contours.hpp"
#include "plan/finish/patterns.hpp"
#include "plan/finish/steep_faces.hpp"

namespace riffler::plan {

/// A piece of such a curve, with the part to the right of the motion.
struct LevelPiece {
  std::vector<Vec3> tips;  ///< a closed one ends where it begins
  bool closed = false;
};

/// Levels of the drop surface of part, fixtures and allowance, moved outwards by half the tolerance: curves lie
/// between the surface without that, and the tolerance. A grid tells which curves there are; their points are found
/// with the drop cutter, and what lies between two points is bounded by DropCutter::rise.
class LevelCurves {
 public:
  /// `spacing` (mm) of the grid's places. Faces less steep than `least_slope` (rad) are not meant. Throws
  /// std::invalid_argument if there are too many places.
  LevelCurves(const PatternScene& scene, double spacing, double least_slope, const Progress& progress);

  const PlaceGrid& grid() const { return grid_; }
  /// Heights of the surface at the places, mm; below the part where the tool touches nothing.
  const Field& heights() const { return heights_; }
  double height(const Vec2& p) const;
  /// Where between a place below `z` and one that is not the height is z: the lower side, within the precision.
  Vec2 border(Vec2 low, Vec2 high, double z) const;

  /// The pieces that touch faces which are meant, near the places of `near` if there is one.
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
