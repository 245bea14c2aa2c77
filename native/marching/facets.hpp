// The triangles of one brick, organised for ray queries.
//
// A brick's quads are stored in the order of the lattice's columns, so consecutive quads are close together: boxes
// around runs of quads form a tree without sorting, in the time that it takes to read the quads. A brick that a stroke
// has just changed can be picked at once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "marching/sight.hpp"
#include "marching/surface.hpp"
#include "riffler/base/block_pool.hpp"

namespace riffler::marching {

/// The nearest triangle that a ray has met. Ties (a ray through an edge) go to the lowest brick, then quad, then
/// number, so the order of the tests does not matter.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  std::size_t brick = 0, triangle = 0;  // 2 × quad of the brick + triangle of the quad
  Vec3 normal{0};                       // not normalised

  bool after(double d, std::size_t b, std::size_t t) const {
    if (d != distance) return d < distance;
    return b != brick ? b < brick : t < triangle;
  }
};

class Facets {
 public:
  /// Copies the positions of the corners, because the surface may change.
  Facets(const Surface& surface, const ActiveBrick& brick);

  /// Tests the triangles that may be nearer than `best`, and returns how many were tested.
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
