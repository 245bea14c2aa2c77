// How far a surface under decimation is from the one it came from.
#pragma once

#include <vector>

#include "mesh/closest.hpp"
#include "mesh/collapse.hpp"

namespace riffler {

/// Keeps both surfaces within a tolerance of each other.
///
/// Old → new: each face carries points of the old surface, its samples: vertices that were removed and middles of edges
/// that were; all samples of the old fan must be near the new one. New → old: over a fan of old faces the distance of a
/// new one is piecewise linear, so it is largest at the removed vertex or where a new edge passes over an old one;
/// there the old edge, or else the old surface by its tree, must be near. In planes samples would only pile up: where
/// everything in a fan is flat they are dropped, and the new faces remember by how much they were off (`error`).
class SurfaceSamples {
 public:
  SurfaceSamples(const Mesh& original, const HalfEdgeMesh& mesh, double tolerance);

  /// Whether the prepared collapse keeps to the tolerance.
  bool allow(const Collapse& collapse);
  /// After the collapse that was last allowed has been carried out.
  void commit(const Collapse& collapse);

 private:
  struct Sample {
    Vec3 point;
    int next;  // of the same face, -1 at the end
  };
  /// A sample of the old fan and the new face it would belong to; `index` -1: it does not exist yet.
  struct Move {
    Vec3 point;
    int index, face;
  };

  bool near_new_faces(const Collapse& collapse, const Vec3& point, int index);
  bool middles_near(const Collapse& collapse);
  bool spokes_near(const Collapse& collapse) const;
  bool spoke_near(const Collapse& collapse, int i, const Vec3& normal) const;
  bool border_near(const Collapse& collapse) const;
  void find_normal(const Collapse& collapse);
  bool is_original(OpenMesh::HalfedgeHandle half) const { return !changed_[half.idx() / 2]; }

  const HalfEdgeMesh& mesh_;
  double tolerance_;
  Closest original_;
  std::vector<Sample> samples_;
  std::vector<int> head_;      // first sample of a face
  std::vector<double> error_;  // of a face: by how much it may be off where its samples were dropped
  std::vector<char> changed_;  // edges that are no edge of the old surface

  // of the collapse under test
  std::vector<Move> moves_;
  double fan_error_ = 0, limit_ = 0, largest_ = 0, thickness_ = 0, flat_error_ = 0;
  bool flat_ = false;
  Vec3 normal_{0};
};

}  // namespace riffler
