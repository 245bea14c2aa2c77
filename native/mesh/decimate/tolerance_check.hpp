// Keeps a surface under decimation within a tolerance of the original.
#pragma once

#include <vector>

#include "mesh/decimate/collapse.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// Correspondence between the new surface and the old one, shared by the checks of all patches.
///
/// Every vertex of the new surface has an *anchor*, a point of the old one: at first the vertex itself; after a move,
/// the nearest point found. Every new edge has a *trace* on the old surface: the path between the anchors of its ends,
/// in the plane through both that contains the fan's normal at the time the edge was made. The traces cut the old
/// surface into regions, one for each new triangle. The checks are:
///  - every anchor must be near its vertex;
///  - where a trace crosses an old edge, the crossing must be near the new edge;
///  - every old vertex inside a region must be near the new triangle;
///  - every old border vertex must be near the new border edge that replaces it.
/// A region consists of pieces of old triangles whose corners are such points, and the set of points near a triangle is
/// convex. So the whole region is near its triangle, as long as no two traces cross. On rough surfaces they may cross,
/// because their planes lean differently: MapCheck makes the final decision.
///
/// In planes, lists of old vertices would only grow. If all of a fan is flat, its old vertices are dropped, and the new
/// triangles record their deviation.
struct Traces {
  struct Anchor {
    Vec3 point;
    int half;  // half-edge of the old surface that starts at the anchor or, if the anchor is not a vertex, bounds its
               // triangle
    bool vertex;
  };

  /// `half_edges` is the state before the first collapse and must outlive the object.
  explicit Traces(const HalfEdges& half_edges, const Progress& progress = {});

  struct OldVertex {
    Vec3 point;
    int next;  // next in the linked list of old vertices of a face or border edge; -1 at the end
  };

  const HalfEdges& half_edges;
  std::vector<OldVertex> old;
  std::vector<Anchor> anchor;  // of each vertex
  std::vector<int> in_face;    // first old vertex of each face
  std::vector<int> on_border;  // first old vertex of each border edge
  /// Deviation of one face.
  struct Flat {
    float error = 0;  // mm, maximum deviation caused by dropped vertices
    float edge = 0;   // mm, maximum length of the old edges that cross the face
  };
  std::vector<Flat> flat;
};

class ToleranceCheck {
 public:
  ToleranceCheck(Traces& traces, double tolerance)
      : traces_(traces), half_edges_(traces.half_edges), tolerance_(tolerance) {}

  /// Finds the place of a new vertex on the old surface. Call it before the collapse is prepared. Returns false if the
  /// place is too far.
  bool find_anchor(const CollapseTarget& place);
  /// Whether the collapse prepared since then keeps to the tolerance.
  bool allow(const Collapse& collapse);
  /// Records the collapse that `allow` accepted last. Call it before carrying the collapse out.
  void commit(const Collapse& collapse);

 private:
  struct Move {
    int vertex, face;
  };
  /// A ring vertex's anchor, and the planes of the traces to it from the new vertex and from it to the next ring
  /// vertex.
  struct Corner {
    Traces::Anchor anchor;
    Vec3 side, outer_side;
  };

  const Vec3& old_point(int half) const { return traces_.old[half_edges_.corner[half]].point; }
  void find_normal(const Collapse& collapse);
  void find_planes(const Collapse& collapse);
  bool vertices_near(const Collapse& collapse);
  double crossings_at_most(const Collapse& collapse) const;
  bool near_new_face(const Collapse& collapse, int vertex);
  bool border_near(const Collapse& collapse);
  bool near_new_border(const Collapse& collapse, int vertex) const;
  bool trace_near(const Collapse& collapse, int i) const;
  bool leave_vertex(const Traces::Anchor& target, const Vec3& from, const Vec3& to, const Vec3& side) const;
  bool leave_face(const Traces::Anchor& target, const Vec3& from, const Vec3& to, const Vec3& side) const;
  bool follow(int half, const Traces::Anchor& target, const Vec3& from, const Vec3& to, const Vec3& side) const;
  bool has_corner(int half, int vertex) const;
  static OpenMesh::HalfedgeHandle other_border(const Collapse& collapse);

  Traces& traces_;
  const HalfEdges& half_edges_;
  double tolerance_;

  // State of the collapse under test.
  std::vector<Move> moves_;
  std::vector<Corner> corners_;
  Traces::Anchor anchor_{};  // of the new vertex
  double anchor_distance_ = 0;
  double fan_error_ = 0, fan_edge_ = 0, limit_ = 0, largest_ = 0, thickness_ = 0, flat_error_ = 0;
  bool flat_ = false;
  Vec3 normal_{0};
};

}  // namespace riffler::mesh
