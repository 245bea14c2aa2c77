// A map from an old surface onto the new one that moves no point far.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/decimate/tolerance_check.hpp"

namespace riffler::mesh {

/// A continuous map from the surface before a decimation to the one after it that moves no point farther than the
/// tolerance, with holes where none was found. Nothing is taken from the checks of the single collapses but where to
/// begin.
///
///  - An old vertex goes to a point of a new face; one of a border to a point of the border.
///  - Along an old edge whose ends go to two faces there must be a point near what these have in common, an edge or a
///    vertex; otherwise the edge is divided.
///  - A triangle goes to one face, or to two with their common edge or vertex, or to three round a vertex near a point
///    of it; otherwise it is divided. Each piece has all its corners near one face, and points near a triangle are a
///    convex set: so the linear map of the piece moves no point farther than its corners.
class SurfaceMap {
 public:
  /// A piece of a new face, that a piece of an old triangle or edge goes to.
  struct Image {
    int face;
    Vec3 a, b, c;
  };
  struct Segment {
    int face;
    Vec3 a, b;
  };

  /// After the last collapse; `traces` must outlive this.
  SurfaceMap(const Traces& traces, double tolerance);

  /// What an old triangle goes to; false where it is a hole.
  bool map_triangle(std::size_t t, std::vector<Image>& images) const;
  /// What an old half-edge of a triangle that is no hole goes to.
  void map_edge(int half, std::vector<Segment>& segments) const;

  /// The face that an old vertex goes to, -1 where it is far from all.
  int face_of(int vertex) const { return spot_[vertex].face; }
  /// Vertices of a new face, and where they are.
  const std::array<int, 3>& corners(int face) const { return corners_[face]; }
  std::array<Vec3, 3> points_of(int face) const;
  /// Faces that are left, with all vertices.
  Mesh new_surface() const;

 private:
  /// A point of the old surface and where it goes.
  struct Spot {
    Vec3 from, to;
    int face = -1;
  };
  using Pair = std::pair<Vec3, Vec3>;  // a point, and where it goes
  /// The corners that two faces have in common.
  struct Shared {
    int count = 0;
    Vec3 point[3];
  };

  void take_corners();
  void place_vertices();
  void place_dropped_vertices();
  void place_others();

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
  std::vector<std::array<int, 3>> corners_;  // of a new face
  std::vector<Spot> spot_;                   // of an old vertex
};

}  // namespace riffler::mesh
