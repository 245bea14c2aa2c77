// How a Bézier span is divided into cells whose triangles are within a tolerance of it.
#pragma once

#include <cstdint>
#include <vector>

#include "nurbs/bezier.hpp"

namespace riffler::nurbs {

/// Parameters of vertices in a span's unit square, in units of 1 / kGrid: exact, so that neighbours find each other's.
using Place = glm::vec<2, std::int64_t>;
inline constexpr std::int64_t kGrid = std::int64_t{1} << 40;

inline Vec2 to_unit_square(const Place& p) {
  return Vec2(p) / static_cast<double>(kGrid);
}

/// A rectangle in the parameters of a span. Any triangle in it is within the tolerance.
struct MeshCell {
  Place lower, upper;
};

/// Divides a span into few cells: into halves where second derivatives differ, and into equal parts where they do not.
/// At least `least_u` and `least_v` parts in each direction. Throws std::invalid_argument if a cell would be too small
/// to have vertices of its own, or if there would be more than `max` cells.
std::vector<MeshCell> plan_cells(const BezierSpan& span, double tolerance, int least_u, int least_v, std::size_t max);

}  // namespace riffler::nurbs
