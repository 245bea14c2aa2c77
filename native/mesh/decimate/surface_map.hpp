// A map from an old surface to the new one that moves every point only a little.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/decimate/near_surface.hpp"
#include "mesh/decimate/tolerance_check.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// A continuous map from the surface before a decimation to the one after it. It moves no point farther than the
/// tolerance, and has holes where no such map was found. It is independent of the checks of single collapses, except
/// for its starting points.
///
/// Construction:
///  - An old vertex maps to a point of a new face; a border vertex maps to a point of the border.
///  - If the ends of an old edge map to two faces, the edge needs a point near the edge or vertex that these faces
///    share; otherwise the edge is divided.
///  - A triangle maps to one face, or to two with their common edge or vertex, or to three around a vertex near a
///    point of the triangle; otherwise it is divided. Each piece has all its corners near one face, and the set of
///    points near a triangle is convex: so the linear map of the piece moves no point farther than its corners.
class SurfaceMap {
 public:
  /// A piece of a new face, the image of a piece of an old triangle or edge.
  struct Image {
    int face;
    Vec3 a, b, c;
  };
  struct Segment {
    int face;
    Vec3 a, b;
  };

  /// Construct after the last collapse; `traces` must outlive the object.
  SurfaceMap(const Traces& traces, double tolerance, const Progress& progress = {});

  /// The image of an old triangle. Returns false if it is a hole.
  bool map_triangle(std::size_t t, std::vector<Image>& images) const;
  /// The image of an old half-edge whose triangle is not a hole.
  void map_edge(int half, std::vector<Segment>& segments) const;

  /// The face that an old vertex maps to; -1 if it is far from all faces.
  int face_of(int vertex) const { return spot_[vertex].face; }
  /// Vertices of a new face, and their positions.
  const std::array<int, 3>& corners(int face) const { return corners_[face]; }
  Corners points_of(int face) const;
  /// The remaining faces, with all vertices.
  Mesh new_surface() const;

 private:
  /// A point of the old surface and its image.
  struct Spot {
    Vec3 from, to;
    int face = -1;
  };
  using Pair = std::pair<Vec3, Vec3>;  // a point and its image
  /// The corners that two faces share.
  struct Shared {
    int count = 0;
    Vec3 point[3];
  };

  void take_corners();
  void place_vertices(const Progress& progress);
  void place_dropped_vertices(const Progress& progress);
  void place_others(const Progress& progress);

  bool is_near(const Spot& spot) const;
  Spot nearest(const Vec3& p, int face) const;
  Spot middle(const Spot& a, const Spot& b) const;
  Spot between(const Spot& a, const Spot& b, int face) const;
  Shared common_vertices(int f, int g) const;
  std::optional<Vec3> common_vertex(int f, int g, int h) const;
  std::optional<Pair> join(const Spot& a, const Spot& b) const;
  void map_edge(const Spot& a, const Spot& b, int depth, std::vector<Segment>& segments) const;
  bool map_triangle(const Spot& a, const Spot& b, const Spot& c, int depth, std::vector<Image>& images) const;
  bool map_onto_three(const std::array<Spot, 3>& corner, const std::array<Pair, 3>& cut,
                      std::vector<Image>& images) const;

  const Traces& traces_;
  const HalfEdges& half_edges_;
  const HalfEdgeMesh& mesh_;
  double tolerance_;
  std::vector<std::array<int, 3>> corners_;  // of each new face
  std::vector<Spot> spot_;                   // of each old vertex
};

}  // namespace riffler::mesh
