#include "geom/parallel.hpp"
#include "marching/diagonal.hpp"
#include "marching/surface.hpp"

namespace riffler::marching {

Quad Surface::quad(std::size_t n, const LatticeEdge& edge) const {
  Quad out{{}, edge.axis, edge.rising ? -1.0 : 1.0};
  const auto corner = corners(n);
  for (int c = 0; c < 4; ++c) out.corner[c] = mesh.vertices[corner[c]];
  return out;
}

bool Surface::split(std::size_t n, const LatticeEdge& edge) {
  Vec3 hit{lattice.at(0, edge.i), lattice.at(1, edge.j), lattice.at(2, edge.k)};
  hit[edge.axis] += hits[n].t() * lattice.pitch();
  // Two steps of rounding at each end of what is compared.
  const int diagonal = choose_diagonal(quad(n, edge), hit, 4 * lattice.step());
  const auto c = corners(n);
  Vec3i &a = mesh.triangles[2 * n], &b = mesh.triangles[2 * n + 1];
  if (diagonal == 1)
    a = {c[1], c[2], c[3]}, b = {c[1], c[3], c[0]};
  else
    a = {c[0], c[1], c[2]}, b = {c[0], c[2], c[3]};
  return diagonal >= 0;
}

void choose_diagonals(Surface& surface, const Progress& progress) {
  const SignField& signs = surface.signs;
  parallel_for(
      static_cast<std::size_t>(surface.lattice.cells(0)), 4,
      [&](std::size_t begin, std::size_t end) {
        for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
          std::size_t n = surface.counts.edge(i, 0, 0);
          for (int j = 0; j < surface.lattice.cells(1); ++j)
            for (int axis = 0; axis < 3; ++axis)
              for (int w = 0; w < signs.words(); ++w) {
                const std::uint64_t inside = signs.column(i, j)[w];
                for (std::uint64_t word = crossed_edges(signs, i, j, axis, w); word; word &= word - 1) {
                  const int b = std::countr_zero(word);
                  surface.split(n++, {axis, i, j, 64 * w + b, !(inside >> b & 1)});
                }
              }
        }
      },
      progress);
}

}  // namespace riffler::marching
