// Exact surfaces: rational B-spline (NURBS) patches, evaluated, searched and tessellated without an approximation.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/nurbs/patch.hpp"

namespace riffler::nurbs {

struct SurfaceCore;  // private to native/nurbs

/// A point of a surface with its unit normal, in the direction of dS/du × dS/dv. In a pole, where that is 0, the normal
/// is its limit from inside the patch. It is 0 where the patch has no area.
struct SurfacePoint {
  Vec3 point, normal;
};

/// The nearest point of a surface.
struct Foot {
  Vec3 point{0}, normal{0};
  double distance = 0;    // mm
  std::size_t patch = 0;  // index of its patch
  Vec2 uv{0};             // its parameters in that patch
};

/// Several patches, which need not be connected. It never changes; copies share their content, and several threads may
/// use one.
class Surface {
 public:
  /// Throws std::invalid_argument naming argument, row and remedy; the text begins with "patch N: " if there are
  /// several.
  explicit Surface(std::vector<Patch> patches);

  const std::vector<Patch>& patches() const;
  /// Box of the control points, which contains the surface, mm.
  Box3 bounds() const;

  /// Points and normals at parameters of one patch. Throws std::invalid_argument naming the row of parameters that are
  /// not in the domain, or a patch that does not exist.
  std::vector<SurfacePoint> evaluate(std::span<const Vec2> uv, std::size_t patch = 0,
                                     const Progress& progress = {}) const;

  /// Whether parameters of one patch are inside of its borders. Throws as `evaluate`.
  std::vector<char> inside(std::span<const Vec2> uv, std::size_t patch = 0) const;

  /// The nearest point of all patches, inside of their borders, to each of `points`. The distance is proven: no point
  /// of the surface is nearer by more than 1e-9 mm, or 1e-13 of the largest coordinate of surface and points if that is
  /// more. Throws std::invalid_argument naming a row that is not finite.
  std::vector<Foot> closest(std::span<const Vec3> points, const Progress& progress = {}) const;

  /// Triangles that are within `tolerance` (mm) of the surface everywhere, and the surface within `tolerance` of them:
  /// proven from bounds on second derivatives. Vertices lie on the surface. Neighbouring spans, seams of closed patches
  /// and patches with an edge in common (the same curve to 1e-12 of the largest coordinate) share vertices, and poles
  /// are one vertex, so what is closed stays closed. With borders, only equal corners are one vertex, and triangles
  /// that meet may have gaps within the tolerance between them. Counter-clockwise seen from the side of the normals.
  /// Throws std::invalid_argument for a tolerance below 1e-8 mm or 1e-10 of the largest coordinate, and if more than 50
  /// million triangles are necessary.
  Mesh to_mesh(double tolerance, const Progress& progress = {}) const;

  /// For code that uses the patches' Bézier form.
  const SurfaceCore& core() const { return *core_; }

 private:
  void check_parameters(std::span<const Vec2> uv, std::size_t patch) const;

  std::shared_ptr<const SurfaceCore> core_;
};

}  // namespace riffler::nurbs

namespace riffler {
using nurbs::Surface;
}  // namespace riffler
