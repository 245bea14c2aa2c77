// The border of a set in the plane: of a part's silhouette, or of what lies within closed curves.
#pragma once

#include <vector>

#include "plan/place_grid.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::plan {

/// Segments that contain the border of the set, and an index of them. Others lie within the set.
class SetBorder {
 public:
  struct Segment {
    Vec2 from, to;
  };
  /// `cell`: mm, side of the index's cells.
  SetBorder(std::vector<Segment> segments, double cell);

  /// The nearest point of the segments; `far` from `p` or farther: none, and false.
  bool nearest(const Vec2& p, double far, Vec2& found) const;
  /// Distance of the straight line from `a` to `b` from the segments, if it is less than `far`, which it is otherwise.
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
  std::vector<std::size_t> first_;  // of each cell in `in_cells_`
  std::vector<std::size_t> in_cells_;
};

/// Edges of a mesh that can lie on the border of its silhouette along z: those whose two triangles are seen on one side
/// of them, and those that have another number of triangles.
std::vector<SetBorder::Segment> silhouette_segments(const Mesh& mesh);
/// Places of the grid on the mesh's triangles, seen along z.
PlaceSet covered(const PlaceGrid& grid, const Mesh& mesh);
/// Segments of closed curves, and the places inside an odd number of them.
std::vector<SetBorder::Segment> curve_segments(const std::vector<std::vector<Vec2>>& curves);
PlaceSet within(const PlaceGrid& grid, const std::vector<std::vector<Vec2>>& curves);

}  // namespace riffler::plan
