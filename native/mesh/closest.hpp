// The point of a mesh nearest to a given point.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "geom/median_tree.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// The nearest point of triangle abc to p, also of one without area, and the part of the triangle it lies on.
struct OnTriangle {
  enum Part : unsigned char { Face, EdgeAB, EdgeBC, EdgeCA, VertexA, VertexB, VertexC };
  Vec3 point;
  Part part;
};
OnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// A tree of boxes over a mesh's triangles; keeps what it needs of the mesh. Queries may run on several threads.
class Closest {
 public:
  struct Hit {
    Vec3 point{0};
    double distance = std::numeric_limits<double>::infinity();  // mm
    int triangle = -1;                                          // of the mesh; -1 where nothing is within the limit
    OnTriangle::Part part = OnTriangle::Face;
  };

  /// `with_sides` also prepares signed_distance. std::invalid_argument for an empty mesh or where `validate` throws.
  explicit Closest(const Mesh& mesh, bool with_sides = false);

  /// The nearest point, if nearer than `limit`.
  Hit operator()(const Vec3& p, double limit = std::numeric_limits<double>::infinity()) const;
  /// Whether any point of the mesh is at most `limit` away; cheaper than the nearest one.
  bool within(const Vec3& p, double limit) const;
  /// Adds every triangle that is at most `limit` away to `hits`, with its own nearest point; in an order that does not
  /// depend on the number of threads.
  void gather(const Vec3& p, double limit, std::vector<Hit>& hits) const;
  /// The plane of a contact, and which triangles could hold a ball that lies on it.
  struct Above {
    Vec3 origin, up;  // up: unit
    double height;    // mm above the plane that a triangle rises at least
    double cosine;    // of the angle between its normal and `up`, at most

    bool holds(const Vec3& a, const Vec3& b, const Vec3& c) const;
  };
  /// The nearest point, if nearer than `limit`, of the triangles that rise and turn that far; any turn counts for those
  /// without area.
  Hit above(const Vec3& p, double limit, const Above& plane) const;
  /// Whether one of these triangles may be nearer than `limit` to a point between p and all p + `ways`. The distance
  /// from a triangle is convex, so it falls by no more than its slope at p says: a triangle that faces across the ways
  /// stays as far as it is.
  bool may_meet(const Vec3& p, double limit, std::span<const Vec3> ways, const Above& plane) const;
  /// The nearest point of triangle `t`.
  Hit on(int t, const Vec3& p) const;
  /// Distance to triangle `t`: an upper bound of the distance to the mesh.
  double distance_to(int t, const Vec3& p) const;

  /// Distance, negative behind the surface: the side by the angle-weighted normal of the nearest point (Bærentzen &
  /// Aanæs, IEEE TVCG 11 (2005) 243), exact for closed two-manifolds. Needs `with_sides`.
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

  std::size_t levels_ = 0;      // the tree is complete; node i has the children 2 i + 1 and 2 i + 2
  std::vector<Box3> boxes_;     // of the nodes
  std::vector<int> id_, slot_;  // place in the leaves ↔ triangle of the mesh
  std::vector<Corners> corners_;
  Triangles triangles_;  // the rest only with sides
  std::vector<Vec3> face_normals_, edge_normals_, vertex_normals_;
};

/// Distance (mm) of every vertex of `mesh` from the surface of `other`; with `with_sign` negative where it lies behind
/// it, which is inside for a closed one. std::invalid_argument where one is invalid or `other` is empty.
std::vector<double> deviation(const Mesh& mesh, const Mesh& other, bool with_sign = false,
                              const Progress& progress = {});

}  // namespace riffler::mesh
