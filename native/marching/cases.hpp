// The sign patterns of a cell, and the closed cycles of crossed edges of each pattern: one vertex per cycle.
//
// Dual contouring with one vertex for each sheet of surface in a cell (Nielson, "Dual Marching Cubes", IEEE
// Visualization 2004), with the fix for the two patterns that would otherwise make an edge with four triangles (Wenger,
// "Isosurfaces: Geometry, Topology, and Algorithms", 2013, ch. 3).
#pragma once

#include <array>
#include <cstdint>

namespace riffler::marching {

/// Corner c of a cell is (c & 1, c >> 1 & 1, c >> 2). Edge e runs along axis e >> 2; e & 1 and e >> 1 & 1 are its sides
/// along the two axes that follow in cyclic order. Face f is side f & 1 of axis f >> 1.
struct CellEdge {
  int axis;
  std::array<int, 3> from;  // the lower end, as coordinates 0 or 1
  int low, high;            // corners at the ends
  int slot;                 // position of this cell among the four around the edge, counter-clockwise seen from +axis
  int faces;                // bits of the two faces that the edge lies on
};

constexpr CellEdge make_edge(int e) {
  const int axis = e >> 2, b = (axis + 1) % 3, c = (axis + 2) % 3, at_b = e & 1, at_c = e >> 1 & 1;
  CellEdge edge{axis, {0, 0, 0}, 0, 0, 0, 0};
  edge.from[b] = at_b, edge.from[c] = at_c;
  edge.low = (at_b << b) | (at_c << c);
  edge.high = edge.low | (1 << axis);
  constexpr int slots[2][2] = {{2, 1}, {3, 0}};  // an edge on the upper side of the cell has the cell below it
  edge.slot = slots[at_b][at_c];
  edge.faces = (1 << (2 * b + at_b)) | (1 << (2 * c + at_c));
  return edge;
}

inline constexpr std::array<CellEdge, 12> kEdges = [] {
  std::array<CellEdge, 12> edges{};
  for (int e = 0; e < 12; ++e) edges[e] = make_edge(e);
  return edges;
}();

/// Maps a cell's slot around an edge to its corner in the edge's quad, and back. Quads are counter-clockwise seen from
/// outside, so those of rising edges have the reverse order.
constexpr int corner_at(int slot, bool rising) {
  return rising ? (4 - slot) & 3 : slot;
}

inline constexpr int kNoFace = 7;

struct CellCase {
  std::uint8_t code = 0;                              // bit c: corner c is inside
  std::uint8_t cycles = 0;                            // number of vertices of the cell
  std::uint8_t problem = kNoFace;                     // an ambiguous face with both its segments in one cycle
  std::uint16_t second = 0;                           // entry that resolves that face differently: one vertex more
  std::uint16_t crossed = 0;                          // bit e: edge e is crossed
  std::array<std::uint8_t, 12> edge{};                // the crossed edges, cycle by cycle
  std::array<std::uint8_t, 5> begin{};                // cycle c owns edge[begin[c]] … edge[begin[c + 1] − 1]
  std::array<std::array<std::uint8_t, 3>, 4> from{};  // sum of the lower ends of a cycle's edges
  std::array<std::uint8_t, 4> faces{};                // faces that a cycle's edges lie on
};

/// Entries 0 … 255 are the sign patterns; the second entries of the problem cases follow.
inline constexpr int kProblemCases = 36;
using CaseTable = std::array<CellCase, 256 + kProblemCases>;
const CaseTable& case_table();

}  // namespace riffler::marching
