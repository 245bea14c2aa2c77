// Keeps a surface under decimation within a tolerance of the one it came from.
#pragma once

#include <vector>

#include "mesh/decimate/collapse.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::mesh {

/// What is known of the way from the new surface to the old one; the checks of all patches share it.
///
/// Every vertex of the new surface has an *anchor*, a point of the old one: at first itself, and where it has moved,
/// the nearest point found. Every new edge has a *trace* on the old surface: the path between the anchors of its ends
/// in the plane through both that holds the fan's normal when the edge came to be. The traces cut the old surface into
/// regions, one for each new triangle. Checked are
///  - every anchor: it must be near its vertex;
///  - where a trace crosses an old edge: the point must be near the new edge;
///  - every old vertex within a region: it must be near the new triangle;
///  - every old border vertex: it must be near the new border edge in whose stead it was.
/// A region consists of pieces of old triangles whose corners are such points, and points near a triangle are a convex
/// set: so the whole region is near its triangle, as long as no two traces cross. On rough surfaces they may, for their
/// planes lean differently: MapCheck has the last word.
///
/// In planes old vertices would only pile up: where all of a fan is flat they are dropped, and the new triangles
/// remember by how much they were off.
struct Traces {
  struct Anchor {
    Vec3 point;
    int half;  // of the old surface: starts at the anchor or, where that is no vertex, bounds its triangle
    bool vertex;
  };

  /// `half_edges` before the first collapse; must outlive this.
  explicit Traces(const HalfEdges& half_edges, const Progress& progress = {});

  struct OldVertex {
    Vec3 point;
    int next;  // old vertices of a face or of a border edge are a list; -1 at its end
  };

  const HalfEdges& half_edges;
  std::vector<OldVertex> old;
  std::vector<Anchor> anchor;  // of a vertex
  std::vector<int> in_face;    // first old vertex of a face
  std::vector<int> on_border;  // first old vertex of a border edge
  /// Of a face.
  struct Flat {
    float error = 0;  // by how much it may be off where vertices were dropped
    float edge = 0;   // no old edge that crosses it is longer
  };
  std::vector<Flat> flat;
};

class ToleranceCheck {
 public:
  ToleranceCheck(Traces& traces, double tolerance)
      : traces_(traces), half_edges_(traces.half_edges), tolerance_(tolerance) {}

  /// Finds where on the old surface a new vertex belongs, before its collapse is prepared; false where that is far.
  bool find_anchor(const CollapseTarget& place);
  /// Whether the collapse that was prepared then keeps to the tolerance.
  bool allow(const Collapse& collapse);
  /// Before the collapse that was last allowed is carried out.
  void commit(const Collapse& collapse);

 private:
  struct Move {
    int vertex, face;
  };
  /// A ring vertex's anchor, and the planes of the traces to it from the new vertex and to the next one of the ring.
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

  // of the collapse under test
  std::vector<Move> moves_;
  std::vector<Corner> corners_;
  Traces::Anchor anchor_{};  // of the new vertex
  double anchor_distance_ = 0;
  double fan_error_ = 0, fan_edge_ = 0, limit_ = 0, largest_ = 0, thickness_ = 0, flat_error_ = 0;
  bool flat_ = false;
  Vec3 normal_{0};
};

}  // namespace riffler::mesh
