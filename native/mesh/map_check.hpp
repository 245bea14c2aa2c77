// Proof that a decimated surface keeps to its tolerance.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "mesh/closest.hpp"
#include "mesh/surface_map.hpp"

namespace riffler {

/// Asks whether old and new surface are near each other everywhere, by a map from the old one onto the new.
///
/// Where there is a map, the old surface is near the new one. The sheets of the map over a point in the midst of each
/// new face are counted. Their number is the same all over a face, for the map is continuous and takes borders to
/// borders: where it is not 0 the face is covered, and so near the old surface.
///
/// Holes of the map are compared with the whole new surface. Within a face the number of sheets can only change across
/// the rim of a hole: such faces are divided, and what the rim crosses is compared with the old surface.
class MapCheck {
 public:
  /// After the last collapse; `traces` must outlive this.
  MapCheck(const Traces& traces, double tolerance);

  /// Old vertices round places that are farther from the other surface than the tolerance, or may be; none where the
  /// tolerance is kept to.
  std::vector<int> far_vertices();

 private:
  enum State : char { Mapped, Wide, Hole };  // Wide: also to faces that no corner goes to
  /// A face that may not be covered, the rims of holes in it, and what covers it.
  struct Doubt {
    int face;
    std::vector<SurfaceMap::Segment> rim;
    std::vector<SurfaceMap::Image> images;
  };

  bool exists(std::size_t t) const { return half_edges_.corner[3 * t] >= 0; }
  void map_all();
  std::vector<Doubt> doubts() const;
  void check_holes(std::vector<int>& far) const;
  void check_faces(std::vector<int>& far) const;
  Mesh old_surface_round(const std::vector<Doubt>& doubt) const;
  bool covered_or_near(const Closest& closest, const Doubt& doubt, const std::vector<SurfaceMap::Segment>& rim,
                       const std::array<Vec3, 3>& p, int depth) const;
  bool triangle_near(const Closest& closest, const Vec3& a, const Vec3& b, const Vec3& c, int hint, int depth) const;

  const Traces& traces_;
  const HalfEdges& half_edges_;
  const HalfEdgeMesh& mesh_;
  double tolerance_;
  SurfaceMap map_;
  std::vector<State> state_;              // of an old triangle
  std::vector<std::atomic<int>> sheets_;  // over the midst of a new face
};

}  // namespace riffler
