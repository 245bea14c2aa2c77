// The triangles around a vertex of the full mesh, found by its cell: no adjacency is stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "marching/surface.hpp"

namespace riffler::marching {

/// Finds stars one after another; not for several threads at once.
class VertexStar {
 public:
  explicit VertexStar(const Surface& surface) : surface_(surface) {}

  /// The numbers of the triangles that have `vertex`, one of the brick's own, as a corner, ascending. Valid until the
  /// next call.
  const std::vector<std::size_t>& of(const ActiveBrick& brick, std::int32_t vertex);

 private:
  const Surface& surface_;
  std::vector<QuadRef> quads_;
  std::vector<std::size_t> triangles_;
};

/// Calls body(vertex) for each of a brick's own vertices around which triangles may belong to the brick's upper
/// neighbours: those of the last layer of cells along an axis.
void for_upper_vertices(const Surface& surface, const ActiveBrick& brick,
                        const std::function<void(std::int32_t)>& body);

}  // namespace riffler::marching
