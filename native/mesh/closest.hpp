// Finds the point of a mesh nearest to a given point.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "geom/median_tree.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// The point of triangle abc nearest to p, and the part of the triangle that it lies on. The triangle may have zero
/// area.
struct OnTriangle {
  enum Part : unsigned char { Face, EdgeAB, EdgeBC, EdgeCA, VertexA, VertexB, VertexC };
  Vec3 point;
  Part part;
};
OnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// A bounding box tree over a mesh's triangles. Does not refer to the mesh afterwards. Several threads may query it at
/// once.
class Closest {
 public:
  struct Hit {
    Vec3 point{0};
    double distance = std::numeric_limits<double>::infinity();  // mm
    int triangle = -1;                                          // index in the mesh; -1 if nothing is within the limit
    OnTriangle::Part part = OnTriangle::Face;
  };

  /// `with_sides` also prepares signed_distance. Throws std::invalid_argument for an empty mesh or if `validate` does.
  explicit Closest(const Mesh& mesh, bool with_sides = false);

  /// The nearest point, if nearer than `limit` (mm).
  Hit operator()(const Vec3& p, double limit = std::numeric_limits<double>::infinity()) const;
  /// Whether any point of the mesh is at most `limit` (mm) away. Cheaper than finding the nearest point.
  bool within(const Vec3& p, double limit) const;
  /// Appends to `hits` every triangle that is at most `limit` (mm) away, with its nearest point. The order does not
  /// depend on the number of threads.
  void gather(const Vec3& p, double limit, std::vector<Hit>& hits) const;
  /// A contact plane, and the condition on triangles that could support a ball lying on it.
  struct Above {
    Vec3 origin, up;  // up: unit
    double height;    // mm, minimum height above the plane that a triangle reaches
    double cosine;    // maximum cosine of the angle between the triangle's normal and `up`

    bool holds(const Vec3& a, const Vec3& b, const Vec3& c) const;
  };
  /// The nearest point, if nearer than `limit`, of the triangles that satisfy `plane`. A triangle without area
  /// satisfies any angle.
  Hit above(const Vec3& p, double limit, const Above& plane) const;
  /// Whether one of these triangles may be nearer than `limit` (mm) to any point between p and p displaced by one of
  /// these vectors. The distance from a triangle is convex, so along a displacement it falls no faster than its slope
  /// at p: a displacement perpendicular to the direction of the triangle brings it no nearer.
  bool may_meet(const Vec3& p, double limit, std::span<const Vec3> ways, const Above& plane) const;
  /// The nearest point of triangle `t`.
  Hit on(int t, const Vec3& p) const;
  /// Distance to triangle `t`, an upper bound on the distance to the mesh.
  double distance_to(int t, const Vec3& p) const;

  /// Signed distance, negative behind the surface. The angle-weighted normal at the nearest point decides the side
  /// (Bærentzen & Aanæs, IEEE TVCG 11 (2005) 243); exact for closed two-manifolds. Needs `with_sides`.
  double signed_distance(const Vec3& p, const Hit& hit) const;

 private:
  struct Corners {
    Vec3 a, b, c;
  };

  void build(const std::vector<Corners>& corners);
  template <class Keep>
  Hit nearest(const Vec3& p, double limit, const Keep& keep) const;
  void prepare_sides(const Mesh& mesh);
  std::size_t first(std::size_t level, std::size_t place) const { return geom::first_item(id_.size(), level, place); }
  template <class Visit>
  void descend(const Vec3& p, double& bound, const Visit& visit) const;

  std::size_t levels_ = 0;      // the tree is complete: node i has the children 2 i + 1 and 2 i + 2
  std::vector<Box3> boxes_;     // of the nodes
  std::vector<int> id_, slot_;  // id_: leaf slot → triangle of the mesh; slot_: the inverse
  std::vector<Corners> corners_;
  Triangles triangles_;  // this and the following: only with sides
  std::vector<Vec3> face_normals_, edge_normals_, vertex_normals_;
};

/// Distance (mm) of every vertex of `mesh` from the surface of `other`. With `with_sign` it is negative behind the
/// surface, which is inside for a closed one. Throws std::invalid_argument if a mesh is invalid or `other` is empty.
std::vector<double> deviation(const Mesh& mesh, const Mesh& other, bool with_sign = false,
                              const Progress& progress = {});

}  // namespace riffler::mesh
