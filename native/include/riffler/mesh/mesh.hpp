// Indexed triangle mesh: the exchange format between files, volumes and Blender.
#pragma once

#include "riffler/base/bulk.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::mesh {

using Vertices = base::BulkVector<Vec3>;
using Triangles = base::BulkVector<Vec3i>;

/// Vertices (mm) and triangles (vertex indices, counter-clockwise seen from outside the material). The struct checks
/// nothing: `validate` checks whether a mesh can be used at all, audit.hpp whether it bounds a solid.
struct Mesh {
  Vertices vertices;
  Triangles triangles;

  bool empty() const { return triangles.empty(); }
};

/// Throws std::invalid_argument naming the first row of `vertices` that is not finite (or beyond 1e30), or the first
/// row of `triangles` with an index out of range.
void validate(const Mesh& mesh);

/// Signed enclosed volume, mm³ (divergence theorem about the box's centre). Meaningful for closed meshes.
double volume(const Mesh& mesh);
/// Sum of the triangles' areas, mm².
double area(const Mesh& mesh);
/// Box of the vertices that triangles use; empty for an empty mesh.
Box3 bounds(const Mesh& mesh);

}  // namespace riffler::mesh

namespace riffler {
using mesh::Mesh;
}  // namespace riffler
