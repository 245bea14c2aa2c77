// From programmed to part coordinates of Sinumerik programs: TRANS, ROT, and the plane of CYCLE800.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// Place in the part = shift + turn p.
struct SinumerikFrame {
  Mat3 turn{1};
  Vec3 shift{0};

  bool operator==(const SinumerikFrame&) const = default;

  Vec3 to_part(const Vec3& p) const { return turn * p + shift; }
  Vec3 from_part(const Vec3& p) const { return glm::transpose(turn) * (p - shift); }
  /// `inner` within this frame.
  SinumerikFrame with(const SinumerikFrame& inner) const { return {turn * inner.turn, to_part(inner.shift)}; }
};

}  // namespace riffler::nc
