// Keeps a mesh that is simplified within a tolerance up to date while the full mesh changes.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "marching/group_result.hpp"

namespace riffler::marching {

/// The remaining triangles of each brick. A group's result depends only on its input. The result keeps a digest of that
/// input, so a group whose input has not changed keeps its result.
///
/// A merge sees only the triangles around its group, so triangles may fold across the border of two groups. Then the
/// vertices of folded triangles are fixed and the groups concerned are simplified again; the resulting mesh is the next
/// layer. In the last layer no triangle folds that did not fold in the full mesh, because a triangle with three fixed
/// vertices never changes. A layer shares unchanged results with the layer before it.
class AdaptiveState {
 public:
  /// `tolerance`: mm, > 0: the largest distance between the remaining triangles and the full mesh, in both directions.
  /// The surface must outlive this object. `follows`: update() will be called; false: keeps no digests and no earlier
  /// layers.
  AdaptiveState(const Surface& surface, double tolerance, bool follows);

  /// Simplifies the whole mesh again.
  void build(const std::vector<std::size_t>& all, const Progress& progress);
  /// Follows a change of the full mesh in these bricks. Returns the bricks whose remaining triangles changed,
  /// ascending.
  std::vector<std::size_t> update(const std::vector<std::size_t>& changed);

  /// mm.
  double tolerance() const { return tolerance_; }
  /// Number of a brick's triangles.
  std::size_t count(std::size_t brick) const { return shown_[brick] ? shown_[brick]->triangles.size() : 0; }
  /// Calls body(triangle) for a brick's triangles, in order; vertices by their numbers in the full mesh.
  template <class Body>
  void for_triangles(std::size_t brick, Body&& body) const {
    if (!shown_[brick]) return;
    const Vec3i at = surface_.bricks.place(brick);
    for (std::size_t t = 0; t < shown_[brick]->triangles.size(); ++t) body(numbers(at, shown_[brick]->corners(t)));
  }

 private:
  using Result = std::shared_ptr<const GroupResult>;
  using FixedVertices = std::map<std::size_t, std::vector<std::size_t>>;  // by brick, ascending
  struct Layer {
    std::vector<std::array<Result, 7>> results;  // by brick and group; null for a group without triangles
    FixedVertices fixed;
    std::map<std::size_t, std::vector<VertexName>> folds;  // of each brick: the corners of its folded triangles
  };
  /// The border triangles of a brick before a turn.
  struct BorderState {
    std::size_t turn = 0;
    std::vector<BorderFace> faces;
  };
  class Turns;

  std::int32_t number(const Vec3i& at, const VertexName& name) const {
    const Vec3i owner = at + name.offset();
    return static_cast<std::int32_t>(surface_.bricks.active(owner.x, owner.y, owner.z)->first_vertex + name.local());
  }
  Vec3i numbers(const Vec3i& at, const std::array<VertexName, 3>& v) const {
    return {number(at, v[0]), number(at, v[1]), number(at, v[2])};
  }
  void follow(std::size_t layer, const std::vector<std::size_t>& changed, const std::vector<std::size_t>& owners,
              const Progress& progress);
  void find_folds(Layer& layer, const std::vector<std::size_t>& renewed) const;
  std::vector<VertexName> folds_of(const Layer& layer, std::size_t brick, std::vector<std::size_t>& others) const;
  FixedVertices fixed_after(const Layer& layer) const;
  static std::vector<std::size_t> owners_of_changes(const FixedVertices& a, const FixedVertices& b);
  void fix_folds_in_place();
  void simplify(const std::vector<std::size_t>& changed, const Progress& progress);

  const Surface& surface_;
  double tolerance_;
  bool follows_;
  VertexGroups groups_;
  std::vector<Layer> layers_;
  std::vector<Result> shown_;
};

}  // namespace riffler::marching
