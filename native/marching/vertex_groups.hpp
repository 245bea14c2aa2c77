// Splits the vertices of a mesh into groups that can be simplified independently.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "marching/surface.hpp"

namespace riffler::marching {

/// The vertices of a brick in 8 groups. Bit a of a vertex's group says that its cell is the brick's last along axis a,
/// so that the triangles around it belong to this brick and the next one along that axis. Group 0 lies inside the
/// brick, 1, 2 and 4 on its upper faces, 3, 5 and 6 on its upper edges; group 7, at its corner, never changes.
///
/// The groups take turns, edges first, then faces, then the inside. The vertices of two groups that take the same turn
/// are two cells or more apart along some axis, so they never share a triangle: neither in the full mesh nor later,
/// because a merge gives a triangle another vertex of the same group only. So they can be processed in parallel, and
/// what bricks share is simplified once, from triangles on both sides.
inline constexpr std::array<std::uint8_t, 7> kTurns{3, 6, 5, 1, 2, 4, 0};

/// The bricks that a group has triangles in are those at the offsets that its number contains, as bits.
inline bool reaches(int group, int side) {
  return (side & ~group) == 0;
}
inline Vec3i offset_of(int side) {
  return {side & 1, side >> 1 & 1, side >> 2};
}

/// Share of the tolerance that a group may use. What an edge or a face of a brick uses is missing inside the bricks
/// around it, whose triangles start with that error.
inline double share_of(int group) {
  return group == 0 ? 1 : (group & (group - 1)) == 0 ? 0.5 : 0.25;
}

/// The triangles of a brick with a vertex outside its group 0, as in the full mesh.
struct BorderTriangles {
  std::vector<std::uint32_t> triangles;  // counted from the brick's first, ascending
  std::vector<std::uint32_t> places;     // in `triangles`: lists by side and group
  std::array<std::uint32_t, 57> begin{};

  /// Those with a vertex of a group of the brick `side` below this one.
  std::span<const std::uint32_t> around(int side, int group) const {
    const auto list = static_cast<std::size_t>(7 * side + group);
    return {places.data() + begin[list], places.data() + begin[list + 1]};
  }
};

class VertexGroups {
 public:
  explicit VertexGroups(const Surface& surface) : surface_(surface), borders_(surface.bricks.size()) {}

  /// Finds the groups of the vertices of these bricks and lists their border triangles. The groups of all other active
  /// bricks must be known.
  void sort(const std::vector<std::size_t>& bricks, const Progress& progress);

  int of(std::size_t vertex) const { return group_[vertex]; }
  /// The brick must be active and sorted.
  const BorderTriangles& border(std::size_t brick) const { return *borders_[brick]; }

 private:
  void sort_vertices(const ActiveBrick& brick);
  BorderTriangles list_border(const ActiveBrick& brick) const;

  const Surface& surface_;
  base::BulkVector<std::uint8_t> group_;  // by vertex
  std::vector<std::unique_ptr<const BorderTriangles>> borders_;
};

/// The brick that a vertex of one of a brick's triangles belongs to: the brick itself or one of those below it.
class VertexOwners {
 public:
  struct Owner {
    int side;           // the brick is `offset_of(side)` below
    std::size_t local;  // the vertex, counted from the brick's first
  };

  VertexOwners(const Bricks& bricks, const Vec3i& at);
  Owner of(std::int32_t vertex) const {
    int side = 0;
    std::size_t local;
    while ((local = static_cast<std::size_t>(static_cast<std::int64_t>(vertex)) - first_[side]) >= count_[side]) ++side;
    return {side, local};
  }

 private:
  std::array<std::size_t, 8> first_{}, count_{};
};

}  // namespace riffler::marching
