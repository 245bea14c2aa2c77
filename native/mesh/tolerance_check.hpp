// Keeps a surface under decimation within a tolerance of the one it came from.
#pragma once

#include <vector>

#include "mesh/collapse.hpp"

namespace riffler {

/// Every edge of the new surface has a *trace* on the old one: the path from end to end in the plane through the edge
/// and the fan's normal when the edge came to be. The traces cut the old surface into regions, one for each new
/// triangle. Checked are
///  - where a trace crosses an old edge: the point must be near the new edge;
///  - every old vertex within a region: it must be near the new triangle;
///  - every old border vertex: it must be near the new border edge in whose stead it was.
/// A region consists of convex pieces of old triangles whose corners are such points, and points near a triangle are a
/// convex set: so the whole region is near its triangle. The other way round, moving each of those points to its
/// partner maps the region onto the triangle without tearing it, its border onto the border: no point of the triangle
/// is left out.
///
/// In planes old vertices would only pile up: where all of a fan is flat they are dropped, and the new triangles
/// remember by how much they were off.
class ToleranceCheck {
 public:
  /// `half_edges` before the first collapse; must outlive this.
  ToleranceCheck(const HalfEdges& half_edges, double tolerance);

  /// Whether the prepared collapse keeps to the tolerance.
  bool allow(const Collapse& collapse);
  /// After the collapse that was last allowed has been carried out.
  void commit(const Collapse& collapse);

 private:
  struct Move {
    int vertex, face;
  };

  Vec3 point(int vertex) const { return to_vec3(mesh_.point(OpenMesh::VertexHandle(vertex))); }
  bool near_new_face(const Collapse& collapse, int vertex);
  bool vertices_near(const Collapse& collapse);
  bool border_near(const Collapse& collapse);
  bool near_new_border(const Collapse& collapse, int vertex) const;
  bool trace_near(const Collapse& collapse, int i) const;
  bool follow(int half, int target, const Vec3& from, const Vec3& to, const Vec3& side) const;
  void find_normal(const Collapse& collapse);
  static OpenMesh::HalfedgeHandle other_border(const Collapse& collapse);

  const HalfEdges& half_edges_;
  const HalfEdgeMesh& mesh_;
  double tolerance_;
  std::vector<int> corner_of_;  // a half-edge of the old surface that starts at the vertex
  std::vector<int> next_;       // old vertices of a face or of a border edge are a list; -1 at its end
  std::vector<int> in_face_;    // first one of a face
  std::vector<int> on_border_;  // first one of a border edge
  std::vector<double> error_;   // of a face: by how much it may be off where vertices were dropped

  // of the collapse under test
  std::vector<Move> moves_;
  double fan_error_ = 0, limit_ = 0, largest_ = 0, thickness_ = 0, flat_error_ = 0;
  bool flat_ = false;
  Vec3 normal_{0};
};

}  // namespace riffler
