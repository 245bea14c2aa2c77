// Audits a mesh as written to a binary STL, from float32 coordinates alone; independent of native/mesh. A mesh without
// open edges has no T-junction, because an edge that a vertex splits on one side only has no partner.
#pragma once

#include <ostream>

#include "riffler/mesh/mesh.hpp"

namespace riffler::stress {

struct FloatAudit {
  std::size_t inexact = 0;     // vertices that float32 cannot represent
  std::size_t merged = 0;      // vertices that share their place with another
  std::size_t open = 0;        // directed edges without exactly one partner in the other direction
  std::size_t repeated = 0;    // directed edges of two triangles
  std::size_t pinched = 0;     // vertices with more than one fan
  std::size_t duplicates = 0;  // triangles with the same three corners as another
  std::size_t degenerate = 0;  // triangles without area
  std::size_t folds = 0;       // edges whose triangles lie on each other
  std::size_t unused = 0;      // vertices without a triangle

  bool clean() const {
    return inexact + merged + open + repeated + pinched + duplicates + degenerate + folds + unused == 0;
  }
};

inline std::ostream& operator<<(std::ostream& out, const FloatAudit& a) {
  return out << "inexact " << a.inexact << ", merged " << a.merged << ", open " << a.open << ", repeated " << a.repeated
             << ", pinched " << a.pinched << ", duplicates " << a.duplicates << ", degenerate " << a.degenerate
             << ", folds " << a.folds << ", unused " << a.unused;
}

/// Welds like a reader of the STL: equal float32 triples are one vertex.
Mesh weld(const Mesh& mesh, FloatAudit& audit);

FloatAudit float_audit(const Mesh& mesh, double fold_cosine = -0.99999);

/// Signed volume about the first vertex.
inline double enclosed(const Mesh& mesh) {
  double sum = 0;
  for (const Vec3i& t : mesh.triangles) {
    const Vec3 o = mesh.vertices[0];
    sum += glm::dot(mesh.vertices[t.x] - o, glm::cross(mesh.vertices[t.y] - o, mesh.vertices[t.z] - o));
  }
  return sum / 6;
}

inline Box3 box_of(const Mesh& mesh) {
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.add(v);
  return box;
}

}  // namespace riffler::stress
