// The content of one ray: spans of material and, in tri-dexel volumes, the surface normal at each end.
#pragma once

#include <cstdint>

#include "riffler/geom/vec.hpp"

namespace riffler::dexel {

/// Material between two absolute coordinates along the ray, mm; near < far strictly, both finite.
struct Span {
  double near, far;
  double length() const { return far - near; }
  bool operator==(const Span&) const = default;
};

/// A unit normal in four bytes: octahedral map with 16 bits per component (Cigolle et al., "A Survey of Efficient
/// Representations for Independent Unit Vectors", JCGT 3(2), 2014). Error below 5e-5 rad. World frame, out of the
/// material.
struct PackedNormal {
  std::int16_t u = 0, v = 0;

  /// Packs a unit vector.
  static PackedNormal pack(const Vec3& n);
  /// The unit vector.
  Vec3 unpack() const;
  bool operator==(const PackedNormal&) const = default;
};

/// The normals at both ends of one span.
struct SpanNormals {
  PackedNormal near, far;
  bool operator==(const SpanNormals&) const = default;
};

}  // namespace riffler::dexel
