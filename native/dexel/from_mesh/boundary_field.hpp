// K (field.hpp) handed down from large blocks of space to the small ones within them.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "dexel/from_mesh/field_points.hpp"
#include "dexel/from_mesh/local_expansion.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::dexel {

/// Distance of p from the segment ab.
double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b);

/// The boundary in pieces: directed edges, and loops of so few of them that they are looked at as a whole. Lengths in
/// cells.
class BoundaryPieces {
 public:
  struct Edge {
    Vec3 a, b;
  };
  /// The surface between a chain of edges and its chord, or that a loop spans: from `far_enough` on, its vector says it
  /// all.
  struct Surface {
    Vec3 centre;  // of a ball around it
    double radius, area, far_enough;
    Vec3 vector;
    Box3 box;  // around it
  };
  struct Piece {
    int first, last;     // its edges
    int previous, next;  // pieces before and after; −1 for a loop
    double length;
    Surface surface;  // of an edge only the ball

    bool is_loop() const { return next < 0; }
  };

  /// Closed loops of points.
  explicit BoundaryPieces(const std::vector<std::vector<Vec3>>& loops);

  int size() const { return static_cast<int>(pieces_.size()); }
  const Piece& operator[](int k) const { return pieces_[k]; }
  std::span<const Edge> edges(const Piece& p) const { return {edges_.data() + p.first, edges_.data() + p.last}; }
  /// The ends of a piece's edges.
  std::span<const PathPoint> ends(const Piece& p) const { return {ends_.data() + p.first, ends_.data() + p.last}; }
  double length() const { return length_; }
  /// Of the 2^level pieces from k on, all of one loop, where 2^level divides their place in it; null where there are
  /// less.
  const Surface* surface(int k, int level) const;

  /// A lower bound of the distance of a piece from p: exact for an edge near by.
  double distance(const Piece& piece, const Vec3& p, double near) const;

 private:
  Surface span(int first, int last) const;
  void add_chains(int first, int last);

  void add_ends(const Piece& piece);

  std::vector<Edge> edges_;
  std::vector<PathPoint> ends_;
  std::vector<Piece> pieces_;
  std::vector<std::vector<Surface>> surfaces_;  // of chains that begin at a piece, by level
  double length_ = 0;
};

/// The boundary as it appears from a ball about `centre`: pieces that come near it, and a polynomial for all others.
///
/// An edge ab that does not come near is a closed curve if it goes on to infinity from a and from b, straight away from
/// the centre. K of such curves is harmonic in the ball. Where a chain of near edges ends, it is closed in the same
/// way, so that the curves add up to the boundary. In going from a ball to one within it, the directions of those ways
/// to infinity change; the wedge between old and new is one more such curve.
struct Surroundings {
  /// Distances from the centre beyond which edges are far, in radii. The polynomial is in error by about the 8th power
  /// of the inverse.
  static constexpr double kFar = 3;

  Vec3 centre{0};
  double radius = 0;
  std::vector<int> near;  // pieces, ascending
  LocalExpansion far;     // K of the others, modulo 1
};

/// A maximal chain of near pieces, near[begin] … near[end − 1]. One that is not open at an end is continued by another,
/// or is a loop.
struct Chain {
  std::size_t begin, end;
  bool open_front, open_back;
};

/// Calls visit(chain) for the chains of `near`.
template <class Visit>
void for_each_chain(const BoundaryPieces& pieces, const std::vector<int>& near, const Visit& visit) {
  const auto is_near = [&](int k) { return std::binary_search(near.begin(), near.end(), k); };
  for (std::size_t begin = 0, end = 0; begin < near.size(); begin = end) {
    end = begin + 1;
    if (pieces[near[begin]].is_loop()) {
      visit(Chain{begin, end, false, false});
      continue;
    }
    while (end < near.size() && pieces[near[end - 1]].next == near[end] && near[end - 1] < near[end]) ++end;
    visit(Chain{begin, end, !is_near(pieces[near[begin]].previous), !is_near(pieces[near[end - 1]].next)});
  }
}

/// Makes Surroundings; keeps storage between calls.
class Descent {
 public:
  explicit Descent(const BoundaryPieces& pieces) : pieces_(pieces) {}

  /// Those of a ball that is as large as the boundary: all pieces are near.
  Surroundings root(const Vec3& centre, double radius) const;
  /// Those of a ball within another's.
  void enter(const Surroundings& parent, const Vec3& centre, double radius, Surroundings& out);

 private:
  void add_loop(const BoundaryPieces::Piece& loop);
  void add_chain(int first, int last);
  void add_dipole(const BoundaryPieces::Surface& surface);
  void add_edge(const Vec3& a, const Vec3& b, double distance);
  void add_source(const Vec3& a, const Vec3& b, double distance);
  void add_wedge(const Vec3& a, const Vec3& from, double sign);

  /// Sources of one kind that wait for their sum.
  struct Batch {
    static constexpr std::size_t kMax = 64;

    bool dipoles;
    double arrays[10][kMax];  // SourceArrays
    std::size_t count = 0;
  };
  void push(Batch& batch, const Vec3& a, const Vec3& e, const Vec3& w, double endless);
  void flush(Batch& batch);

  const BoundaryPieces& pieces_;
  Batch edges_{false, {}, 0}, dipoles_{true, {}, 0};
  Vec3 centre_{0};
  LocalExpansion* far_ = nullptr;
  double re_ = 1, im_ = 0;  // product of the curves' factors at the centre
  double surfaces_ = 0;     // sum of the dipoles' K at the centre
};

}  // namespace riffler::dexel
