// The position of one vertex: the point that fits the tangent planes of a cycle's hits (dual contouring; Ju, Losasso,
// Schaefer and Warren, "Dual Contouring of Hermite Data", SIGGRAPH 2002), in cell units.
#pragma once

#include <array>

#include "riffler/geom/vec.hpp"

namespace riffler::marching {

/// A surface counts as smooth if the squared length of the mean of its unit normals exceeds this.
inline constexpr double kSmooth = 0.985;

/// The hits of one cycle: points and unit normals.
struct Tangents {
  int count = 0;
  std::array<Vec3, 12> point, normal;
};

/// How the surface bends in a cell, judged by the normals of the hits.
enum class Bend {
  Smooth,  // almost flat: the normals nearly agree
  Round,   // bends more tightly than cells can resolve: the normals differ by many angles
  Sharp,   // an edge or corner: the normals form two or three groups
};

/// Squared distances to the tangent planes: E(x) = xᵀAx − 2bᵀx + const, averaged over the hits.
class Qef {
 public:
  explicit Qef(const Tangents& tangents);

  Bend bend() const { return bend_; }
  /// The fit: for an edge or corner, the least squares point; otherwise the point along the normal from the hits' mean.
  Vec3 solve() const;
  /// The least squares point in a box.
  Vec3 solve_in(const Box3& box) const;
  /// Root mean square distance of x from the tangent planes.
  double residual(const Vec3& x) const;

 private:
  const Tangents& hits_;
  Vec3 mean_{0, 0, 0}, mean_normal_{0, 0, 0}, b_{0, 0, 0};
  Mat3 a_{0.0};
  Bend bend_;
};

}  // namespace riffler::marching
