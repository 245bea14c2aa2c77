// Passes K (see field.hpp) from large blocks of space down to the smaller blocks inside them.
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

/// The boundary in pieces: single directed edges, and short loops that are handled as a whole. Lengths in cells.
class BoundaryPieces {
 public:
  struct Edge {
    Vec3 a, b;
  };
  /// The surface between a chain of edges and its chord, or the surface that a loop spans. From a distance of
  /// `far_enough`, its area vector describes it sufficiently.
  struct Surface {
    Vec3 centre;  // centre of the bounding ball
    double radius, area, far_enough;
    Vec3 vector;
    Box3 box;  // bounding box
  };
  struct Piece {
    int first, last;     // range of its edges
    int previous, next;  // neighbouring pieces; −1 for a loop
    double length;
    Surface surface;  // for a single edge, only the ball is set

    bool is_loop() const { return next < 0; }
  };

  /// Takes closed loops of points.
  explicit BoundaryPieces(const std::vector<std::vector<Vec3>>& loops);

  int size() const { return static_cast<int>(pieces_.size()); }
  const Piece& operator[](int k) const { return pieces_[k]; }
  std::span<const Edge> edges(const Piece& p) const { return {edges_.data() + p.first, edges_.data() + p.last}; }
  /// The end points of a piece's edges.
  std::span<const PathPoint> ends(const Piece& p) const { return {ends_.data() + p.first, ends_.data() + p.last}; }
  double length() const { return length_; }
  /// The surface for the 2^level pieces from k on, if they are all of one loop and 2^level divides k's position in the
  /// loop; otherwise null.
  const Surface* surface(int k, int level) const;

  /// A lower bound on the distance of a piece from p; exact for a nearby edge.
  double distance(const Piece& piece, const Vec3& p, double near) const;

 private:
  Surface span(int first, int last) const;
  void add_chains(int first, int last);

  void add_ends(const Piece& piece);

  std::vector<Edge> edges_;
  std::vector<PathPoint> ends_;
  std::vector<Piece> pieces_;
  std::vector<std::vector<Surface>> surfaces_;  // of the chains that begin at each piece, by level
  double length_ = 0;
};

/// The boundary as seen from a ball about `centre`: a list of the nearby pieces, and a polynomial for all others.
///
/// A far edge ab becomes a closed curve if it is extended from a and from b to infinity, radially away from the centre.
/// K of such a curve is harmonic in the ball. Each end of a chain of near edges is extended in the same direction, so
/// that the curves add up to the boundary. A smaller ball inside has other extension directions; the wedge between the
/// old and the new extension is one more such curve.
struct Surroundings {
  /// Edges farther from the centre than this many radii are far. The polynomial's relative error is about the inverse
  /// to the 8th power.
  static constexpr double kFar = 3;

  Vec3 centre{0};
  double radius = 0;
  std::vector<int> near;  // numbers of the near pieces, ascending
  LocalExpansion far;     // K of all other pieces, modulo 1
};

/// A maximal chain of near pieces, near[begin] … near[end − 1]. At an end that is not open, another chain continues it,
/// or the chain is a loop.
struct Chain {
  std::size_t begin, end;
  bool open_front, open_back;
};

/// Calls visit(chain) for each chain of `near`.
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

/// Computes Surroundings; reuses its storage between calls.
class Descent {
 public:
  explicit Descent(const BoundaryPieces& pieces) : pieces_(pieces) {}

  /// Surroundings of a ball that contains the whole boundary: all pieces are near.
  Surroundings root(const Vec3& centre, double radius) const;
  /// Surroundings of a ball inside the parent's ball.
  void enter(const Surroundings& parent, const Vec3& centre, double radius, Surroundings& out);

 private:
  void add_loop(const BoundaryPieces::Piece& loop);
  void add_chain(int first, int last);
  void add_dipole(const BoundaryPieces::Surface& surface);
  void add_edge(const Vec3& a, const Vec3& b, double distance);
  void add_source(const Vec3& a, const Vec3& b, double distance);
  void add_wedge(const Vec3& a, const Vec3& from, double sign);

  /// Sources of one kind that wait to be summed.
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
