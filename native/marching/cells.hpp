// Walks over the cells and edges where the sign changes, a word of 64 at a time.
#pragma once

#include "marching/cases.hpp"
#include "marching/signs.hpp"

namespace riffler::marching {

/// Calls visit(k, code) for every cell of column (i, j) that has both signs among its corners, k ascending.
template <class Visit>
void visit_cells(const SignField& signs, int i, int j, Visit&& visit) {
  const std::uint64_t* const column[4] = {signs.column(i, j), signs.column(i + 1, j), signs.column(i, j + 1),
                                          signs.column(i + 1, j + 1)};
  for (int w = 0; w < signs.words(); ++w) {
    std::uint64_t low[4], high[4], any = 0, all = ~std::uint64_t{0};
    for (int c = 0; c < 4; ++c) {
      low[c] = column[c][w], high[c] = low[c] >> 1 | column[c][w + 1] << 63;
      any |= low[c] | high[c], all &= low[c] & high[c];
    }
    for (std::uint64_t active = any & ~all; active; active &= active - 1) {
      const int b = std::countr_zero(active);
      unsigned code = 0;
      for (int c = 0; c < 4; ++c)
        code |= static_cast<unsigned>(low[c] >> b & 1) << c | static_cast<unsigned>(high[c] >> b & 1) << (c + 4);
      visit(64 * w + b, static_cast<int>(code));
    }
  }
}

/// Edges of one axis that start in a column of lattice points and change sign: bit K stands for the edge from
/// (I, J, K) to the next point along the axis.
inline std::uint64_t crossed_edges(const SignField& signs, int i, int j, int axis, int w) {
  const std::uint64_t* const column = signs.column(i, j);
  if (axis == 2) return column[w] ^ (column[w] >> 1 | column[w + 1] << 63);
  return column[w] ^ (axis == 0 ? signs.column(i + 1, j) : signs.column(i, j + 1))[w];
}

inline int code_at(const SignField& signs, int i, int j, int k) {
  int code = 0;
  for (int c = 0; c < 8; ++c) code |= signs.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) << c;
  return code;
}

/// The entry of a cell. A problem case whose neighbour across the problem face has that face as its problem too takes
/// the second entry, and so does the neighbour, by the same rule: signs alone decide, and both alike.
inline const CellCase& entry_of(const CaseTable& table, const SignField& signs, int i, int j, int k, int code) {
  const CellCase& first = table[code];
  if (first.problem == kNoFace) [[likely]]
    return first;
  int at[3] = {i, j, k};
  at[first.problem >> 1] += first.problem & 1 ? 1 : -1;  // exists: faces on the outside have no inside corner
  const CellCase& across = table[code_at(signs, at[0], at[1], at[2])];
  return across.problem == (first.problem ^ 1) ? table[first.second] : first;
}

}  // namespace riffler::marching
