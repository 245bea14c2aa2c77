// Proves that a decimated surface is within its tolerance.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "mesh/decimate/near_surface.hpp"
#include "mesh/decimate/surface_map.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// Checks that old and new surface are near each other everywhere, with a map from the old surface to the new one.
///
/// Where the map exists, the old surface is near the new one. To show the converse, the check counts the sheets of the
/// map over an interior point of each new face. The map is continuous and takes borders to borders, so the number of
/// sheets is constant over a face: if it is not 0, the map covers the face, and the face is near the old surface.
///
/// Holes of the map are compared with the new surface directly. Inside a face, the number of sheets changes only across
/// the rim of a hole: the check divides such faces, follows the number across the rim, and compares the parts without a
/// sheet, or on the rim, with the old surface.
class MapCheck {
 public:
  /// Construct after the last collapse; `traces` must outlive the object.
  MapCheck(const Traces& traces, double tolerance, const Progress& progress = {});

  /// Old vertices around places that are, or may be, farther from the other surface than the tolerance. Empty if the
  /// tolerance holds.
  std::vector<int> far_vertices(const Progress& progress = {});

 private:
  /// A face that may not be covered, and the rims of holes in it.
  struct Doubt {
    int face;
    std::vector<SurfaceMap::Segment> rim;
    bool known;  // the number of sheets over its interior point is known
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

  const Traces& traces_;
  const HalfEdges& half_edges_;
  const HalfEdgeMesh& mesh_;
  double tolerance_;
  SurfaceMap map_;
  std::vector<char> hole_;  // for each old triangle: it is not mapped
  std::vector<int> holes_;
  std::vector<std::atomic<int>> sheets_;  // over the interior point of each new face
};

}  // namespace riffler::mesh
