// The border of a set in the plane: a part's silhouette, or the area within closed curves.
#pragma once

#include <vector>

#include "plan/place_grid.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::plan {

/// Segments that contain the border of a set, with an index. Segments that are not on the border lie within the set.
class SetBorder {
 public:
  struct Segment {
    Vec2 from, to;
  };
  /// `cell`: side of the index's cells, mm.
  SetBorder(std::vector<Segment> segments, double cell);

  /// Finds the point on the segments that is nearest to `p`. Returns false if it is `far` or farther from `p`.
  bool nearest(const Vec2& p, double far, Vec2& found) const;
  /// Distance between the segments and the straight line from `a` to `b`, but at most `far`.
  double distance(const Vec2& a, const Vec2& b, double far) const;
  const Vec2& lower() const { return lower_; }
  const Vec2& upper() const { return upper_; }

 private:
  template <class Visit>
  void near(const Vec2& low, const Vec2& high, const Visit& visit) const;

  std::vector<Segment> segments_;
  double cell_;
  Vec2 lower_{0}, upper_{0};
  int columns_ = 0, rows_ = 0;
  std::vector<std::size_t> first_;  // index in `in_cells_` of each cell's first segment
  std::vector<std::size_t> in_cells_;
};

/// Edges of a mesh that can lie on the border of its silhouette along z: edges whose two triangles are seen on the same
/// side of the edge, and edges of one triangle or more than two.
std::vector<SetBorder::Segment> silhouette_segments(const Mesh& mesh);
/// Places of the grid that the mesh's triangles cover, seen along z.
PlaceSet covered(const PlaceGrid& grid, const Mesh& mesh);
/// Segments of closed curves.
std::vector<SetBorder::Segment> curve_segments(const std::vector<std::vector<Vec2>>& curves);
/// Places of the grid inside an odd number of the curves.
PlaceSet within(const PlaceGrid& grid, const std::vector<std::vector<Vec2>>& curves);

}  // namespace riffler::plan
