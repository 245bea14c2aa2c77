// Where programmed coordinates are in the part: datum shift, tilted working plane, rotation.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Place in the part = shift + turn (plane_shift + rotated p). The part's coordinates are those of the preset.
struct HeidenhainFrame {
  Vec3 shift{0};        ///< datum shift from before the plane was tilted
  Mat3 turn{1};         ///< of the working plane
  bool tilted = false;  ///< a plane was defined, be it an upright one
  Vec3 plane_shift{0};  ///< datum shift in the tilted plane
  double rotation = 0;  ///< deg, about the plane's normal

  bool operator==(const HeidenhainFrame&) const = default;

  Vec3 to_part(const Vec3& p) const;
  Vec3 from_part(const Vec3& p) const;
  Vec3 direction_to_part(const Vec3& v) const;
  /// The normal of the working plane, to which the tool is to stand.
  Vec3 normal() const { return turn[2]; }
};

/// Of PLANE SPATIAL and cycle 19: about X, then about Y, then about Z of the coordinates before, deg each.
Mat3 spatial_turn(const Vec3& angles);

}  // namespace riffler::nc
