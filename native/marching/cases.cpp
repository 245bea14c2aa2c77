#include "marching/cases.hpp"

#include <stdexcept>

namespace riffler::marching {

namespace {

struct Face {
  std::array<int, 4> corner, edge;  // edge[n] joins corner[n] and corner[n + 1]
};

int edge_between(int p, int q) {
  for (int e = 0; e < 12; ++e)
    if ((kEdges[e].low == p && kEdges[e].high == q) || (kEdges[e].low == q && kEdges[e].high == p)) return e;
  throw std::logic_error("corners of a cell that no edge joins");
}

Face make_face(int f) {
  const int axis = f >> 1, side = f & 1, b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3, base = side << axis;
  Face face{{base, base | b, base | b | c, base | c}, {}};
  for (int n = 0; n < 4; ++n) face.edge[n] = edge_between(face.corner[n], face.corner[(n + 1) % 4]);
  return face;
}

/// Sets of edges joined by segments.
struct Cycles {
  std::array<int, 12> parent;
  Cycles() {
    for (int e = 0; e < 12; ++e) parent[e] = e;
  }
  int find(int e) const {
    while (parent[e] != e) e = parent[e];
    return e;
  }
  void join(int a, int b) {
    const int x = find(a), y = find(b);
    if (x != y) parent[x < y ? y : x] = x < y ? x : y;  // the smallest edge represents its cycle
  }
};

bool inside(int code, int corner) {
  return code >> corner & 1;
}

bool ambiguous(int code, const Face& face) {
  const auto& c = face.corner;
  return inside(code, c[0]) == inside(code, c[2]) && inside(code, c[1]) == inside(code, c[3]) &&
         inside(code, c[0]) != inside(code, c[1]);
}

/// Joins the crossed edges of one face: if there are two, these; in an ambiguous face, the two around each inside
/// corner (`flipped`: around each outside corner).
void join_segments(int code, const Face& face, bool flipped, Cycles& cycles) {
  if (ambiguous(code, face)) {
    for (int n = 0; n < 4; ++n)
      if (inside(code, face.corner[n]) != flipped) cycles.join(face.edge[(n + 3) % 4], face.edge[n]);
    return;
  }
  int first = -1;
  for (int n = 0; n < 4; ++n) {
    if (inside(code, face.corner[n]) == inside(code, face.corner[(n + 1) % 4])) continue;
    if (first < 0)
      first = face.edge[n];
    else
      cycles.join(first, face.edge[n]);
  }
}

CellCase make_case(int code, int flipped_face) {
  Cycles cycles;
  for (int f = 0; f < 6; ++f) join_segments(code, make_face(f), f == flipped_face, cycles);
  CellCase out;
  out.code = static_cast<std::uint8_t>(code);
  for (int e = 0; e < 12; ++e)
    if (inside(code, kEdges[e].low) != inside(code, kEdges[e].high))
      out.crossed = static_cast<std::uint16_t>(out.crossed | 1 << e);
  int used = 0;
  for (int root = 0; root < 12; ++root) {
    if (!(out.crossed >> root & 1) || cycles.find(root) != root) continue;
    const int cycle = out.cycles++;
    for (int e = root; e < 12; ++e) {
      if (!(out.crossed >> e & 1) || cycles.find(e) != root) continue;
      out.edge[used++] = static_cast<std::uint8_t>(e);
      for (int a = 0; a < 3; ++a)
        out.from[cycle][a] = static_cast<std::uint8_t>(out.from[cycle][a] + kEdges[e].from[a]);
      out.faces[cycle] = static_cast<std::uint8_t>(out.faces[cycle] | kEdges[e].faces);
    }
    out.begin[out.cycles] = static_cast<std::uint8_t>(used);
  }
  for (int f = 0; f < 6; ++f) {
    const Face face = make_face(f);
    if (ambiguous(code, face) && cycles.find(face.edge[0]) == cycles.find(face.edge[2]) &&
        cycles.find(face.edge[1]) == cycles.find(face.edge[3]) &&
        cycles.find(face.edge[0]) == cycles.find(face.edge[1]))
      out.problem = static_cast<std::uint8_t>(f);
  }
  return out;
}

CaseTable make_table() {
  CaseTable table;
  int next = 256;
  for (int code = 0; code < 256; ++code) {
    table[code] = make_case(code, kNoFace);
    if (table[code].problem == kNoFace) continue;
    table[next] = make_case(code, table[code].problem);
    table[next].problem = kNoFace;
    table[code].second = static_cast<std::uint16_t>(next++);
  }
  return table;
}

}  // namespace

const CaseTable& case_table() {
  static const CaseTable table = make_table();
  return table;
}

}  // namespace riffler::marching
