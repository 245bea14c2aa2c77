// What a drop cutter holds: the tool's lower sides and a tree of the mesh's triangles.
#pragma once

#include <utility>
#include <vector>

#include "geom/median_tree.hpp"
#include "plan/lower_side.hpp"
#include "riffler/plan/drop.hpp"

namespace riffler::plan {

struct DropCutter::Core {
  struct Search;
  Core(const Mesh& mesh, const Tool& tool, const Vec3& axis, double margin);
  Landing drop(const Vec3& p, Stats* stats) const;

  struct Triangle {
    Vec3 a, b, c;
  };

  void build(const std::vector<Triangle>& all);
  std::size_t first(std::size_t level, std::size_t place) const { return geom::first_item(count_, level, place); }

  Mat3 turn_;                                            // columns: the tool's frame, with z along the axis
  std::vector<std::pair<tool::Part, LowerSide>> sides_;  // one per piece of the assembly
  std::size_t count_ = 0, levels_ = 0;  // the tree is complete; node i has the children 2 i + 1 and 2 i + 2
  std::vector<Box3> boxes_;
  std::vector<Triangle> triangles_;  // in the tool's frame, in leaf order
  std::vector<int> numbers_;         // of the triangles in the mesh
};

}  // namespace riffler::plan
