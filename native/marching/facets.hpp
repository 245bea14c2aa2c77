// The triangles of one brick, as rays find them.
//
// Its quads stand in the order of the lattice's columns, so those that follow each other lie close together: boxes
// round runs of them make a tree without any sorting, in the time that reading the quads takes. A brick that a stroke
// has just changed can be picked at once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "marching/sight.hpp"
#include "marching/surface.hpp"
#include "riffler/base/block_pool.hpp"

namespace riffler::marching {

/// The nearest triangle that a ray has met. Of equally near ones, as at an edge that it goes through, that of the
/// lowest brick, quad and number counts, so that the order in which they are met does not matter.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  std::size_t brick = 0, triangle = 0;  // 2 × quad of the brick + which
  Vec3 normal{0};                       // not yet of unit length

  bool after(double d, std::size_t b, std::size_t t) const {
    if (d != distance) return d < distance;
    return b != brick ? b < brick : t < triangle;
  }
};

class Facets {
 public:
  /// Copies the places of the corners: the surface may change.
  Facets(const Surface& surface, const ActiveBrick& brick);

  /// Looks at the triangles that may be nearer than `best`, and says how many that were.
  std::uint64_t look(const Sight& sight, std::size_t brick, Nearest& best) const;
  std::size_t triangles() const { return 2 * quads_.size(); }
  std::size_t nbytes() const;

 private:
  static constexpr std::size_t kRun = 16, kGroup = 8;  // quads in a run, runs in a group

  using Corners = std::array<Vec3f, 4>;  // of the triangles 0 1 2 and 0 2 3
  struct Box {
    Vec3f lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};
    void add(const Box& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
  };

  base::BlockVector<Corners> quads_;
  std::vector<Box> runs_, groups_;
};

}  // namespace riffler::marching
