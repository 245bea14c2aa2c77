// The boundary of an open surface as a tree that gives K (field.hpp) near one place at little cost.
#pragma once

#include <vector>

#include "dexel/field.hpp"
#include "geom/vec.hpp"

namespace riffler {

/// The boundary as a tree: loops halved recursively into chains, and groups of loops. Every node knows the surface
/// spanned between its chain and the chain's chord.
class BoundaryTree {
 public:
  /// Closed loops of points, in cells.
  explicit BoundaryTree(const std::vector<std::vector<Vec3>>& loops);

  bool empty() const { return nodes_.empty(); }
  double length() const { return nodes_.empty() ? 0 : nodes_[root_].length; }

  /// Fills `field` with what K needs within the box centre ± half, to kAccuracy for each multipole; returns an upper
  /// bound of the norm of K's second derivatives there, infinity where an edge may pass through. With `clear_only` it
  /// gives up at the first such edge, and the field is not to be used then.
  double gather(const Vec3& centre, const Vec3& half, Field& field, bool clear_only = false) const;

  static constexpr double kAccuracy = 1e-6;

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
