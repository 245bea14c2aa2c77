// From programmed to part coordinates: datum shift, tilted working plane, rotation.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Place in the part = shift + turn (plane_shift + rotated p). Part coordinates are those of the preset.
struct HeidenhainFrame {
  Vec3 shift{0};        ///< datum shift set before the plane was tilted
  Mat3 turn{1};         ///< rotation of the working plane
  bool tilted = false;  ///< a plane was defined, possibly an untilted one
  Vec3 plane_shift{0};  ///< datum shift in the tilted plane
  double rotation = 0;  ///< deg, about the plane's normal

  bool operator==(const HeidenhainFrame&) const = default;

  Vec3 to_part(const Vec3& p) const;
  Vec3 from_part(const Vec3& p) const;
  Vec3 direction_to_part(const Vec3& v) const;
  /// The normal of the working plane, along which the tool should stand.
  Vec3 normal() const { return turn[2]; }
};

/// PLANE SPATIAL and cycle 19: rotations about X, then Y, then Z of the previous coordinates, in degrees.
Mat3 spatial_turn(const Vec3& angles);

}  // namespace riffler::nc
