// Keeps the triangles that a tolerance leaves up to date while the full mesh changes.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "marching/group_result.hpp"

namespace riffler::marching {

/// The triangles left of each brick. Each group's result depends only on its input, a digest of which is kept with it,
/// so a group whose input is the same as before keeps its result.
///
/// A merge sees only the triangles around its group, so across the border of two groups triangles may fold. Their
/// vertices are fixed then, and the groups that this concerns are simplified again: what is left is a mesh of its own,
/// the next layer. In the end no triangle folds that did not in the full mesh: one whose vertices are all fixed has
/// never changed. A layer shares the results that it has in common with the one before.
class AdaptiveState {
 public:
  /// `tolerance`: mm, > 0. No point of the triangles left is farther than this from the full mesh, and the reverse.
  /// The surface must outlive it. `follows`: updates will come; without them digests and earlier layers are not kept.
  AdaptiveState(const Surface& surface, double tolerance, bool follows);

  /// Simplifies the whole mesh again.
  void build(const std::vector<std::size_t>& all, const Progress& progress);
  /// Follows a change of the full mesh in these bricks. Returns the bricks whose triangles left differ now, ascending.
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
    std::vector<std::array<Result, 7>> results;  // by brick and group; null if there is nothing to do
    FixedVertices fixed;
    std::map<std::size_t, std::vector<VertexName>> folds;  // of each brick: the corners of its folded triangles
  };
  /// The border triangles of a brick in the course of the turns.
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
