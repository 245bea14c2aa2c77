// Proof that a decimated surface keeps to its tolerance.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "mesh/closest.hpp"
#include "mesh/decimate/surface_map.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// Asks whether old and new surface are near each other everywhere, by a map from the old one onto the new.
///
/// Where there is a map, the old surface is near the new one. The sheets of the map over a point in the midst of each
/// new face are counted. Their number is the same all over a face, for the map is continuous and takes borders to
/// borders: where it is not 0 the face is covered, and so near the old surface.
///
/// Holes of the map are compared with the new surface. Within a face the number of sheets only changes across the rim
/// of a hole: such faces are divided, the number is followed across the rim, and what has no sheet or lies on the rim
/// is compared with the old surface.
class MapCheck {
 public:
  /// After the last collapse; `traces` must outlive this.
  MapCheck(const Traces& traces, double tolerance);

  /// Old vertices round places that are farther from the other surface than the tolerance, or may be; none where the
  /// tolerance is kept to.
  std::vector<int> far_vertices(const Progress& progress = {});

 private:
  using Corners = std::array<Vec3, 3>;
  /// A face that may not be covered, and the rims of holes in it.
  struct Doubt {
    int face;
    std::vector<SurfaceMap::Segment> rim;
    bool known;  // how many sheets lie over its midst
  };

  bool exists(std::size_t t) const { return half_edges_.corner[3 * t] >= 0; }
  Corners old_points(int t) const;
  void map_all(const Progress& progress);
  std::vector<Doubt> doubts() const;
  void check_holes(std::vector<int>& far, const Progress& progress) const;
  void check_faces(std::vector<int>& far, const Progress& progress) const;
  std::vector<char> faces_near(const std::vector<Doubt>& doubt, double smallest, const Progress& progress) const;
  bool add_uncovered(const Doubt& doubt, const std::vector<SurfaceMap::Segment>& rim, const Corners& p, double smallest,
                     int depth, int& left, std::vector<Corners>& pieces) const;
  std::vector<int> new_faces_near(const std::vector<Corners>& place, std::vector<int> seeds) const;
  std::vector<int> old_triangles_near(const std::vector<Corners>& place, std::vector<int> seeds) const;
  std::vector<char> near(const std::vector<Corners>& place, const std::vector<Corners>& surface,
                         const Progress& progress) const;
  bool triangle_near(const Closest& closest, const Vec3& a, const Vec3& b, const Vec3& c, int hint, int depth,
                     int& pieces) const;

  const Traces& traces_;
  const HalfEdges& half_edges_;
  const HalfEdgeMesh& mesh_;
  double tolerance_;
  SurfaceMap map_;
  std::vector<char> hole_;  // of an old triangle: not mapped
  std::vector<int> holes_;
  std::vector<std::atomic<int>> sheets_;  // over the midst of a new face
};

}  // namespace riffler::mesh
