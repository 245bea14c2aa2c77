// The generalized winding number that an open surface owes to its boundary.
//
// Let S be a surface with boundary ∂S, and close it by the curtain that every boundary edge sweeps when it moves to
// infinity along the ray. A column never crosses the curtain, so
//     w(p) = n(p) + K(p),   n(p) = signed crossings of S below p,   K(p) = Σ Ω(a − p, b − p, e_z) / 4π
// over the boundary's directed edges ab, Ω the solid angle of the triangle whose third corner lies at infinity. (Solid
// angles: van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30(2), 1983.) In
// stereographic coordinates of the directions to a and b, half the solid angle is the argument of a complex number:
//     Ω / 2 = arg(t_a t_b + conj(α) β),   α = a_x + i a_y,   t_a = |a| + a_z,
// so that K modulo 1 is the argument of one product over the boundary: no arc tangents, no caps, no branches to follow.
// K is harmonic away from ∂S; its gradient is the Biot–Savart field of a current along ∂S.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/vec.hpp"

namespace riffler {

/// K near one place: the boundary edges and, for parts of the boundary that are far away, chords with the multipoles
/// of the surface between chord and boundary. Lengths in cells, z along the column.
class Field {
 public:
  /// K modulo 1 as a phase in (−½, ½] that is 0 where K = ½, and dK/dz.
  struct Value {
    double phase, slope;
  };

  /// Prepares `at` for the column through (u, v).
  void set_column(double u, double v);
  Value at(double z) const;
  /// Phase and gradient anywhere; set_column is not needed.
  double at(const Vec3& p, Vec3& gradient) const;

  /// Upper bound of the norm of K's second derivatives within `half` of z on the column set; infinity on an edge.
  double curvature(double z, double half) const;
  /// How far K within `half` of z on the column set may be from K(z), given dK/dz there. Unlike `curvature` it stays
  /// useful beside edges: one edge's share of K never turns back along a column, for the sign of
  /// dK/dz = (a × b)_z (|a| + |b|) / (4π |a| |b| (|a| |b| + a·b)) is that of a constant.
  double variation(double z, double half, double slope) const;

 private:
  friend class BoundaryTree;
  /// Dipole and quadrupole of a surface about a centre.
  struct Multipole {
    Vec3 centre, dipole;
    Mat3 quadrupole;  // symmetric
    double trace;
  };
  struct Column {
    double rr, dot, cross;  // |α|²; with the point before: Re and Im of conj(α) β
  };

  void clear();
  void add_edge(const std::vector<Vec3>& points, int a, int b);

  std::vector<Vec3> points_;          // polylines
  std::vector<std::uint8_t> begins_;  // whether the point begins one
  std::vector<Multipole> far_;
  std::vector<std::pair<Vec3, Vec3>> near_;  // edges whose curvature depends on the place
  double far_curvature_ = 0;
  double u_ = 0, v_ = 0;
  std::vector<Column> column_;
  int last_ = -1;  // index of the last point added
};

/// The boundary as a tree: loops halved recursively into chains, and groups of loops. Every node knows the surface
/// spanned between its chain and the chain's chord.
class BoundaryTree {
 public:
  /// Closed loops of points, in cells.
  explicit BoundaryTree(const std::vector<std::vector<Vec3>>& loops);

  bool empty() const { return nodes_.empty(); }
  double length() const { return nodes_.empty() ? 0 : nodes_[root_].length; }

  /// Fills `field` with what K needs within the box centre ± half, to kAccuracy for each multipole; returns an upper
  /// bound of the norm of K's second derivatives there, infinity where an edge may pass through.
  double gather(const Vec3& centre, const Vec3& half, Field& field) const;
  /// The bound alone; stops at the first edge that is near.
  double curvature(const Vec3& centre, const Vec3& half) const;

  static constexpr double kAccuracy = 1e-7;

 private:
  struct Node {
    Vec3 centre{0};
    double radius = 0;
    double length = 0;  // of the boundary in the node
    double area = 0;    // of the surface spanned, triangle by triangle
    Vec3 dipole{0};     // area vector
    Mat3 quadrupole{0};
    int left = -1, right = -1;
    int from = -1, to = -1;  // the chord's ends; −1 where the node is made of whole loops
  };

  int chain(int from, int to);
  int group(std::vector<int>& loops, std::size_t begin, std::size_t end);
  void join(Node& node) const;
  template <class OnEdge, class OnFar>
  double visit(const Vec3& centre, const Vec3& half, const OnEdge& on_edge, const OnFar& on_far) const;

  std::vector<Vec3> points_;
  std::vector<Node> nodes_;
  int root_ = -1;
};

}  // namespace riffler
